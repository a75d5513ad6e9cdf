"""A host that is reached over ssh: a real sshd with keys of the test, on loopback or in a network namespace. Nothing of
the machine's own ssh is used."""

from __future__ import annotations

import os
import socket
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from conftest import write_tree
from processes import until

SSHD = "/usr/sbin/sshd"
NEEDS_SSHD = pytest.mark.skipif(not os.path.exists(SSHD), reason="there is no sshd (Debian: openssh-server)")


@dataclass(frozen=True)
class SshHost:
    """`folder` has the keys and the log of the server. `state` is the folder of the user's state on the host."""

    folder: Path
    address: str
    port: int

    @property
    def ssh(self) -> str:
        """The key `ssh:` for a document."""
        return f"{{port: {self.port}, identity: {self.folder}/key, known-hosts: {self.folder}/known_hosts}}"

    @property
    def state(self) -> Path:
        return self.folder / "state"

    @property
    def command(self) -> list[str]:
        """The command that runs the server."""
        return [SSHD, "-D", "-f", f"{self.folder}/sshd_config", "-E", f"{self.folder}/log"]

    @property
    def logins(self) -> int:
        return (self.folder / "log").read_text(encoding="utf-8").count("Accepted publickey")


@contextmanager
def ssh_host(folder: Path, address: str = "127.0.0.1", inside: Sequence[str] = ()) -> Iterator[SshHost]:
    """A running server. `inside` are the words that run a command on the host."""
    host = prepared(folder, address)
    os.makedirs("/run/sshd", exist_ok=True)  # where sshd, run by root, wants to be locked in
    server = subprocess.Popen([*inside, *host.command])
    try:
        until(lambda: (folder / "pid").exists(), "sshd runs")
        yield host
    finally:
        server.terminate()
        server.wait()


def prepared(folder: Path, address: str) -> SshHost:
    """A server that does not run yet."""
    folder.mkdir(parents=True)
    with socket.create_server(("127.0.0.1", 0)) as free:
        host = SshHost(folder, address, free.getsockname()[1])
    for name in ("key", "host_key"):
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / name], check=True)
    write_tree(folder, {
        "known_hosts": f"[{address}]:{host.port} {(folder / 'host_key.pub').read_text(encoding='utf-8')}",
        "sshd_config": (
            f"HostKey {folder}/host_key\nAuthorizedKeysFile {folder}/key.pub\nStrictModes no\nUsePAM no\n"
            f"PidFile {folder}/pid\nPasswordAuthentication no\nPort {host.port}\nListenAddress {address}\n"
            f"SetEnv XDG_STATE_HOME={host.state} XDG_CONFIG_HOME={folder}/config XDG_RUNTIME_DIR={folder}/run\n"
        ),
    })  # fmt: skip
    return host
