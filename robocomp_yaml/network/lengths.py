"""Names and paths that no file can have: what runs has files of its own, called after it."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedDeployment
from robocomp_yaml.model.deployment import PROGRAM, Text
from robocomp_yaml.network.draft import Draft
from robocomp_yaml.network.drafts import Drafts
from robocomp_yaml.network.network import Network, Process
from robocomp_yaml.source.file_names import LONGEST_NAME, is_too_long, path_fault, shortened, size


def length_faults(linked: LinkedDeployment, drafts: Drafts, network: Network) -> Iterator[Diagnostic]:
    deployment = linked.deployment
    if is_too_long(f"{deployment.name}.target"):
        yield _too_long("deployment", deployment.name, f"{deployment.name}.target", deployment.span)
        return
    for host in network.hosts.values():
        if is_too_long(host.name):
            yield _too_long("host", host.name, host.name, host.span)
    for process in network.processes.values():
        for name in (process.name, *process.aliases):
            unit = f"{deployment.name}-{name}.service"  # the longest of its files
            if is_too_long(unit):
                yield _too_long("entry", name, unit, process.span)
    for draft in drafts.drafts.values():
        if draft.name in network.processes:
            yield from _paths(draft, network.processes[draft.name])
    if fault := path_fault(network.folder):
        yield codes.PATH_TOO_LONG.at(deployment.span, path=shortened(network.folder), problem=fault)


def _too_long(what: str, name: str, file: str, span: Span) -> Diagnostic:
    return codes.NAME_TOO_LONG.at(
        span,
        what=what,
        name=shortened(name),
        file=shortened(file),
        size=size(file),
        limit=LONGEST_NAME,
        hint=f"shorten it by {size(file) - LONGEST_NAME}",
    )


def _paths(draft: Draft, process: Process) -> Iterator[Diagnostic]:
    entry = draft.instance.entry
    program = entry.target if entry.kind == PROGRAM else entry.executable
    given: list[tuple[Text | None, str]] = [(program, process.command[0]), (entry.cwd, process.cwd)]
    for text, path in given:
        fault = path_fault(path)
        if text is not None and fault:
            yield codes.PATH_TOO_LONG.at(text.span, path=shortened(text.text), problem=fault)
            return
