"""An installed deployment comes up after a power cut: with a real systemd, which is killed and booted again. With units
of a user and with those of the machine, whose systemd is then the first of its processes."""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from booted import Machine, need_systemd
from conftest import write_tree
from processes import kill_left, until
from seen import programs

pytestmark = pytest.mark.slow
UNIT = "rcyaml-Robot.service"
SECRET = 'se"c$r%et`\\'
NETWORK = """\
deployment: Robot
components:
  base:
    program: sh
    args: [-c, 'printf "%s" "$TOKEN" >token; echo it turns; exec sleep 600']
    env: {TOKEN: {env: ROBOT_TOKEN}}
    ready: {log: it turns}
  arm: {program: sleep, args: ["600"], after: [base], role: server}
"""


class InstalledRobot:
    def __init__(self, root: Path, manager: str = "user") -> None:
        self.machine, self.folder = Machine(root / "home", manager=manager), root / "the robot%"
        write_tree(self.folder, {"robot.ddsl.yaml": NETWORK})
        self.machine.environment["ROBOT_TOKEN"] = SECRET

    def deploy(self, *words: str, code: int | None = 0) -> str:
        return self.machine.rcyaml(*words, cwd=self.folder, code=code)

    def install(self) -> None:
        """On the machine while it is off; units of the machine are only written while it runs."""
        if self.machine.manager == "system":
            self.machine.boot()
        told = self.deploy("install", f"--{self.machine.manager}")
        assert "starts at the next boot" not in told or self.machine.manager == "user", told

    def start(self) -> None:
        if self.machine.manager == "user":
            self.machine.boot()

    def status(self) -> dict[str, dict[str, object]]:
        told, _ = json.JSONDecoder().raw_decode(self.deploy("status", "--format", "json", code=None))
        return {one["name"]: one for one in told["processes"]}

    def until_ready(self) -> dict[str, int]:
        """The pids when systemd reports the service as ready."""
        until(lambda: self.machine.systemctl("is-active", UNIT) == "active\n", self.what_happened)
        status = self.status()
        assert all(one["ready"] for one in status.values()), status
        folder = f"{self.folder}/.rcyaml/deployments/Robot"
        assert [len(programs(folder, name)) for name in status] == [1] * len(status), status
        return {name: int(str(one["pid"])) for name, one in status.items()}

    def what_happened(self) -> str:
        log = self.machine.home / "systemd.log"
        return self.machine.systemctl("status", UNIT) + (log.read_text(errors="replace") if log.exists() else "")


