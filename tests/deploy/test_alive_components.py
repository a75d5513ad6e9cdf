"""Generated components whose worker is stuck, deployed: they are started again, unless they say that they take long."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

import seen
from processes import until

pytest.importorskip("Ice", reason="Ice's Python module is not installed")

Rcyaml = Callable[..., Result]
WORKER = """\
import os
import time

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def compute(self):
        if os.path.exists("stuck"):
            os.unlink("stuck")
            if os.path.exists("patient"):
                self.mayTake(60)
            self.log.info("stuck")
            time.sleep(5)
            self.log.info("free again")
"""
DOCUMENT = """\
deployment: Robot
alive: {every: 500 ms, worker: 2 s}
components:
  lamp: {component: lamp, ready: 20 s}
"""


@pytest.fixture
def lamp(tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a component that runs, and is stuck for 5 s when there is a file `stuck`."""
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    (tmp_path / "lamp").mkdir()
    (tmp_path / "lamp" / "lamp.cdsl.yaml").write_text("component: Lamp\nlanguage: python\nperiod: 50 ms\n")
    (tmp_path / "robot.ddsl.yaml").write_text(DOCUMENT)
    assert rcyaml("compile", ".").exit_code == 0
    (tmp_path / "lamp" / "src" / "specificworker.py").write_text(WORKER)
    up = rcyaml("deploy", "up", "robot.ddsl.yaml")
    assert up.exit_code == 0, up.output
    return tmp_path / "lamp"


def status(rcyaml: Rcyaml) -> dict[str, Any]:
    return seen.status(rcyaml, f"{os.getcwd()}/.rcyaml/deployments/Robot", "robot.ddsl.yaml", is_ice=True)["lamp"]


def logs(rcyaml: Rcyaml) -> str:
    return rcyaml("deploy", "logs", "robot.ddsl.yaml").stdout


def test_a_stuck_worker(rcyaml: Rcyaml, lamp: Path) -> None:
    before = status(rcyaml)
    (lamp / "stuck").touch()
    until(lambda: status(rcyaml)["restarts"] == 1 and status(rcyaml)["ready"], lambda: logs(rcyaml))
    now = status(rcyaml)
    assert now["pid"] != before["pid"] and now["last_exit"].startswith("not alive: its worker has shown no life for ")
    assert "free again" not in logs(rcyaml)
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0


def test_a_component_that_is_asked_stops_at_once(rcyaml: Rcyaml, lamp: Path) -> None:
    """It waits for the end of all its connections: that of its supervisor, too, which asks it twice a second."""
    time.sleep(1.2)
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0
    assert "is running" in logs(rcyaml) and "a method is still running" not in logs(rcyaml)


def test_a_worker_that_says_that_it_takes_long(rcyaml: Rcyaml, lamp: Path) -> None:
    before = status(rcyaml)
    (lamp / "patient").touch()
    (lamp / "stuck").touch()
    until(lambda: "free again" in logs(rcyaml), lambda: logs(rcyaml))
    now = status(rcyaml)
    assert (now["pid"], now["restarts"], now["ready"]) == (before["pid"], 0, True)
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0


def test_it_is_only_told(rcyaml: Rcyaml, lamp: Path) -> None:
    (lamp.parent / "robot.ddsl.yaml").write_text(DOCUMENT.replace("2 s}", "2 s, then: tell}"))
    plan = rcyaml("deploy", "plan", "robot.ddsl.yaml").stdout
    assert "alive.then: restart → tell" in plan and "1 to change" in plan
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
    (lamp / "stuck").touch()
    until(lambda: "life" in status(rcyaml)["not_alive"], lambda: logs(rcyaml))
    shown = rcyaml("deploy", "status", "robot.ddsl.yaml")
    assert shown.exit_code == 1 and "not alive: its worker has shown no life for" in shown.stdout
    until(lambda: status(rcyaml)["ready"], lambda: logs(rcyaml))
    assert status(rcyaml)["restarts"] == 0 and "rcyaml: alive again" in logs(rcyaml)
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0


def test_plan_and_up_name_what_does_not_answer(rcyaml: Rcyaml, lamp: Path) -> None:
    told = DOCUMENT.replace("2 s}", "2 s, then: tell}").replace("ready: 20 s", "ready: 2 s")
    (lamp.parent / "robot.ddsl.yaml").write_text(told)
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
    pid = status(rcyaml)["pid"]
    time.sleep(1.2)  # it has answered once: before that, it may take a minute
    os.kill(pid, signal.SIGSTOP)  # `seen.status` asks the component itself, and would wait
    try:
        until(lambda: "not alive" in rcyaml("deploy", "status", "robot.ddsl.yaml").stdout, "it is seen")
        for command in ("plan", "up"):
            said = rcyaml("deploy", command, "robot.ddsl.yaml")
            assert said.exit_code == 1 and "error[RC7042]: 'lamp' runs and is not alive: " in said.stderr, said.stderr
            assert "`rcyaml deploy restart robot.ddsl.yaml lamp` starts it again" in said.stderr
    finally:
        os.kill(pid, signal.SIGCONT)
        assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0
