"""What documents imply, in words that are shown beside their text."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.span import Span
from robocomp_yaml.lsp import users
from robocomp_yaml.lsp.session import KnownNames
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName
from robocomp_yaml.parameters.editing.show import shown

_MOST = 4
Note = tuple[Span, str, str]
"""A location, a short text for it, and a longer one."""


def lens_of(known: KnownNames, one: DefinedName) -> Iterator[str]:
    """What is shown above a name."""
    analysis = known.analysis
    if one.kind in (kinds.INTERFACE, kinds.TOPIC):
        counts = [f"{len(found)} {_VERBS[list_][len(found) == 1]}" for list_, found in
                  users.of_interface(analysis.program, one.key)]  # fmt: skip
        yield ", ".join(counts) or "no component uses it"
    elif one.kind == kinds.COMPONENT:
        count = len(users.of_component(analysis, one.key[1]))
        yield "no process" if not count else "1 process" if count == 1 else f"{count} processes"
    elif one.kind == kinds.ENTRY:
        for real, linked in analysis.program.deployments.items():
            if linked.deployment.path == one.key[1] and real in analysis.networks:
                yield from _connections(known, real, one)


_VERBS = {
    "implements": ("implement it", "implements it"), "requires": ("require it", "requires it"),
    "publishes": ("publish it", "publishes it"), "subscribes": ("subscribe to it", "subscribes to it"),
}  # fmt: skip


def _connections(known: KnownNames, real: str, one: DefinedName) -> Iterator[str]:
    network = known.analysis.networks[real]
    linked = known.program.deployments[real]
    mine = {each.name for each in linked.instances.values()
            if each.document is linked.deployment and each.entry.span.line == one.span.line
            and each.entry.span.file == one.span.file}  # fmt: skip
    out = [each for each in network.connections if each.source in mine]
    into = [each for each in network.connections if each.target in mine]
    if out or into:
        yield f"{len(out)} connection{'' if len(out) == 1 else 's'}, {len(into)} to it"


def hints_of(known: KnownNames, path: str) -> Iterator[Note]:
    """What is shown in the lines of a document."""
    yield from _endpoints(known, path)
    yield from _ports(known, path)
    yield from _defaults(known, path)


def _endpoints(known: KnownNames, path: str) -> Iterator[Note]:
    """In a deployment: where an entry serves, and to what it is connected."""
    for real, linked in known.program.deployments.items():
        network = known.analysis.networks.get(real)
        if linked.deployment.path != path or network is None:
            continue
        seen: set[Span] = set()
        for instance in linked.instances.values():
            process = network.processes.get(instance.name)
            span = instance.entry.target.span
            if instance.document is not linked.deployment or process is None or span in seen:
                continue
            seen.add(span)
            served = [f"{each.interface} {each.port}" for each in process.endpoints if each.port]
            lines = [f"{each.interface}: {each.text}" for each in process.endpoints]
            lines += users.connected(known.analysis, real, instance.name)
            if lines:
                label = ", ".join(served[:_MOST]) + (" …" if len(served) > _MOST else "")
                yield span, f"⟨{label}⟩" if label else "⟨…⟩", "\n".join(lines)


def _ports(known: KnownNames, path: str) -> Iterator[Note]:
    """In a component: the TCP ports of its own configuration."""
    for linked in known.program.components.values():
        if linked.component.path != path or linked.broken:
            continue
        table = known.analysis.addresses.table(linked)
        for port in linked.implements:
            made = table.endpoints.get(table.key(linked, port.name))
            if made is not None:
                more = f"the endpoint of {port.name} in its own configuration"
                yield port.use.span, f"⟨{made.protocol} {made.port}⟩", more
        for name, resolved in table.resolve(linked).items():
            for port in linked.requires:
                if port.name == name and resolved.component is not None:
                    more = f"{resolved.component.component.name}: {resolved.proxy}"
                    yield port.use.span, f"⟨→ {resolved.component.component.name}⟩", more


def _defaults(known: KnownNames, path: str) -> Iterator[Note]:
    """In a values document: the defaults of parameters that it does not set."""
    for linked in known.program.values.values():
        is_here = linked.document.path == path and linked.parameters is not None  # its component may be unknown
        found = known.program.effective(linked)[0] if is_here else None
        section = linked.document.root.entries.get("parameters")
        if found is None or section is None:
            continue
        rows = [f"{row.path}: {row.text}" for row in shown(found, reveal=False) if row.node is None]
        if rows:
            count = f"{len(rows)} default{'' if len(rows) == 1 else 's'}"
            label = ", ".join(rows) if len(rows) <= _MOST and len(", ".join(rows)) < 60 else count
            yield section[0].span, f"⟨{label}⟩", "\n".join(rows)
