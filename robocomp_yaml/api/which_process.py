"""Which process `rcyaml run NAME` means: an entry of a deployment, or a component by itself."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

import msgspec

from robocomp_yaml.api import which
from robocomp_yaml.api.neighbours import ports
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.deploy.alone import Alone
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.link.deployments import LinkedDeployment
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.network.network import RUNS, Network, Process
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.discover import of_kind
from robocomp_yaml.source.heading import component_in


class ChosenProcess(msgspec.Struct, frozen=True):
    """A process of a network. `document` is the path of the deployment, '' for a component by itself; `path` is that of
    the document that describes the process. `folder` is for what is written for a run."""

    analysis: Analysis
    network: Network
    process: Process
    path: str
    folder: str
    document: str = ""


def choose(name: str, deployment: str, include: Sequence[str], *, alone: bool, with_needed: bool) -> ChosenProcess:
    """Raises Refused if no process is meant, or more than one, and Faulty if its documents have errors."""
    folders = tuple(include)
    around = [which.deployment(deployment, folders)] if deployment else [] if alone else _around(folders)
    if around:
        analysis = analyse(around, folders)
        found = [one for path in around for one in _in_deployment(analysis, path, name)]
        if len(found) == 1:
            return found[0]
        if found:
            _refuse_several(name, found)
        if deployment or has_errors(analysis.diagnostics):
            _refuse_unknown(name, analysis, around, deployment)
        try:
            path = which.component(name)
        except Refused:
            _refuse_unknown(name, analysis, around, deployment)
    else:
        path = which.component(name)
    return _by_itself(path, folders, with_needed=with_needed)


def _around(include: tuple[str, ...]) -> list[str]:
    """The deployments of the working folder, or else of its workspace."""
    folders = dict.fromkeys((".", root_above("") or "."))
    return next(filter(None, (which.deployments_of(folder, include) for folder in folders)), [])


def _in_deployment(analysis: Analysis, path: str, name: str) -> Iterator[ChosenProcess]:
    """The processes of a deployment that are meant: those of this name, alias or entry, else those of this component.
    Raises Faulty if errors leave no network."""
    linked, network = analysis.program.deployments.get(os.path.realpath(path)), analysis.networks.get(
        os.path.realpath(path)
    )  # fmt: skip
    if linked is None or network is None:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    process = network.find(name)
    named = (
        [process] if process else list(_of_entry(linked, network, name)) or list(_of_component(linked, network, name))
    )
    if named and has_errors(analysis.diagnostics):
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    for one in named:
        folder = f"{os.path.dirname(network.path)}/{RUNS}/{network.name}.{one.name}"
        yield ChosenProcess(analysis, network, one, path, folder, path)


def _of_entry(linked: LinkedDeployment, network: Network, name: str) -> Iterator[Process]:
    """The processes of an entry with `instances:`, or of a group."""
    for process in network.processes.values():
        instance = linked.instances.get(process.name)
        targets, rest = linked.find(name, "") if instance is not None else ((), "")
        if not rest and instance is not None and (instance in targets or name in process.groups):
            yield process


def _of_component(linked: LinkedDeployment, network: Network, name: str) -> Iterator[Process]:
    try:
        path = os.path.realpath(which.component(name))
    except Refused:
        return
    for process in network.processes.values():
        instance = linked.instances.get(process.name)
        if instance is not None and instance.component is not None:
            if os.path.realpath(instance.component.component.path) == path:
                yield process


def _refuse_several(name: str, found: Sequence[ChosenProcess]) -> None:
    documents = list(dict.fromkeys(one.document for one in found))
    if len(documents) > 1:
        hint = " or ".join(f"`--deployment {path}`" for path in documents)
        raise Refused(f"'{name}' is in several deployments: choose one by {hint}, or `--alone` for none")
    names = ", ".join(one.process.name for one in found)
    raise Refused(f"'{name}' means several processes of {documents[0]}: {names}; name one of them")


def _refuse_unknown(name: str, analysis: Analysis, around: Sequence[str], deployment: str) -> None:
    if has_errors(analysis.diagnostics):
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    networks = [analysis.networks[os.path.realpath(path)] for path in around]
    known = [
        one
        for network in networks
        for process in network.processes.values()
        for one in (process.name, *process.aliases)
    ]
    own = [component_in(path) for path in of_kind(root_above("") or ".", "cdsl")] if not deployment else []
    where = f"{deployment} has no entry or component" if deployment else "no deployment or component has the name"
    raise Refused(
        f"{where} '{name}'{meant(name, [*known, *filter(None, own)], f'known are {_listed(known)}' if known else '')}"
    )


def _listed(names: Sequence[str], limit: int = 8) -> str:
    more = f" and {len(names) - limit} more" if len(names) > limit else ""
    return ", ".join(names[:limit]) + more


def _by_itself(path: str, include: tuple[str, ...], *, with_needed: bool) -> ChosenProcess:
    """A component without a deployment; `with_needed` also reads the components that it can need."""
    analysis = analyse([path], include)
    if not has_errors(analysis.diagnostics) and with_needed:
        servers = _servers(analysis, analysis.program.components[os.path.realpath(path)])
        analysis = analyse([path, *servers], include) if servers else analysis
    if has_errors(analysis.diagnostics) or os.path.realpath(path) not in analysis.program.components:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    linked = analysis.program.components[os.path.realpath(path)]
    workspace = analysis.linker.workspace_of(path)
    root = workspace.root if workspace.declared else os.path.dirname(path)
    network = Alone(linked, root, analysis.program, ports(analysis)(linked)).network()
    return ChosenProcess(analysis, network, network.processes[linked.component.name], path, network.folder)


def _servers(analysis: Analysis, linked: LinkedComponent) -> list[str]:
    """The documents of the components of the workspace that serve what a component requires, directly or not."""
    table = ports(analysis)(linked)
    found, pending = dict[str, None](), [linked]
    while pending:
        for port in pending.pop().requires:
            for other, _ in table.implementers.get((port.scope.module.name, port.interface.name), ()):
                if other.component.path not in found and other.component.path != linked.component.path:
                    found[other.component.path] = None
                    pending.append(other)
    return list(found)
