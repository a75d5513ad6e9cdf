"""Folders with names that Ice reads as something else: as several paths, a quoted text, or a comment."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from processes import Ports, kill_left
from seen import NEEDS_ICEGRID, all_ends, programs

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]
DOCUMENT = """\
deployment: Robot
services: {{storm: {{icestorm: {{port: {}, publish: {}}}}}}}
components:
  base: {{program: sleep, args: ["600"], role: server, after: [storm]}}
"""


@pytest.mark.parametrize("name", ["Anna's", 'q"q', "a,b #1", "b:c\\d $HOME"])
def test_deployments_run_there(
    tmp_path: Path, rcyaml: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    root, ports = tmp_path / name, Ports()
    document = f"{root}/robot.ddsl.yaml"
    write_tree(root, {"robot.ddsl.yaml": DOCUMENT.format(ports(), ports())})
    folder = f"{root}/.rcyaml/deployments/Robot"
    try:
        for engine in ("local", "icegrid"):
            said = rcyaml("deploy", "up", document, "--engine", engine)
            assert said.exit_code == 0, said.output
            assert len(programs(folder, "base")) == len(programs(folder, "storm")) == 1
            assert rcyaml("deploy", "status", document).exit_code == 0
            assert rcyaml("deploy", "down", document).exit_code == 0
            all_ends(folder)
    finally:
        kill_left(folder)
