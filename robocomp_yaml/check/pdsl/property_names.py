"""Names of properties: each belongs to one parameter, and to nothing of Ice or of the component's ports."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, Program
from robocomp_yaml.parameters.spelling.templates import exact_keys, row_keys
from robocomp_yaml.parameters.types import BasicType, EnumType, leaves
from robocomp_yaml.semantics.connections import endpoints, proxy
from robocomp_yaml.semantics.spellings import pattern

_ICE = frozenset(
    "Ice IceStorm IceBox IceGrid IceSSL IceDiscovery IceLocatorDiscovery IcePatch2 IceBridge IceMX Freeze Glacier2 "
    "DataStorm".split()
)
_RESERVED = {
    "Endpoints": "the endpoints",
    "Proxies": "the proxies",
    "TopicManager": "the topic manager",
    "statemachine": "the states of a state machine",
}


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.parameter_documents():
        if not linked.broken:
            assert linked.document is not None
            taken = dict(_properties_of_ports(linked.component)) if linked.component else {}
            owner = linked.component.component.path if linked.component else ""
            part, causes = ("property names", linked.document.path, owner), (linked.parameters, *taken.items())
            yield from program.memory.listed(part, causes, partial(_property_names, linked, taken))


def _property_names(linked: LinkedParameters, taken: Mapping[str, str]) -> Iterator[Diagnostic]:
    parameters = linked.parameters
    spans = {path: member.span for path, member in leaves(parameters.root)}
    spans |= {spelling.path: spelling.span for spelling in parameters.spellings if spelling.path in spans}
    yield from _within_document(linked, spans)
    types = {path: member.type for path, member in leaves(parameters.root)}
    warned: set[str] = set()
    for path, key, is_spelled in exact_keys(parameters):
        first = key.partition(".")[0]
        has_tail = "." in key or not (is_spelled or isinstance(types[path], (BasicType, EnumType)))
        if key in taken:
            yield codes.PROPERTY_CLASH.at(spans[path], name=path, other=taken[key], property=key)
        elif has_tail and first in _ICE:
            yield codes.PROPERTY_CLASH.at(spans[path], name=path, other="a property of Ice", property=f"{first}.…")
        elif has_tail and first in _RESERVED:
            yield codes.PROPERTY_CLASH.at(spans[path], name=path, other=_RESERVED[first], property=f"{first}.…")
        elif has_tail and first in taken and first not in warned:
            warned.add(first)
            yield codes.PROPERTY_PREFIX.at(spans[path], name=path, other=taken[first])


def _within_document(linked: LinkedParameters, spans: dict[str, Span]) -> Iterator[Diagnostic]:
    keys: dict[str, str] = {}
    for path, key, _ in exact_keys(linked.parameters):
        other = keys.setdefault(key, path)
        if other != path:
            yield codes.PROPERTY_CLASH.at(spans[path], name=path, other=f"'{other}'", property=key)
    rows: dict[str, str] = {}
    for path, row in row_keys(linked.parameters):
        other = rows.setdefault(row, path)
        if other != path:
            yield codes.PROPERTY_CLASH.at(spans[path], name=path, other=f"'{other}'", property=row)
        in_row = pattern(row)
        for key, owner in keys.items():
            if owner != path and in_row.match(key):
                yield codes.PROPERTY_CLASH.at(spans[path], name=path, other=f"'{owner}'", property=key)


def _properties_of_ports(component: LinkedComponent) -> Iterator[tuple[str, str]]:
    """The properties that the component's ports use, each with its owner."""
    names = [port.name for port in (*component.implements, *component.subscribes)]
    for name in ("CommonBehavior", *names, *(f"{port.name}Topic" for port in component.subscribes)):
        yield name, f"the adapter {name}"
        yield endpoints(name)[0], f"the endpoints of {name}"
    for port in component.publishes:
        yield port.name, f"the topic {port.name}"
    for port in component.requires:
        yield proxy(port.name)[0], f"the proxy {port.name}"
