"""What the manager serves about hosts: what another machine has of the network, and what is pushed there. The other
machine is a real sshd on loopback."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ssh_host import NEEDS_SSHD, ssh_host
from test_manager import Manager, manager, read_events
from test_push import Robot

pytestmark = [
    pytest.mark.slow,
    NEEDS_SSHD,
    pytest.mark.skipif(shutil.which("rsync") is None, reason="there is no rsync (Debian: rsync)"),
]
MORE = """\
  spare: {{address: 127.0.0.1, path: {there}2, ssh: {ssh}}}
  dead: {{address: 127.0.0.1, ssh: {{port: 1}}}}
components:"""


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Robot]:
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/state")
    with ssh_host(tmp_path / "ssh") as host:
        made = Robot(tmp_path / "robot", host)
        made.change("components:", MORE.format(there=made.there, ssh=host.ssh))
        for name in ("grip", "see", "rest"):
            made.change(f"  {name}: {{", f"  {name}: {{host: arm, ")
        yield made


def rows(one: Manager, host: str) -> dict[str, dict[str, Any]]:
    status, found = one.robot(f"availability?host={host}")
    assert (status, found["host"]) == (200, host), found
    return {row["name"]: row for row in found["processes"]}


def test_what_a_host_has_and_lacks_and_a_push(robot: Robot) -> None:
    with manager(robot.root) as one:
        before = rows(one, "arm")
        assert before["rest"] == {
            "name": "rest", "component": "", "assigned": True, "present": True, "missing": [],
        }  # fmt: skip
        assert (before["grip"]["present"], before["see"]["present"]) == (False, False)
        assert before["grip"]["missing"] == [f"1 file to push: {robot.there}/grip"]
        events = read_events(one.open("/api/deployments/Robot/events"), "progress")
        status, done = one.robot("push", {"hosts": ["arm"]})
        assert (status, done["ok"], len(done["hosts"][0]["sent"])) == (200, True, 2)
        assert {next(events)["path"], next(events)["path"]} == {f"{robot.there}/grip", f"{robot.there}/tools/see"}
        assert {name: row["present"] for name, row in rows(one, "arm").items()} == dict.fromkeys(before, True)
        (robot.there / "grip").write_text("#!/bin/sh\n# older\n")
        assert rows(one, "arm")["grip"]["missing"] == [f"1 file to push: {robot.there}/grip"]
        assert rows(one, "arm")["see"]["present"]
        (robot.root / "tools" / "see").unlink()
        assert rows(one, "spare")["see"]["missing"]


def test_a_host_on_which_nothing_runs_yet_is_asked_before_anything_moves_there(robot: Robot) -> None:
    with manager(robot.root) as one:
        spare = rows(one, "spare")
        assert {name: (row["assigned"], row["present"]) for name, row in spare.items()} == {
            "grip": (False, False), "see": (False, False), "rest": (False, True),
        }  # fmt: skip
        status, answer = one.robot("push", {"hosts": ["spare"]})
        assert (status, "no process runs there" in answer["error"]) == (400, True)
        assert one.robot("edit", {"change": {"change": "move", "entry": "grip", "host": "spare"}})[0] == 200
        assert one.robot("push", {"hosts": ["spare"]})[1]["ok"]
        assert rows(one, "spare")["grip"] == spare["grip"] | {"assigned": True, "present": True, "missing": []}


def test_hosts_that_are_unknown_or_do_not_answer(robot: Robot) -> None:
    with manager(robot.root, "--read-only") as one:
        status, found = one.robot("availability?host=dead")
        assert (status, found["processes"]) == (200, [])
        assert "dead" in found["diagnostics"][0]["message"]
        status, answer = one.robot("availability?host=arn")
        assert (status, "did you mean 'arm'" in answer["error"]) == (400, True)
        assert one.robot("push", {"hosts": ["arm"]})[0] == 403
