"""From a linked deployment to its network: ports, connections, topics, configurations and order, in this order."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence

from msgspec.structs import replace

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedStorm
from robocomp_yaml.link.program import Program
from robocomp_yaml.network import ports, processes
from robocomp_yaml.network.base import Base, base_of
from robocomp_yaml.network.configuration import Configuration
from robocomp_yaml.network.connections import Connections
from robocomp_yaml.network.contents import Contents
from robocomp_yaml.network.draft import Draft
from robocomp_yaml.network.drafts import Drafts, drafts_of
from robocomp_yaml.network.endpoints import endpoint_faults
from robocomp_yaml.network.gates import Gates
from robocomp_yaml.network.lengths import length_faults
from robocomp_yaml.network.network import FOLDER, Network
from robocomp_yaml.network.order import AFTER, Need, optional, ordered
from robocomp_yaml.network.targets import Targets
from robocomp_yaml.network.topics import Topics


def derive(linked: LinkedDeployment, program: Program) -> tuple[Network, list[Diagnostic]]:
    """The network of a deployment, as far as it can be told, and all that is wrong with it. Flat configuration
    files are read from the program's disk."""
    deployment = linked.deployment
    folder = os.path.abspath(os.path.join(os.path.dirname(deployment.path), FOLDER, deployment.name))
    drafts = drafts_of(linked)
    network = Network(deployment.name, os.path.abspath(deployment.path), folder, drafts.hosts, extra=deployment.extra)
    gates = Gates(drafts)
    gates.place()
    ports.assign(drafts)
    bases: dict[Draft, Base] = {}

    def base(draft: Draft) -> Base:
        if draft not in bases:
            bases[draft] = base_of(draft.instance, program.disk)
        return bases[draft]

    contents = Contents()
    targets = Targets(drafts)
    connections, topics = Connections(drafts, contents, gates, targets), Topics(drafts, contents, base)
    connections.resolve()
    gates.connect()
    topics.resolve()
    network.connections = [*connections.found, *gates.found, *topics.found]
    diagnostics = [*endpoint_faults(drafts), *targets.diagnostics, *connections.diagnostics, *topics.diagnostics]
    needs = [*_said(drafts, gates), *connections.needs, *gates.needs, *topics.needs]
    enabled = {draft.name for draft in drafts.drafts.values() if draft.instance.entry.enabled}
    wanted = {need.target for need in needs if need.source in enabled}
    for storm in drafts.storms.values():
        network.processes[storm.name] = processes.of_storm(storm, folder, enabled=storm.name in wanted)
    known: dict[str, tuple[str, ...]] = {}
    for draft in drafts.drafts.values():
        if gates.is_gate(draft):
            text: str | None = gates.program(draft)
            hidden: tuple[str, ...] = ()
        else:
            configuration = Configuration(draft, base(draft), program)
            configuration.make()
            diagnostics += configuration.diagnostics
            text, hidden = configuration.text, configuration.secrets
        network.processes[draft.name] = processes.of_draft(draft, text, known, hidden)
    diagnostics += length_faults(linked, drafts, network)
    diagnostics += _put_in_order(network, needs)
    return network, diagnostics


def _said(drafts: Drafts, gates: Gates) -> Iterable[Need]:
    """What the document says by `after:`. A group is ready when those can reach it that are outside."""
    for draft in drafts.drafts.values():
        texts = draft.instance.entry.after
        for text in texts:
            for gate in gates.before(draft.instance, text.text):
                yield Need(draft.name, gate.name, "", AFTER, text.span)
        for target in draft.instance.after:
            name = target.name if isinstance(target, LinkedStorm) else (target.process or target).name
            span = next((text.span for text in texts if text.text == target.name), draft.span)
            if name != draft.name:
                yield Need(draft.name, name, "", AFTER, span)


def _put_in_order(network: Network, needs: Sequence[Need]) -> list[Diagnostic]:
    waves, after, diagnostics = ordered((process.name for process in network.enabled()), needs)
    network.order = waves
    can_be_absent = optional(needs)
    for name, targets in after.items():
        if targets:
            without = tuple(target for target in targets if target in can_be_absent[name])
            network.processes[name] = replace(network.processes[name], after=targets, optional=without)
    return diagnostics
