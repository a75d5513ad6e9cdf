"""Hosts with keys of their own: a component stands elsewhere there, is pushed, checked before anything starts, and runs
with the host's variables, Python and limits. With a real sshd in a network namespace."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import kill_left, until
from seen import NEEDS_ICEGRID
from ssh_host import NEEDS_SSHD, ssh_host
from three_hosts import Deployment, three_hosts

NETWORK = """\
deployment: Talk
limits: {{nice: 3}}
hosts:
  onboard: {{address: {onboard}}}
  arm:
    address: {arm}
    path: {there}
    env: {{SIDE: left, HAND: two}}
    python: {python}
    limits: {{core: off}}
    ssh: {ssh}
services: {{storm: {{icestorm: {{host: arm}}}}}}
components:
  base: {{program: sleep, args: ["600"], host: onboard}}
  gripper:
    program: ./gripper
    host: arm
    env: {{HAND: right}}
    limits: {{files: 333}}
    ready: {{log: the right hand}}
  mouth: {{component: mouth, host: arm}}
"""
GRIPPER = "#!/bin/sh\necho the $HAND hand of the $SIDE arm in $(pwd)\nexec sleep 600\n"
MOUTH = "component: MouthComp\nlanguage: python\nimports: [../Mouth]\nimplements: [Mouth]\nsubscribes: [Heard]\n"
INTERFACES = "module: Talking\ninterfaces:\n  Mouth: {methods: {open: }}\ntopics:\n  Heard: {methods: {word: }}\n"

pytestmark = [
    pytest.mark.slow,
    NEEDS_SSHD,
    pytest.mark.skipif(shutil.which("rsync") is None, reason="there is no rsync (Debian: rsync)"),
    NEEDS_ICEGRID,
]


@pytest.fixture
def arm(tmp_path: Path) -> Iterator[Deployment]:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with three_hosts() as hosts:
        hosts.need_a_network("so every host would be this machine")
        inside = ["ip", "netns", "exec", f"{hosts.prefix}arm"]
        with ssh_host(tmp_path / "ssh", hosts.addresses["arm"], inside) as host:
            root, there = tmp_path / "robot", tmp_path / "there"
            names = {**hosts.addresses, "ssh": host.ssh, "there": there, "python": sys.executable}
            write_tree(root, {
                "rcyaml.yaml": "", "talk.ddsl.yaml": NETWORK.format(**names), "gripper": GRIPPER,
                "Mouth.idsl.yaml": INTERFACES, "mouth/mouth.cdsl.yaml": MOUTH,
            })  # fmt: skip
            (root / "gripper").chmod(0o755)
            folder = f"{there}/.rcyaml/deployments/Talk"
            deployment = Deployment(hosts, root, {"XDG_STATE_HOME": str(tmp_path / "state")}, (folder,))
            try:
                deployment.rcyaml("compile")
                yield deployment
            finally:
                kill_left(folder)
                deployment.clean_up()


def test_a_host_with_its_own_folder(arm: Deployment) -> None:
    there = arm.root.parent / "there"
    # All that is missing is reported at once, with what repairs it.
    told = arm.deploy("up", code=1)
    assert told.count("RC7002") == 2, told
    assert re.search(r"`rcyaml deploy push talk\.ddsl\.yaml arm` brings it", told)
    assert "base" not in {name for name, one in arm.status().items() if one["pid"]}
    arm.deploy("push")
    assert not (there / "talk.ddsl.yaml").exists()
    arm.deploy("up")
    status = arm.status()
    assert {name: one["ready"] for name, one in status.items()} == dict.fromkeys(status, True)
    assert f"the right hand of the left arm in {there}" in arm.logs("gripper")
    assert (there / ".rcyaml/deployments/Talk/logs/gripper.log").exists()
    assert not (arm.root / ".rcyaml/deployments/Talk/logs/gripper.log").exists()
    pid = status["gripper"]["pid"]
    assert os.getpriority(os.PRIO_PROCESS, pid) == 3
    limits = Path(f"/proc/{pid}/limits").read_text(encoding="utf-8")
    assert re.search(r"Max open files +333 +333", limits)
    assert re.search(r"Max core file size +0 +0", limits)
    mouth = Path(f"/proc/{status['mouth']['pid']}")
    assert os.fsdecode((mouth / "cmdline").read_bytes().split(b"\0")[0]) == sys.executable
    assert str(there) in os.fsdecode((mouth / "cmdline").read_bytes())
    # A change here makes what is there stale.
    worker = arm.root / "mouth/src/specificworker.py"
    worker.write_text(worker.read_text(encoding="utf-8") + "# changed\n", encoding="utf-8")
    told = arm.deploy("up", code=1)
    assert "has another version of" in told
    assert f"{there}/mouth/src/specificworker.py" in told
    assert arm.status()["mouth"]["pid"] == status["mouth"]["pid"], "nothing was stopped"
    assert "sent 1 file" in arm.deploy("push", "mouth")
    arm.deploy("up")
    arm.deploy("down")
    until(lambda: not _running(str(there)), "the node ends with the deployment")
    assert not list((there / ".rcyaml/deployments/Talk").rglob("key.pem"))


def _running(word: str) -> list[str]:
    """Commands of running processes that contain a word."""
    done = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True)
    return [line for line in done.stdout.splitlines() if f"--Ice.Config={word}" in line]
