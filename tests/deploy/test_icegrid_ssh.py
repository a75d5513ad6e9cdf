"""A node is started over SSH: with a real sshd on another host and keys of the test, and without leftovers."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import until
from seen import NEEDS_ICEGRID
from three_hosts import Deployment, three_hosts

SSHD = "/usr/sbin/sshd"
NETWORK = """\
deployment: Talk
hosts:
  onboard: {{address: {onboard}}}
  arm: {{address: {arm}}}
components:
  base: {{program: sleep, args: ["600"], host: onboard}}
  gripper: {{program: sleep, args: ["600"], host: arm, after: [base]}}
"""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not os.path.exists(SSHD), reason="there is no sshd (Debian: openssh-server)"),
    NEEDS_ICEGRID,
]


@pytest.fixture
def reached_by_ssh(tmp_path: Path) -> Iterator[Deployment]:
    """Two hosts. The second is reached over SSH, with a key in the home of this test."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with three_hosts() as hosts:
        hosts.need_a_network("so every host would be this machine")
        home, server = tmp_path / "home" / ".ssh", tmp_path / "sshd"
        home.mkdir(parents=True, mode=0o700)
        server.mkdir()
        for key in (home / "id_ed25519", server / "host_key"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", key], check=True)
        host_key = (server / "host_key.pub").read_text()
        (home / "known_hosts").write_text(f"{hosts.addresses['arm']} {host_key}")
        write_tree(server, {
            "config": (
                f"HostKey {server}/host_key\nAuthorizedKeysFile {home}/id_ed25519.pub\nStrictModes no\nUsePAM no\n"
                f"PidFile {server}/pid\nPasswordAuthentication no\n"
            )
        })  # fmt: skip
        os.makedirs("/run/sshd", exist_ok=True)  # where sshd, run by root, wants to be locked in
        sshd = subprocess.Popen(
            ["ip", "netns", "exec", f"{hosts.prefix}arm", SSHD, "-D", "-e", "-f", server / "config"]
        )
        deployment = Deployment(hosts, tmp_path, {"HOME": str(tmp_path / "home"), "SSH_AUTH_SOCK": ""})
        write_tree(tmp_path, {"talk.ddsl.yaml": NETWORK.format(**hosts.addresses)})
        try:
            until(lambda: (server / "pid").exists(), "sshd runs")
            yield deployment
        finally:
            deployment.clean_up()
            sshd.terminate()
            sshd.wait()


def test_a_node_is_started_over_ssh_and_ended_by_down(reached_by_ssh: Deployment) -> None:
    reached_by_ssh.deploy("up")
    assert {name: (one["host"], one["ready"]) for name, one in reached_by_ssh.status().items()} == {
        "base": ("onboard", True), "gripper": ("arm", True),
    }  # fmt: skip
    assert "started, pid" in reached_by_ssh.logs("gripper")
    assert b"nodes/arm/settings" in _commands(reached_by_ssh)
    reached_by_ssh.deploy("down")
    until(lambda: b"nodes/arm/settings" not in _commands(reached_by_ssh), "the node ends with the deployment")


def _commands(deployment: Deployment) -> bytes:
    """The running processes of the deployment."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            found.append(path.read_bytes())
        except OSError:
            continue
    return b"\n".join(one for one in found if deployment.folder.encode() in one)
