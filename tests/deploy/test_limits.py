"""`limits:` of processes on this machine: they apply, are shown by a plan, and denied ones prevent all starts."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.deploy.limits import tests as commands
from robocomp_yaml.network.network import ResourceLimits

NETWORK = """\
deployment: Robot
limits: {core: off, nice: 4}
components:
  camera: {program: sleep, args: ["600"], limits: {memory: 64 MiB, cores: 0, files: 321}}
  greedy:
    program: python3
    args: [-c, "bytearray(300_000_000)"]
    limits: {memory: 100 MB}
    ready: {log: never, within: 60 s}
    restart: "no"
    enabled: false
"""


@pytest.fixture
def robot(tmp_path: Path, rcyaml: Callable[..., Result], monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    write_tree(tmp_path, {"robot.ddsl.yaml": NETWORK})

    def deploy(*words: str, code: int = 0) -> str:
        done = rcyaml("deploy", *words)
        assert done.exit_code == code, done.stdout + done.stderr
        return done.stdout + done.stderr

    return deploy


def change(path: Path, old: str, new: str) -> None:
    text = (path / "robot.ddsl.yaml").read_text(encoding="utf-8")
    assert old in text
    (path / "robot.ddsl.yaml").write_text(text.replace(old, new), encoding="utf-8")


def test_limits_apply_and_a_change_restarts(tmp_path: Path, robot: Callable[..., str]) -> None:
    robot("up")
    try:
        [camera] = [one for one in json.loads(robot("status", "--format", "json"))["processes"] if one["pid"]]
        limits = Path(f"/proc/{camera['pid']}/limits").read_text(encoding="utf-8")
        for name, value in (("data size", 64 << 20), ("core file size", 0), ("open files", 321)):
            assert re.search(rf"Max {name} +{value} +{value} ", limits), limits
        assert os.getpriority(os.PRIO_PROCESS, camera["pid"]) == 4
        assert os.sched_getaffinity(camera["pid"]) == {0}
        change(tmp_path, "files: 321", "files: 322")
        assert "limits files: 321 → 322" in robot("plan")
    finally:
        robot("down")


def test_too_much_memory_fails(tmp_path: Path, robot: Callable[..., str]) -> None:
    change(tmp_path, "    enabled: false\n", "")
    assert "MemoryError" in robot("up", "greedy", code=1)


def test_a_limit_that_is_denied_prevents_all_starts(tmp_path: Path, robot: Callable[..., str]) -> None:
    change(tmp_path, "cores: 0", "cores: 3999")
    told = robot("up", code=1)
    assert "RC7085" in told
    assert "'camera' is denied on this machine" in told
    assert not any(one["pid"] for one in json.loads(robot("status", "--format", "json"))["processes"])


@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("setpriv"), reason="only root can give up rights")
def test_a_right_that_is_missing_is_told_with_what_gives_it() -> None:
    without = ["prlimit", "--rtprio=0", "--nice=0", "--", "setpriv", "--reuid=65534", "--clear-groups"]
    lower = os.getpriority(os.PRIO_PROCESS, 0) - 1  # the tests may run with any priority
    for limits in (ResourceLimits(realtime=40), ResourceLimits(nice=lower)):
        for _, command in commands(limits):
            done = subprocess.run([*without, *command], capture_output=True, text=True, check=False)
            assert "ermi" in done.stderr, done


def test_a_share_of_a_core_is_left_to_systemd(tmp_path: Path, robot: Callable[..., str]) -> None:
    change(tmp_path, "cores: 0", "cpu: 50 %")
    assert "RC7086" in robot("plan")
    assert "CPUQuota=50%" in robot("export", "--as", "systemd")
