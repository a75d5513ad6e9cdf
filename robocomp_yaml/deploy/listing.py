"""What `deploy ls` shows: the user's own list of deployments, and whether each of them runs."""

from __future__ import annotations

import os
import socket

import msgspec

from robocomp_yaml.deploy import folder, registered
from robocomp_yaml.deploy.engines import LOCAL
from robocomp_yaml.deploy.registered import RegisteredDeployment

_WITHIN = 1.0  # seconds


class ListedDeployment(msgspec.Struct, frozen=True):
    """`state` is `running`, `not running` (its supervisor or registry was killed, or this machine was restarted), or
    `ending` with the hosts that do not answer yet. `has_document` is False if the document is gone, or is now that of
    another deployment."""

    name: str
    state: str
    engine: str
    hosts: tuple[str, ...]
    document: str
    folder: str
    has_document: bool


def listed() -> list[ListedDeployment]:
    return [
        ListedDeployment(
            one.name, _state(one), one.engine, tuple(host.name for host in one.hosts), one.document, one.folder,
            has_document(one),
        )
        for one in registered.every()
    ]  # fmt: skip


def has_document(one: RegisteredDeployment) -> bool:
    return os.path.isfile(one.document) and folder.deployment_in(one.document) == one.name


def _state(one: RegisteredDeployment) -> str:
    if one.pending:
        return f"ending: {', '.join(one.pending)}"
    runs = one.is_supervised or _has_supervisor(one) if one.engine == LOCAL else _answers(one)
    return "running" if runs else "not running"


def _has_supervisor(one: RegisteredDeployment) -> bool:
    from robocomp_yaml.deploy.local import record

    return record.is_there(one.folder) and not record.was_killed(one.folder)


def _answers(one: RegisteredDeployment) -> bool:
    from robocomp_yaml.deploy.icegrid.grid_files import GridFiles

    registry = GridFiles(one.folder).registry() or GridFiles(registered.copies(one.folder)).registry()
    if registry is None:
        return False
    try:
        with socket.create_connection((registry.address, registry.port), _WITHIN):
            return True
    except OSError:
        return False
