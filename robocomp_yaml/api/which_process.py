"""Which process `rcyaml run NAME` means: an entry of a deployment, or a component by itself."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.api import which
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.deploy.alone import Alone
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.listing import some
from robocomp_yaml.digraph import reachable
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


class Overrides(msgspec.Struct, frozen=True):
    """What a run has instead of what its documents say: values of parameters by their paths, and a configuration."""

    settings: Mapping[str, str] = {}
    config: str = ""


def choose(
    name: str, deployment: str, include: Sequence[str], overrides: Overrides, *, alone: bool, with_needed: bool
) -> ChosenProcess:  # fmt: skip
    """Raises Refused if no process is meant, or more than one, and Faulty if its documents have errors."""
    folders = tuple(include)
    around = [which.deployment(deployment, folders)] if deployment else [] if alone else _around(name, folders)
    analyses = {path: analyse([path], folders) for path in around}
    found = [one for path, analysis in analyses.items() for one in _in_deployment(analysis, path, name)]
    if len(found) > 1:
        _refuse_several(name, found)
    if found:
        if has_errors(found[0].analysis.diagnostics):
            raise _faulty(found[0].analysis)
        return _with(found[0], overrides, folders)
    broken = [
        analysis for path, analysis in analyses.items()
        if os.path.realpath(path) not in analysis.networks or (deployment and has_errors(analysis.diagnostics))
    ]  # fmt: skip
    if broken:
        raise _faulty(*broken)
    try:
        if deployment:
            raise Refused(f"{deployment} has no entry or component '{name}'")
        path = which.component(name)
    except Refused as refused:
        raise Refused(_unknown(name, analyses, str(refused), is_only=bool(deployment))) from None
    return _by_itself(path, folders, overrides, with_needed=with_needed)


def _with(chosen: ChosenProcess, overrides: Overrides, include: tuple[str, ...]) -> ChosenProcess:
    """The same process of the deployment with other values."""
    if not (overrides.settings or overrides.config):
        return chosen
    from robocomp_yaml.api.overridden import in_entry

    name, path = chosen.process.name, chosen.document
    analysis = in_entry(chosen.analysis, path, name, overrides.settings, overrides.config, include)
    network = analysis.networks[os.path.realpath(path)]
    return replace(chosen, analysis=analysis, network=network, process=network.processes[name])


def _around(name: str, include: tuple[str, ...]) -> list[str]:
    """The deployments of the working folder, or else of its workspace; of the workspace of a path to another one."""
    root = root_above("") or "."
    folders = dict.fromkeys((".", root))
    top = os.path.realpath(root)
    if os.path.exists(name) and os.path.commonpath([top, os.path.realpath(name)]) != top:
        other = root_above(name if os.path.isdir(name) else os.path.dirname(name))
        folders = {} if other is None else {other: None}
    return next(filter(None, (which.deployments_of(folder, include) for folder in folders)), [])


def _in_deployment(analysis: Analysis, path: str, name: str) -> Iterator[ChosenProcess]:
    """The processes of a deployment that are meant: those of this name, alias or entry, else those of this component.
    None if errors leave no network."""
    real = os.path.realpath(path)
    linked, network = analysis.program.deployments.get(real), analysis.networks.get(real)
    if linked is None or network is None:
        return
    process = network.find(name)
    named = [process] if process else [*_of_entry(linked, network, name)]
    for one in named or _of_component(linked, network, name):
        folder = f"{os.path.dirname(network.path)}/{RUNS}/{network.name}.{one.name}"
        yield ChosenProcess(analysis, network, one, path, folder, path)


def _faulty(*analyses: Analysis) -> Faulty:
    diagnostics = dict.fromkeys(one for analysis in analyses for one in analysis.diagnostics)
    return Faulty(diagnostics, sum(analysis.program.documents for analysis in analyses))


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


def _unknown(name: str, analyses: Mapping[str, Analysis], otherwise: str, *, is_only: bool) -> str:
    """What to say about a name that means nothing. `otherwise` is the message about components alone."""
    if not analyses or "/" in name or os.path.exists(name):
        return otherwise
    networks = [analysis.networks[os.path.realpath(path)] for path, analysis in analyses.items()]
    processes = [process for network in networks for process in network.processes.values()]
    entries = [one for process in processes for one in (process.name, *process.aliases)]
    components = [] if is_only else [component_in(path) for path in of_kind(root_above("") or ".", "cdsl")]
    where = otherwise if is_only else f"no deployment or component has the name '{name}'"
    hint = f"the entries are {some(entries, 8)}" if entries else ""
    return where + meant(name, [*entries, *filter(None, components)], hint)


def _by_itself(
    path: str, include: tuple[str, ...], overrides: Overrides, *, with_needed: bool
) -> ChosenProcess:  # fmt: skip
    """A component without a deployment; `with_needed` also reads the components that it can need."""
    analysis = analyse([path], include)
    if not has_errors(analysis.diagnostics) and with_needed:
        servers = _servers(analysis, analysis.program.components[os.path.realpath(path)])
        analysis = analyse([path, *servers], include) if servers else analysis
    if has_errors(analysis.diagnostics) or os.path.realpath(path) not in analysis.program.components:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    if overrides.config:
        raise Refused("--config is for entries of a deployment: `-- FILE` passes another configuration to the program")
    if overrides.settings:
        from robocomp_yaml.api.overridden import in_values

        analysis = in_values(analysis, path, overrides.settings, include)
    linked = analysis.program.components[os.path.realpath(path)]
    workspace = analysis.workspaces.of(path)
    root = workspace.root if workspace.declared else os.path.dirname(path)
    network = Alone(linked, root, analysis.program, analysis.addresses.table(linked)).network()
    return ChosenProcess(analysis, network, network.processes[linked.component.name], path, network.folder)


def _servers(analysis: Analysis, linked: LinkedComponent) -> list[str]:
    """The documents of the components of the workspace that serve what a component requires, directly or not."""
    table = analysis.addresses.table(linked)
    every = reachable([linked], lambda one: [of for port in one.requires for of, _ in table.implementers.of(port)])
    return [one.component.path for one in every if one is not linked]
