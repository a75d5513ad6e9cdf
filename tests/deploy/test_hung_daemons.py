"""IceGrid's registry or node hangs on the operator's machine: commands end it, and all goes on. The supervisor of the
other engine is in test_nothing_is_left.py."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import hanging, kill_left
from robocomp_yaml.deploy.icegrid import start_up
from robocomp_yaml.deploy.local import procfs
from seen import NEEDS_ICEGRID, all_ends, status
from small_networks import Place, is_alive
from test_roles import Rcyaml

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]
DOCUMENT = """\
deployment: Robot
components:
  base: {program: sleep, args: ["600"], role: server}
  arm: {program: sleep, args: ["600"], role: server, after: [base]}
"""


@pytest.fixture
def robot(place: Place, rcyaml: Rcyaml, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The path of the document of a network that runs."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    write_tree(tmp_path, {"robot.ddsl.yaml": DOCUMENT})
    document = f"{tmp_path}/robot.ddsl.yaml"
    try:
        assert rcyaml("deploy", "up", document, "--engine", "icegrid").exit_code == 0
        monkeypatch.setattr(start_up, "_PATIENCE", 5.0)
        yield document
    finally:
        kill_left(place.folder)


def daemon(place: Place, program: str) -> int:
    """The pid of a daemon of the deployment."""
    (pid,) = [pid for pid in procfs.marked(place.folder) if procfs.command(pid)[:1] == [program]]
    return pid


def ready(rcyaml: Rcyaml, document: str) -> dict[str, int]:
    """The pids of the processes that are ready."""
    folder = f"{os.path.dirname(document)}/.rcyaml/deployments/Robot"
    return {name: one["pid"] for name, one in status(rcyaml, folder, document).items() if one["ready"]}


def test_the_registry_hangs(place: Place, rcyaml: Rcyaml, robot: str) -> None:
    """All processes go on."""
    before = ready(rcyaml, robot)
    assert len(before) == 2
    with hanging(hung := daemon(place, "icegridregistry")):
        assert ready(rcyaml, robot) == before and not is_alive(hung)
    with hanging(daemon(place, "icegridregistry")):
        down = rcyaml("deploy", "down", robot)
    assert down.exit_code == 0 and "base  stopped" in down.stdout and "arm   stopped" in down.stdout, down.output
    all_ends(place.folder)


def test_the_node_hangs(place: Place, rcyaml: Rcyaml, robot: str) -> None:
    before = ready(rcyaml, robot)
    with hanging(hung := daemon(place, "icegridnode")):
        restart = rcyaml("deploy", "restart", robot, "arm")
    assert restart.exit_code == 0 and not is_alive(hung), restart.output
    after = ready(rcyaml, robot)
    assert len(after) == 2 and not set(after.values()) & set(before.values())
    assert not any(is_alive(pid) for pid in before.values())
    with hanging(daemon(place, "icegridnode")):
        down = rcyaml("deploy", "down", robot)
    assert down.exit_code == 0 and "base  stopped" in down.stdout and "arm   stopped" in down.stdout, down.output
    all_ends(place.folder)
