"""The records of the installed deployments, in the folder of the user's state."""

from __future__ import annotations

import contextlib
import os

import msgspec

from robocomp_yaml.deploy import registered
from robocomp_yaml.deploy.registered import RegisteredDeployment, RegisteredHost
from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions import whole_file


class InstalledUnit(msgspec.Struct, frozen=True):
    """A unit on a host, with the manager that starts it, and its further files."""

    host: RegisteredHost
    name: str
    manager: str
    files: tuple[str, ...]
    is_here: bool


class Installed(msgspec.Struct, frozen=True):
    """An installed deployment: its document and its own folder (absolute paths), its engine and its units."""

    name: str
    document: str
    folder: str
    engine: str
    units: tuple[InstalledUnit, ...] = ()

    @property
    def entry(self) -> RegisteredDeployment:
        """It as an entry of the user's list."""
        hosts = tuple(unit.host for unit in self.units)
        return RegisteredDeployment(self.name, self.document, self.folder, self.engine, hosts)


def of_folder(folder: str) -> Installed | None:
    """The record of the deployment in this folder, None if it is not installed."""
    return registered.read(_path(folder), Installed)


def hosts_of(folder: str) -> list[str]:
    """The names of the hosts on which the deployment in this folder is installed."""
    record = of_folder(folder)
    return [unit.host.name for unit in record.units] if record else []


def every() -> list[Installed]:
    with contextlib.suppress(OSError):
        records = (registered.read(f"{_root()}/{name}", Installed) for name in sorted(os.listdir(_root())))
        return [one for one in records if one]
    return []


def named(name: str) -> list[RegisteredDeployment]:
    """The installed deployments of this name, as entries of the user's list."""
    return [one.entry for one in every() if one.name == name]


def forget(folder: str) -> None:
    with contextlib.suppress(OSError):
        os.unlink(_path(folder))
    with contextlib.suppress(OSError):
        os.rmdir(_root())


def keep(record: Installed) -> None:
    """Raises OSError."""
    os.makedirs(_root(), mode=0o700, exist_ok=True)
    whole_file.put(_path(record.folder), msgspec.json.encode(record), 0o600)


def _root() -> str:
    return os.path.join(os.path.dirname(registered.root()), "installed")


def _path(folder: str) -> str:
    return os.path.join(_root(), f"{digest(os.fsencode(os.path.realpath(folder)))[:20]}.json")
