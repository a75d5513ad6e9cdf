"""From a linked deployment to its network: TCP ports, connections, topics, configurations and order, in this order."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from robocomp_yaml.addresses.interface_comparison import InterfaceComparison
from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedStorm
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.deployment import PLAIN, PROGRAM, TOKEN
from robocomp_yaml.model.located import Text
from robocomp_yaml.network import liveness, processes, ready_when, security
from robocomp_yaml.network.assigned_ports import assign_ports
from robocomp_yaml.network.configuration import Configuration, MadeConfiguration
from robocomp_yaml.network.connections import Connections
from robocomp_yaml.network.draft import Draft, Drafts, drafts_of, text_fault
from robocomp_yaml.network.gates import Gates
from robocomp_yaml.network.network import FOLDER, Network, Process
from robocomp_yaml.network.order import AFTER, Dependence, awaited, optional, ordered
from robocomp_yaml.network.process_causes import causes_of
from robocomp_yaml.network.topics import TopicConnections
from robocomp_yaml.source.file_names import LONGEST_NAME, is_too_long, path_fault, shortened, size
from robocomp_yaml.source.ice_endpoint import fixed_endpoint
from robocomp_yaml.source.ice_options import LAST_PORT, InvalidIceText

if TYPE_CHECKING:
    from robocomp_yaml.parameters.editing.settings import ShownSetting


def derive(linked: LinkedDeployment, program: Program, addresses: Addresses) -> tuple[Network, list[Diagnostic]]:
    """The network of a deployment, as far as it can be derived, and its diagnostics. Flat configs are read from the
    program's disk."""
    deployment = linked.deployment
    folder = os.path.abspath(os.path.join(os.path.dirname(deployment.path), FOLDER, deployment.name))
    drafts = drafts_of(linked, program.disk)
    gates = Gates(drafts)
    gates.add()
    port_faults = list(assign_ports(drafts, addresses))
    comparison = InterfaceComparison()
    connections, topics = Connections(drafts, comparison, gates, addresses), TopicConnections(drafts, comparison)
    connections.resolve()
    gates.connect()
    topics.resolve()
    diagnostics = [
        *port_faults,
        *endpoint_faults(drafts),
        *liveness.faults(drafts),
        *ready_when.faults(drafts),
        *connections.diagnostics,
    ]
    diagnostics += topics.diagnostics
    diagnostics += security.faults(drafts, [*connections.connections, *topics.connections])
    needs = [*_explicit(drafts, gates), *connections.needs, *gates.needs, *topics.needs]
    enabled = {draft.name for draft in drafts.drafts.values() if draft.instance.entry.enabled}
    needed = {need.target for need in needs if need.source in enabled}
    made: dict[str, Process] = {}
    settings: dict[str, Callable[[], list[ShownSetting]]] = {}
    for storm in drafts.storms.values():
        made[storm.name] = processes.of_storm(storm, folder, enabled=storm.name in needed)
    outside: dict[str, set[str]] = {}
    for one in connections.connections:
        if not one.target:
            outside.setdefault(one.source, set()).add(one.port)
    for draft in drafts.drafts.values():
        if gates.is_gate(draft):
            made[draft.name] = processes.of_draft(draft, gates.program(draft), program.disk)
            continue
        configuration = Configuration(draft, program, addresses, outside.get(draft.name, set()))
        made[draft.name] = _with_configuration(configuration, linked.real)
        settings[draft.name] = configuration.settings
        diagnostics += configuration.diagnostics
    order, circles = _put_in_order(made, needs)
    network = Network(
        deployment.name,
        os.path.abspath(deployment.path),
        folder,
        drafts.hosts,
        made,
        (*connections.connections, *gates.connections, *topics.connections),
        tuple(order),
        deployment.control or TOKEN,
        deployment.security or PLAIN,
        deployment.extra,
        settings,
    )
    return network, [*diagnostics, *length_faults(linked, drafts, network), *circles]


def _with_configuration(configuration: Configuration, deployment: str) -> Process:
    """The process of a draft, with the configuration that is made here; the same as in the last analysis if nothing
    has changed for it."""
    draft, program = configuration.draft, configuration.program

    def make() -> tuple[MadeConfiguration, Process]:
        own = configuration.make_once((deployment, draft.name))
        return own, processes.of_draft(draft, own.text, program.disk, own.secrets)

    causes = causes_of(draft, configuration.external, program.disk)
    made, process = program.memory.result(("process", deployment, draft.name), causes, make)
    configuration.use(made)
    return process


def _explicit(drafts: Drafts, gates: Gates) -> Iterable[Dependence]:
    """The dependences of `after:`. A group is ready when processes outside can reach it, that is, with its gates."""
    for draft in drafts.drafts.values():
        texts = draft.instance.entry.after
        for text in texts:
            for gate in gates.before(draft.instance, text.text):
                yield Dependence(draft.name, gate.name, "", AFTER, text.span)
        for target in draft.instance.after:
            if isinstance(target, LinkedStorm):
                name = drafts.linked.storm_instead(target).name
            else:
                name = (target.process or target).name
            span = next((text.span for text in texts if text.text == target.name), draft.span)
            if name != draft.name:
                yield Dependence(draft.name, name, "", AFTER, span)


def _put_in_order(
    made: dict[str, Process], needs: Sequence[Dependence]
) -> tuple[list[tuple[str, ...]], list[Diagnostic]]:  # fmt: skip
    """Adds to each process what it is `after`. Returns the waves, and diagnostics about circles."""
    waves, after, diagnostics = ordered((process.name for process in made.values() if process.enabled), needs)
    can_be_absent, later = optional(needs), awaited(needs, after)
    for name, targets in after.items():
        if targets or name in later:
            without = tuple(target for target in targets if target in can_be_absent[name])
            made[name] = replace(made[name], after=targets, optional=without, awaits=later.get(name, ()))
    return waves, diagnostics


def endpoint_faults(drafts: Drafts) -> Iterator[Diagnostic]:
    usual = f"write a protocol and a port from 1 to {LAST_PORT}, such as `tcp -p 10003`"
    for offer in (offer for draft in drafts.drafts.values() for offer in draft.adapters):
        if offer.explicit and offer.own is None:
            try:
                fixed_endpoint(offer.explicit)
            except InvalidIceText as refused:
                facts = {"name": offer.adapter, "text": offer.explicit}
                yield text_fault(codes.BAD_ENDPOINT, offer.owner, offer.span, offer.explicit, refused, usual, **facts)
        elif offer.number > LAST_PORT:
            hint = "begin with a lower port, or use fewer instances"
            yield codes.PORT_TOO_HIGH.at(offer.span, name=offer.owner.name, port=offer.number, hint=hint)


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
            unit = f"{deployment.name}-{name}.service"  # the longest name of its files
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
    paths: list[tuple[Text | None, str]] = [(program, process.command[0]), (entry.cwd, process.cwd)]
    for text, path in paths:
        fault = path_fault(path)
        if text is not None and fault:
            yield codes.PATH_TOO_LONG.at(text.span, path=shortened(text.text), problem=fault)
            return
