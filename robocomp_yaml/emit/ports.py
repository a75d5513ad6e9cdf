"""The TCP ports of a workspace: those that values documents or an `etc/config` set, else defaults.

A default is never a port that a configuration of the workspace uses. If two defaults are equal, the later name
(component, then interface) gets the next free port. Defaults therefore depend only on names, and do not change once
they are in an `etc/config`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

import msgspec

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port
from robocomp_yaml.network.port_numbers import COMMON_BEHAVIOR, RESERVED, default_port, next_free
from robocomp_yaml.source import properties
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint
from robocomp_yaml.source.properties import IceProperty


class PortTable(msgspec.Struct):
    """The endpoint of each adapter of a workspace (key: real path of the component's document, name of the interface),
    and the components that implement an interface (key: module, name), in the order of their paths."""

    endpoints: dict[tuple[str, str], IceEndpoint] = {}
    implementers: dict[tuple[str, str], list[tuple[LinkedComponent, str]]] = {}

    def endpoint(self, linked: LinkedComponent, name: str) -> IceEndpoint:
        """The endpoint of an adapter of a component."""
        return self.endpoints[document(linked), name]


def document(linked: LinkedComponent) -> str:
    """The real path of a component's document, which identifies the component."""
    return os.path.realpath(linked.component.path)


def adapters(linked: LinkedComponent) -> list[str]:
    """The names of the adapters of a component."""
    return list(dict.fromkeys([*(use.name for use in linked.component.implements), COMMON_BEHAVIOR]))


def assign(components: Iterable[LinkedComponent], disk: Disk, values: Iterable[LinkedValues] = ()) -> PortTable:
    """The ports of a workspace's components: those that values documents set, those of `etc/config`, else defaults."""
    configured = {one.parameters.component: one for one in values if one.parameters and is_own(one)}
    distinct = {document(linked): linked for linked in components}
    ordered = sorted(distinct.items(), key=lambda item: (item[1].component.name, item[0]))
    result = PortTable()
    taken = set(RESERVED)
    for key, linked in ordered:
        texts = {name: entry.value for name, entry in _written(linked, disk)}
        if linked in configured:  # `compile` writes these to etc/config
            texts |= _set_endpoints(configured[linked])
        for name, text in texts.items():
            endpoint = parse_endpoint(text)
            if endpoint:
                result.endpoints[key, name] = endpoint
                taken.add(endpoint.port)
    for key, linked in ordered:
        for name in sorted(adapters(linked)):
            if (key, name) not in result.endpoints:
                number = next_free(default_port(linked.component.name, name), taken)
                result.endpoints[key, name] = IceEndpoint(number)
                taken.add(number)
    for _, linked in sorted(distinct.items()):
        for port in linked.implements:
            result.implementers.setdefault(interface_key(port), []).append((linked, port.name))
    return result


def interface_key(port: Port) -> tuple[str, str]:
    """Module and name of the interface of a port."""
    return port.scope.module.name, port.interface.name


def clashes(components: Iterable[LinkedComponent], disk: Disk) -> list[Diagnostic]:
    """Diagnostics about endpoints of `etc/config` that cannot be used on one host at the same time."""
    diagnostics = []
    seen: dict[tuple[bool, int], list[tuple[str, str, Span]]] = {}
    for linked in sorted(components, key=lambda linked: linked.component.path):
        for name, entry in _written(linked, disk):
            endpoint = parse_endpoint(entry.value)
            if endpoint is None:
                continue
            span = Span(config_path(linked), entry.line, entry.column, entry.line, entry.column + len(entry.key))
            who = f"{linked.component.name}'s {name}"
            others = seen.setdefault((endpoint.protocol == "udp", endpoint.port), [])
            for host, other, location in others:
                if not host or not endpoint.host or host == endpoint.host:
                    diagnostics.append(
                        codes.PORT_CLASH.at(
                            span, port=endpoint.port, name=who, other=other, hint="set another port for one of them",
                            related=[Related("the same port", location)],
                        )
                    )  # fmt: skip
                    break
            others.append((endpoint.host, who, span))
    return diagnostics


def config_path(linked: LinkedComponent) -> str:
    """The path of a component's `etc/config`."""
    return os.path.join(os.path.dirname(linked.component.path), CONFIG)


def is_own(values: LinkedValues) -> bool:
    """Whether a values document is the `etc/config.yaml` of its component."""
    component = values.parameters.component if values.parameters else None
    if component is None:
        return False
    own = os.path.join(os.path.dirname(component.component.path), f"{CONFIG}.yaml")
    return os.path.realpath(own) == os.path.realpath(values.document.path)


def _set_endpoints(values: LinkedValues) -> dict[str, str]:
    from robocomp_yaml.parameters.writing.properties import merged_entries  # most components have no values document
    from robocomp_yaml.source.tree import Scalar

    return {name: node.lexeme for name, node in merged_entries(values, "endpoints") if isinstance(node, Scalar)}


def _written(linked: LinkedComponent, disk: Disk) -> Iterator[tuple[str, IceProperty]]:
    """The endpoint properties of an `etc/config` by adapter, in both dialects."""
    path = config_path(linked)
    raw = disk.read(path)[0] if disk.has_file(path) else None
    for key, entry in properties.read((raw or b"").decode(errors="replace")).last.items():
        if key.startswith("Endpoints."):
            yield key.removeprefix("Endpoints."), entry
        elif key.endswith(".Endpoints"):
            yield key.removesuffix(".Endpoints"), entry