@pytest.fixture
def robot(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[InstalledRobot]:
    """With units of a user, or of the `MANAGERS` that a test wants."""
    need_systemd()
    robot = InstalledRobot(tmp_path, getattr(request, "param", "user"))
    try:
        yield robot
    finally:
        robot.machine.cut()
        kill_left(f"{robot.folder}/.rcyaml/deployments/Robot")


MANAGERS = pytest.mark.parametrize("robot", ["user", "system"], indirect=True)


@MANAGERS
def test_it_comes_up_after_a_power_cut_with_its_secrets(robot: InstalledRobot) -> None:
    robot.install()
    if robot.machine.manager == "system":
        robot.until_ready()
        robot.machine.cut()
    del robot.machine.environment["ROBOT_TOKEN"]  # only the file has it
    for _ in range(2):
        (robot.folder / "token").unlink(missing_ok=True)
        robot.machine.boot()
        robot.until_ready()
        assert (robot.folder / "token").read_text() == SECRET
        robot.machine.cut()
        assert not (robot.machine.run("pgrep", "-f", str(robot.folder)).stdout.strip())
    for path in (robot.folder / ".rcyaml/deployments/Robot/state/boot").iterdir():
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert SECRET not in (robot.machine.units / UNIT).read_text()


@MANAGERS
def test_what_was_killed_is_started_again_and_what_was_taken_down_is_not(robot: InstalledRobot) -> None:
    robot.install()
    robot.start()
    before = robot.until_ready()
    told = robot.machine.run("pgrep", "-f", "robocomp_yaml.deploy.local.supervisor").stdout.split()
    assert told
    robot.machine.run("kill", "-9", *told)
    until(lambda: (now := robot.status())["base"]["ready"] and now["base"]["pid"] != before["base"], "it is back")
    robot.until_ready()
    assert "starts it again at the next boot" in robot.deploy("down")
    until(lambda: robot.machine.systemctl("is-active", UNIT) == "inactive\n", "the service ends")
    assert "not running, installed" in robot.deploy("ls")
    robot.machine.cut()
    robot.machine.boot()
    robot.until_ready()
    assert "installed" in robot.deploy("up")


def test_a_broken_document_does_not_keep_the_robot_down(robot: InstalledRobot) -> None:
    """What was ready last starts instead."""
    robot.deploy("install")
    robot.machine.boot()
    robot.until_ready()
    robot.machine.cut()
    write_tree(robot.folder, {"robot.ddsl.yaml": "deployment: Robot\ncomponents: {base: {programme: oops}}\n"})
    robot.machine.boot()
    until(lambda: robot.machine.systemctl("is-active", UNIT) == "active\n", robot.what_happened)
    assert {name: one["ready"] for name, one in robot.status().items()} == {"base": True, "arm": True}


@MANAGERS
def test_systemd_stops_it_in_order(robot: InstalledRobot) -> None:
    robot.install()
    robot.start()
    robot.until_ready()
    robot.machine.systemctl("stop", UNIT)
    stopped = [line.split()[0] for line in robot.deploy("logs").splitlines() if "stopped: SIGTERM" in line]
    assert stopped == ["arm", "base"]
    assert not any(one["pid"] for one in robot.status().values())


@MANAGERS
def test_uninstall_leaves_nothing(robot: InstalledRobot) -> None:
    home = robot.machine.home
    robot.install()
    robot.start()
    robot.until_ready()
    robot.deploy("uninstall")
    assert robot.machine.systemctl("list-unit-files", "rcyaml-*").count("rcyaml") == 0
    assert not [path for place in ("config", "units") for path in (home / place).rglob("*") if UNIT in path.name]
    assert not list((home / "units").iterdir())
    assert not list((home / "state").rglob("*.json"))
    assert not (robot.folder / ".rcyaml/deployments/Robot/state/boot").exists()
    assert robot.deploy("uninstall", code=2).strip().endswith("Robot is not installed")
    robot.machine.cut()
    robot.machine.boot()
    assert not any(one["pid"] for one in robot.status().values())


def test_nothing_is_written_by_print_and_dry_run(robot: InstalledRobot) -> None:
    printed = robot.deploy("install", "--print")
    assert "[Service]" in printed
    assert SECRET not in printed
    assert "WantedBy=multi-user.target" in robot.deploy("install", "--print", "--system")
    assert "would write ~/.config/systemd/user/rcyaml-Robot.service" in robot.deploy("install", "--dry-run")
    assert not (robot.machine.home / "config").exists()


def test_systemd_accepts_the_units(robot: InstalledRobot, tmp_path: Path) -> None:
    if shutil.which("systemd-analyze") is None:
        pytest.skip("systemd-analyze is not installed (Debian: systemd)")
    for manager in ("user", "system"):
        unit = tmp_path / manager / UNIT
        write_tree(tmp_path, {f"{manager}/{UNIT}": robot.deploy("install", "--print", f"--{manager}")})
        done = subprocess.run(
            ["systemd-analyze", f"--{manager}", "verify", unit], capture_output=True, text=True, check=False,
            env={**os.environ, **robot.machine.environment},
        )  # fmt: skip
        assert UNIT not in done.stderr, done.stderr


def test_a_unit_of_somebody_else_stays(robot: InstalledRobot) -> None:
    other = robot.machine.home / "config/systemd/user" / UNIT
    write_tree(other.parent, {UNIT: "# mine\n[Service]\nExecStart=true\n"})
    assert "RC7081" in robot.deploy("install", code=1)
    assert other.read_text().startswith("# mine")
    del robot.machine.environment["ROBOT_TOKEN"]
    assert "RC7006" in robot.deploy("install", code=1)
