"""An installed deployment on two hosts, each with a systemd of its own in a network of its own: it heals when a host
boots late, and after a power cut of all hosts nothing but systemd starts it. With units of users, and of the machines."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from booted import Machine, need_systemd
from conftest import in_long, write_tree
from processes import kill_left, until
from seen import NEEDS_ICEGRID
from ssh_host import NEEDS_SSHD, SshHost, prepared, ssh_host
from three_hosts import three_hosts

NETWORK = """\
deployment: Robot
hosts:
  onboard: {{address: {onboard}, systemd: {manager}}}
  arm: {{address: {arm}, path: {there}, ssh: {ssh}, systemd: {manager}}}
components:
  base: {{program: sleep, args: ["600"], host: onboard, role: server}}
  gripper: {{program: sleep, args: ["600"], cwd: ., host: arm, role: server, env: {{TOKEN: {{env: ROBOT_TOKEN}}}}}}
"""
pytestmark = [
    pytest.mark.slow,
    NEEDS_SSHD,
    NEEDS_ICEGRID,
]


class Robot:
    def __init__(self, folder: Path, onboard: Machine, arm: Machine, there: Path) -> None:
        self.folder, self.onboard, self.arm, self.there = folder, onboard, arm, there

    def deploy(self, *words: str, code: int | None = 0) -> str:
        return self.onboard.rcyaml(*words, cwd=self.folder, code=code)

    def ready(self) -> set[str]:
        told, _ = json.JSONDecoder().raw_decode(self.deploy("status", "--format", "json", code=None))
        return {one["name"] for one in told["processes"] if one["ready"]}

    def why(self) -> str:
        return "".join(
            machine.systemctl("status", "rcyaml-*") + (machine.home / "systemd.log").read_text(errors="replace")
            for machine in (self.onboard, self.arm)
        ) + self.deploy("status", code=None)


@pytest.fixture(params=[pytest.param("user", marks=in_long), "system"])
def robot(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Robot]:
    """Not running, and installed."""
    need_systemd()
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    manager = request.param
    with three_hosts() as hosts, ExitStack() as stack:
        hosts.need_a_network("so every host would be this machine")
        # Not by `ip netns exec`, which hides the control groups that systemd needs.
        inside = {name: ["nsenter", f"--net=/run/netns/{hosts.prefix}{name}"] for name in ("onboard", "arm")}
        place, address = tmp_path / "arm", hosts.addresses["arm"]
        if manager == "user":
            host = stack.enter_context(ssh_host(place, address, inside["arm"]))
        else:
            host = prepared(place, address)
        folder, there = tmp_path / "robot", tmp_path / "there"
        there.mkdir()
        document = NETWORK.format(**hosts.addresses, ssh=host.ssh, there=there, manager=manager)
        write_tree(folder, {"robot.ddsl.yaml": document})
        onboard, arm = Machine(tmp_path / "onboard", inside["onboard"], manager), Machine(place, inside["arm"], manager)
        onboard.environment["ROBOT_TOKEN"] = "a secret"
        robot = Robot(folder, onboard, arm, there)
        try:
            if manager == "system":  # over ssh, the machine itself is reached, which therefore must run
                _serve(arm, host)
                onboard.boot()
                arm.boot()
                until((host.folder / "pid").exists, robot.why)
                robot.deploy("install")
                until(lambda: robot.ready() == {"base", "gripper"}, robot.why)
                arm.cut()
                onboard.cut()
            else:
                robot.deploy("install")
            yield robot
        finally:
            for machine in (onboard, arm):
                machine.cut()
            for path in (folder, there):
                kill_left(f"{path}/.rcyaml/deployments/Robot")


def _serve(machine: Machine, host: SshHost) -> None:
    """Lets the machine start its ssh server when it boots."""
    unit = f"[Service]\nType=exec\nRuntimeDirectory=sshd\nExecStart={' '.join(host.command)}\n"
    write_tree(machine.units, {"ssh.service": unit})
    (machine.units / "multi-user.target.wants").mkdir()
    (machine.units / "multi-user.target.wants" / "ssh.service").symlink_to("../ssh.service")


def test_hosts_that_boot_in_any_order(robot: Robot) -> None:
    robot.onboard.boot()
    until(lambda: robot.ready() == {"base"}, robot.why)
    robot.arm.boot()
    until(lambda: robot.ready() == {"base", "gripper"}, robot.why)
    until(lambda: robot.onboard.systemctl("is-active", "rcyaml-Robot.service") == "active\n", robot.why)
    robot.arm.cut()
    robot.onboard.cut()
    robot.arm.boot()
    robot.onboard.boot()
    until(lambda: robot.ready() == {"base", "gripper"}, robot.why)
    robot.arm.cut()
    until(lambda: robot.ready() == {"base"}, robot.why)
    robot.arm.boot()
    until(lambda: robot.ready() == {"base", "gripper"}, robot.why)
    secret = robot.there / ".rcyaml/deployments/Robot/state/boot/environment"
    assert "a secret" in secret.read_text(encoding="utf-8")
    assert secret.stat().st_mode & 0o777 == 0o600
    assert "RC7081" not in robot.deploy("uninstall")
    for place in (robot.folder, robot.there):
        assert not list(place.rglob("key.pem"))
        assert not list(place.rglob("environment"))
    for machine in (robot.onboard, robot.arm):
        assert not list(machine.units.rglob("rcyaml-*"))
