"""The engine of a deployment that runs: another one is refused, so that nothing runs twice, or ends unseen."""

from __future__ import annotations

import pytest

from conftest import write_tree
from seen import NEEDS_ICEGRID, all_ends, programs
from small_networks import Place
from test_roles import Rcyaml

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]
DOCUMENT = """\
deployment: Robot
components:
  base: {program: sleep, args: ["600"], role: server}
"""


@pytest.mark.parametrize("engines", [("local", "icegrid"), ("icegrid", "local")], ids="-".join)
def test_another_one_is_refused_until_down(
    place: Place, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch, engines: tuple[str, str]
) -> None:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    monkeypatch.setenv("XDG_STATE_HOME", f"{place.root}/own")
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT})
    first, second = engines
    assert rcyaml("deploy", "up", "--engine", first).exit_code == 0
    before = programs(place.folder, "base")
    assert len(before) == 1
    for command in ("plan", "up", "status", "down"):
        said = rcyaml("deploy", command, "--engine", second)
        assert said.exit_code == 2 and f"Robot runs with the engine {first}: leave out `--engine`" in said.stderr
        assert "`rcyaml deploy down robot.ddsl.yaml`" in said.stderr
    assert rcyaml("deploy", "status").exit_code == 0 and programs(place.folder, "base") == before
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0 and not programs(place.folder, "base")
    assert rcyaml("deploy", "up", "--engine", second).exit_code == 0 and len(programs(place.folder, "base")) == 1
    assert rcyaml("deploy", "down").exit_code == 0
    all_ends(place.folder)


def test_a_host_that_is_added_while_it_runs(place: Place, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", f"{place.root}/own")
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT})
    assert rcyaml("deploy", "up").exit_code == 0
    before = programs(place.folder, "base")
    more = "  arm: {program: sleep, args: ['600'], host: moon}\n"
    write_tree(place.root, {"robot.ddsl.yaml": f"{DOCUMENT}{more}hosts: {{moon: {{address: 192.0.2.7}}}}\n"})
    for command in ("plan", "up"):
        said = rcyaml("deploy", command)
        assert said.exit_code == 1 and "error[RC7008]: 'base' runs on the host 'moon'" in said.stderr
        assert "it runs with the engine local: `rcyaml deploy down robot.ddsl.yaml`" in said.stderr
    assert programs(place.folder, "base") == before
    assert rcyaml("deploy", "down").exit_code == 0 and not programs(place.folder, "base")
