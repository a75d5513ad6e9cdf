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


def of_folder(folder: str) -> Installed | None:
    """The record of the deployment in this folder, None if it is not installed."""
    with contextlib.suppress(OSError, ValueError), open(_path(folder), "rb") as file:
        return msgspec.json.decode(file.read(), type=Installed)
    return None


def hosts_of(folder: str) -> list[str]:
    """The names of the hosts on which the deployment in this folder is installed."""
    record = of_folder(folder)
    return [unit.host.name for unit in record.units] if record else []


def every() -> list[Installed]:
    found = []
    with contextlib.suppress(OSError):
        for name in sorted(os.listdir(_root())):
            with contextlib.suppress(OSError, ValueError), open(f"{_root()}/{name}", "rb") as file:
                found.append(msgspec.json.decode(file.read(), type=Installed))
    return found


def named(name: str) -> list[RegisteredDeployment]:
    """The installed deployments of this name, as entries of the user's list."""
    return [
        RegisteredDeployment(one.name, one.document, one.folder, one.engine, tuple(unit.host for unit in one.units))
        for one in every()
        if one.name == name
    ]


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
