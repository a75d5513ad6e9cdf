"""An installed deployment on two hosts, each with a systemd of its own in a network of its own: it heals when a host
boots late, and after a power cut of all hosts nothing but systemd starts it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from booted import Machine, need_systemd
from conftest import write_tree
from processes import kill_left, until
from ssh_host import NEEDS_SSHD, ssh_host
from three_hosts import three_hosts

NETWORK = """\
deployment: Robot
hosts:
  onboard: {{address: {onboard}}}
  arm: {{address: {arm}, path: {there}, ssh: {ssh}}}
components:
  base: {{program: sleep, args: ["600"], host: onboard, role: server}}
  gripper: {{program: sleep, args: ["600"], cwd: ., host: arm, role: server, env: {{TOKEN: {{env: ROBOT_TOKEN}}}}}}
"""
pytestmark = [
    pytest.mark.slow,
    NEEDS_SSHD,
    pytest.mark.skipif(shutil.which("icegridnode") is None, reason="IceGrid is not installed (Debian: zeroc-icegrid)"),
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


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Robot]:
    need_systemd()
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with three_hosts() as hosts:
        hosts.need_a_network("so every host would be this machine")
        # Not by `ip netns exec`, which hides the control groups that systemd needs.
        inside = {name: ["nsenter", f"--net=/run/netns/{hosts.prefix}{name}"] for name in ("onboard", "arm")}
        with ssh_host(tmp_path / "arm", hosts.addresses["arm"], inside["arm"]) as host:
            folder, there = tmp_path / "robot", tmp_path / "there"
            there.mkdir()
            write_tree(folder, {"robot.ddsl.yaml": NETWORK.format(**hosts.addresses, ssh=host.ssh, there=there)})
            machines = Machine(tmp_path / "onboard", inside["onboard"]), Machine(tmp_path / "arm", inside["arm"])
            machines[0].environment["ROBOT_TOKEN"] = "a secret"
            try:
                yield Robot(folder, *machines, there)
            finally:
                for machine in machines:
                    machine.cut()
                for place in (folder, there):
                    kill_left(f"{place}/.rcyaml/deployments/Robot")


def test_hosts_that_boot_in_any_order(robot: Robot) -> None:
    robot.deploy("install")
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
    assert not list((robot.arm.home / "config").rglob("rcyaml-*"))
