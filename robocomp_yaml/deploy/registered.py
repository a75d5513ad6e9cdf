"""The user's own list of running deployments, in the folder of the user's state (`$XDG_STATE_HOME`, mode 0700).

So a running deployment is never lost: it can be seen and stopped by its name, also without its document and its folder.
An entry is a folder with a description, and copies of the files that the engine needs.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Iterable
from typing import TypeVar

import msgspec

from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.network.network import Network, NetworkHost, SshAccess
from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions import whole_file

T = TypeVar("T")
_ENTRY = "deployment.json"
_COPIES = "files"


class RegisteredHost(msgspec.Struct, frozen=True):
    """A host with how ssh reaches it. `user` is from entries of earlier versions, which had only that."""

    name: str
    address: str
    user: str = ""
    ssh: SshAccess = SshAccess()
    folders: tuple[tuple[str, str], ...] = ()
    systemd: str = ""

    @property
    def host(self) -> NetworkHost:
        ssh = SshAccess(self.user) if self.user else self.ssh
        return NetworkHost(self.name, self.address, ssh, self.folders, systemd=self.systemd)


class RegisteredDeployment(msgspec.Struct, frozen=True):
    """A running deployment: its document and its own folder (absolute paths), its engine and its hosts. `supervisor` is
    the pid of what runs it on this machine, with its start time, because a pid can be reused; 0 if that is unknown.
    `pending` are hosts on which it still has to be ended."""

    name: str
    document: str
    folder: str
    engine: str
    hosts: tuple[RegisteredHost, ...] = ()
    supervisor: int = 0
    start: int = 0
    pending: tuple[str, ...] = ()

    @property
    def is_supervised(self) -> bool:
        """Whether its supervisor runs on this machine."""
        found = procfs.entry(self.supervisor) if self.supervisor else None
        return found is not None and not found.is_dead and found.start == self.start


def entry_of(network: Network, engine: str, supervisor: int = 0, start: int = 0) -> RegisteredDeployment:
    hosts = tuple(map(host_of, network.hosts.values()))
    return RegisteredDeployment(network.name, network.path, network.folder, engine, hosts, supervisor, start)


def host_of(host: NetworkHost) -> RegisteredHost:
    return RegisteredHost(host.name, host.address, ssh=host.ssh, folders=host.folders, systemd=host.systemd)


def root() -> str:
    base = os.environ.get("XDG_STATE_HOME", "")
    return os.path.join(base if os.path.isabs(base) else os.path.expanduser("~/.local/state"), "rcyaml", "deployments")


def private(folder: str) -> str:
    """The user's own folder about the deployment in this folder."""
    return os.path.join(root(), digest(os.fsencode(os.path.realpath(folder)))[:20])


def made_private(folder: str) -> str:
    """The same, created with mode 0700. Raises OSError."""
    own = private(folder)
    make_folder(own)
    return own


def make_folder(path: str) -> None:
    """Creates a folder of the user's state, with mode 0700. Raises OSError."""
    for one in (os.path.dirname(path), path):
        os.makedirs(one, mode=0o700, exist_ok=True)
        os.chmod(one, 0o700)


def authority(folder: str) -> str:
    """The folder with the certificates of the deployment in this folder. `down` does not remove it."""
    return os.path.join(os.path.dirname(root()), "authorities", os.path.basename(private(folder)))


def copies(folder: str) -> str:
    """The folder with the copies of the files of the deployment in this folder."""
    return f"{private(folder)}/{_COPIES}"


def keep(one: RegisteredDeployment) -> None:
    """Adds or replaces an entry, also that of the same supervisor in a folder that was moved since. Raises OSError."""
    folder = made_private(one.folder)
    whole_file.put(f"{folder}/{_ENTRY}", msgspec.json.encode(one), 0o600)
    for other in every() if one.supervisor else ():
        if (other.supervisor, other.start) == (one.supervisor, one.start) and other.folder != one.folder:
            forget(other.folder)


def copy(folder: str, paths: Iterable[str]) -> None:
    """Keeps copies of these files of a registered deployment's folder. Raises OSError."""
    for path in paths:
        target = f"{copies(folder)}/{path}"
        with contextlib.suppress(FileNotFoundError), open(f"{folder}/{path}", "rb") as file:
            os.makedirs(os.path.dirname(target), mode=0o700, exist_ok=True)
            whole_file.put(target, file.read(), 0o600)


def restore(folder: str) -> bool:
    """Writes the copies of a registered deployment into its folder. Returns whether there are any. Raises OSError."""
    top, found = copies(folder), False
    for where, _, names in os.walk(top):
        for name in names:
            target = os.path.join(folder, os.path.relpath(os.path.join(where, name), top))
            os.makedirs(os.path.dirname(target), mode=0o700, exist_ok=True)
            with open(os.path.join(where, name), "rb") as file:
                whole_file.put(target, file.read(), 0o600)
            found = True
    return found


def forget(folder: str) -> None:
    """Removes the entry of the deployment in this folder, and the copies of its files."""
    own = private(folder)
    shutil.rmtree(f"{own}/{_COPIES}", ignore_errors=True)
    with contextlib.suppress(OSError):
        os.unlink(f"{own}/{_ENTRY}")
    with contextlib.suppress(OSError):
        os.rmdir(own)


def of_folder(folder: str) -> RegisteredDeployment | None:
    return _read(private(folder))


def every() -> list[RegisteredDeployment]:
    """All entries, by name. An entry without anything that is left of its deployment is removed."""
    found = []
    with contextlib.suppress(OSError):
        for name in os.listdir(root()):
            one = _read(os.path.join(root(), name))
            if one and (one.is_supervised or os.path.isdir(f"{one.folder}/state") or one.engine != "local"):
                found.append(one)
            elif one:  # with its token: also if its folder was moved
                shutil.rmtree(os.path.join(root(), name), ignore_errors=True)
    return sorted(found, key=lambda one: (one.name, one.folder))


def named(name: str) -> list[RegisteredDeployment]:
    return [one for one in every() if one.name == name]


def of_document(path: str) -> RegisteredDeployment | None:
    document = os.path.abspath(path)
    return next((one for one in every() if one.document == document), None)


def _read(folder: str) -> RegisteredDeployment | None:
    """The entry in a folder, None if there is no valid one."""
    return read(f"{folder}/{_ENTRY}", RegisteredDeployment)


def read(path: str, kind: type[T]) -> T | None:
    """A record of the user's state, None if there is no valid one."""
    with contextlib.suppress(OSError, ValueError), open(path, "rb") as file:
        return msgspec.json.decode(file.read(), type=kind)
    return None
