"""The ports of a workspace: those that values documents give, or that stand in an `etc/config`, else defaults.

A port that a configuration of the workspace names is taken; of two defaults that meet, the later name (component, then
interface) moves on to the next free port. So the ports depend on the workspace's names alone, and stay once they stand
in an `etc/config`.
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


class Ports(msgspec.Struct):
    """The endpoint of each adapter (real path of the component's document, interface's name) of a workspace, and which
    components implement an interface (module, name), in order of their paths."""

    endpoints: dict[tuple[str, str], IceEndpoint] = {}
    implementers: dict[tuple[str, str], list[tuple[LinkedComponent, str]]] = {}

    def endpoint(self, linked: LinkedComponent, name: str) -> IceEndpoint:
        return self.endpoints[document(linked), name]


def document(linked: LinkedComponent) -> str:
    """What tells a component from another, whatever its path was spelled like."""
    return os.path.realpath(linked.component.path)


def adapters(linked: LinkedComponent) -> list[str]:
    """The names of the adapters that need a port of their own."""
    return list(dict.fromkeys([*(use.name for use in linked.component.implements), COMMON_BEHAVIOR]))


def assign(components: Iterable[LinkedComponent], disk: Disk, values: Iterable[LinkedValues] = ()) -> Ports:
    """The ports of a workspace's components: those that their values give, those that stand in their `etc/config`,
    else defaults."""
    given = {one.parameters.component: one for one in values if one.parameters and is_own(one)}
    distinct = {document(linked): linked for linked in components}
    ordered = sorted(distinct.items(), key=lambda item: (item[1].component.name, item[0]))
    result = Ports()
    taken = set(RESERVED)
    for key, linked in ordered:
        texts = {name: entry.value for name, entry in _written(linked, disk)}
        if linked in given:  # which `compile` writes there
            texts |= _given(given[linked])
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
    return port.scope.module.name, port.interface.name


def clashes(components: Iterable[LinkedComponent], disk: Disk) -> list[Diagnostic]:
    """Endpoints that stand in the components' `etc/config` and cannot be had at once on one machine."""
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
            for host, other, place in others:
                if not host or not endpoint.host or host == endpoint.host:
                    diagnostics.append(
                        codes.PORT_CLASH.at(
                            span,
                            port=endpoint.port,
                            name=who,
                            other=other,
                            hint="give one of them another port",
                            related=[Related("the same port", place)],
                        )
                    )
                    break
            others.append((endpoint.host, who, span))
    return diagnostics


def config_path(linked: LinkedComponent) -> str:
    return os.path.join(os.path.dirname(linked.component.path), CONFIG)


def is_own(values: LinkedValues) -> bool:
    """Whether they are what the component is configured from: `etc/config.yaml` in its folder."""
    component = values.parameters.component if values.parameters else None
    if component is None:
        return False
    own = os.path.join(os.path.dirname(component.component.path), f"{CONFIG}.yaml")
    return os.path.realpath(own) == os.path.realpath(values.document.path)


def _given(values: LinkedValues) -> dict[str, str]:
    from robocomp_yaml.parameters.writing.properties import given  # most components have no values
    from robocomp_yaml.source.tree import Scalar

    return {name: node.lexeme for name, node in given(values, "endpoints") if isinstance(node, Scalar)}


def _written(linked: LinkedComponent, disk: Disk) -> Iterator[tuple[str, IceProperty]]:
    """The endpoint properties of an `etc/config`, by adapter, in either dialect."""
    path = config_path(linked)
    raw = disk.read(path)[0] if disk.has_file(path) else None
    for key, entry in properties.read((raw or b"").decode(errors="replace")).last.items():
        if key.startswith("Endpoints."):
            yield key.removeprefix("Endpoints."), entry
        elif key.endswith(".Endpoints"):
            yield key.removesuffix(".Endpoints"), entry
