"""What `deploy ls` shows: the user's own list of deployments, and whether each of them runs."""

from __future__ import annotations

import os

import msgspec

from robocomp_yaml.deploy import folder, registered
from robocomp_yaml.deploy.engines import LOCAL
from robocomp_yaml.deploy.install import installed as records
from robocomp_yaml.deploy.registered import RegisteredDeployment
from robocomp_yaml.diag.terminal import typed


class ListedDeployment(msgspec.Struct, frozen=True):
    """`state` is `running`, `not running` (its supervisor or registry was killed, or this machine was restarted), or
    `ending` with the hosts that do not answer yet. `has_document` is False if the document is gone, or is now that of
    another deployment. `installed` are the hosts on which systemd starts it at boot."""

    name: str
    state: str
    engine: str
    hosts: tuple[str, ...]
    document: str
    folder: str
    has_document: bool
    installed: tuple[str, ...] = ()


def listed() -> list[ListedDeployment]:
    """The running deployments, and those that are installed."""
    every = registered.every()
    installed = {one.folder: tuple(unit.host.name for unit in one.units) for one in records.every()}
    found = [_listed(one, _state(one), installed.pop(one.folder, ())) for one in every]
    for one in records.every():
        if one.folder in installed:
            found.append(_listed(one.entry, "not running", installed[one.folder]))
    return sorted(found, key=lambda one: (one.name, one.folder))


def _listed(one: RegisteredDeployment, state: str, installed: tuple[str, ...]) -> ListedDeployment:
    hosts = tuple(host.name for host in one.hosts)
    return ListedDeployment(
        one.name, state, one.engine, hosts, one.document, one.folder, has_document(one), installed
    )  # fmt: skip


def has_document(one: RegisteredDeployment) -> bool:
    return os.path.isfile(one.document) and folder.deployment_in(one.document) == one.name


def hint_without_document(folder: str) -> str:
    """How to see a deployment that runs, and whose document was below this folder and is gone; '' if there is none."""
    top = os.path.join(os.path.realpath(folder), "")
    gone = [one for one in registered.every() if os.path.realpath(one.document).startswith(top)]
    name = next((one.name for one in gone if not has_document(one) and runs(one)), "")
    status = typed("rcyaml", "deploy", "status", name)
    return f"{name} runs here, and its document is gone: `{status}` shows its ports" if name else ""


def _state(one: RegisteredDeployment) -> str:
    if one.pending:
        return f"ending: {', '.join(one.pending)}"
    return "running" if runs(one) else "not running"


def runs(one: RegisteredDeployment) -> bool:
    """Whether its supervisor or its registry runs."""
    return (one.is_supervised or _has_supervisor(one)) if one.engine == LOCAL else _answers(one)


def _has_supervisor(one: RegisteredDeployment) -> bool:
    from robocomp_yaml.deploy.local import record

    return record.is_there(one.folder) and not record.was_killed(one.folder)


def _answers(one: RegisteredDeployment) -> bool:
    from robocomp_yaml.deploy.icegrid.grid_files import GridFiles

    registry = GridFiles(one.folder).registry() or GridFiles(registered.copies(one.folder)).registry()
    return registry is not None and registry.listens
