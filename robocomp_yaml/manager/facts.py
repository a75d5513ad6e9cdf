"""What a person needs to know to change a network: the ports of each entry, and the types of its parameters and
methods, from which the page makes its fields."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from itertools import count, takewhile
from typing import Any

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.link.deployments import LinkedInstance, Served, offers
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.deployment import Entry
from robocomp_yaml.model.interface import Enum, Map, Member, Sequence, Struct, TypeRef
from robocomp_yaml.network.network import PROXY, Network
from robocomp_yaml.parameters.types import BasicType, EnumType, RecordType, ResolvedMember, Type, is_secret, unit_of
from robocomp_yaml.parameters.words import in_words
from robocomp_yaml.semantics.limits import LIMITS
from robocomp_yaml.source.ice_endpoint import parse_endpoint

_DEEPEST = 8  # of types that contain themselves


def entries_of(workspace: Workspace, path: str) -> dict[str, Any]:
    """The processes of a deployment with their entries and ports, and what can be added to it."""
    program, real = workspace.analysis.program, os.path.realpath(path)
    linked, network = program.deployments.get(real), workspace.analysis.networks.get(real)
    components = [one for one in program.components.values() if not one.broken]
    hosts = linked.hosts.values() if linked is not None else ()
    return {
        "entries": [_entry(one, network) for one in linked.instances.values()] if linked is not None else [],
        "hosts": [{"name": host.name, "address": host.address.text} for host in hosts],
        "groups": [
            {"name": one.name, "members": [member.name for member in one.members], "closed": one.is_closed,
             "serves": _served(one.offers()), "written": one.group.include is None}
            for one in linked.groups.values()
        ] if linked is not None else [],
        "services": list(linked.storms) if linked is not None else [],
        "components": sorted((_component(one) for one in components), key=lambda one: str(one["name"])),
        "interfaces": sorted({
            (each.name, each.is_topic) for scope in program.modules.values() for each in scope.module.all_interfaces
        }),
    }  # fmt: skip


def process_of(workspace: Workspace, path: str, name: str) -> dict[str, Any]:
    """The parameters and methods of a process. Raises Refused if it is unknown."""
    linked = workspace.analysis.program.deployments.get(os.path.realpath(path))
    instances = linked.instances if linked is not None else {}
    if name not in instances:
        raise Refused(f"there is no process '{name}'{meant(name, instances)}")
    component, network = instances[name].component, workspace.analysis.networks.get(os.path.realpath(path))
    present = {one.key: one.data for one in network.settings_of(name)} if network is not None else {}
    return {
        "name": name,
        "parameters": [
            one if one["secret"] else one | _present(str(one["path"]), present) for one in _parameters(component)
        ]
        if component is not None
        else [],
        "methods": [one for port in component.implements for one in _methods(name, port)] if component else [],
    }


def _component(linked: LinkedComponent) -> dict[str, Any]:
    return {
        "name": linked.component.name, "path": linked.component.path,
        **{key: [port.name for port in getattr(linked, key)] for key in _KEYS},
    }  # fmt: skip


_KEYS = ("implements", "requires", "publishes", "subscribes")


def _entry(one: LinkedInstance, network: Network | None) -> dict[str, Any]:
    entry, component = one.entry, one.component
    connections = [each for each in network.connections if each.source == one.name] if network is not None else []
    used = {each.port: each.target or each.proxy for each in connections if each.kind == PROXY}
    topics = {each.port: each.topic for each in connections if each.kind != PROXY}
    written = next((each for each in one.document.entries if each.span == entry.span), entry)
    return {
        "process": one.name, "entry": f"{one.scope}{written.name}", "scope": one.scope,
        "document": os.path.normpath(one.document.path), "line": entry.span.line,
        "kind": entry.kind, "host": one.host.name if one.host is not None else "",
        "component": component.component.path if component is not None else "",
        "requires": [
            {"port": port.name, "interface": port.interface.name, "to": used.get(port.name, "")}
            for port in (component.requires if component is not None else ())
        ],
        "serves": [each | {"number": _port(written, component, each["port"])} for each in _served(offers(one))],
        "topics": [
            {"port": port.name, "interface": port.interface.name, "out": is_out, "topic": topics.get(port.name, "")}
            for is_out, ports in ((True, component.publishes), (False, component.subscribes)) for port in ports
        ] if component is not None else [],
        "instances": entry.instances, "after": [each.text for each in entry.after],
    }  # fmt: skip


def _port(entry: Entry, component: LinkedComponent | None, interface: str) -> int | None:
    """The TCP port of an interface that an entry sets."""
    first = next((port.name for port in component.implements), "") if component is not None else ""
    written = {one.name or first: one.number for one in (*entry.ports, *([entry.port] if entry.port else ()))}
    endpoints = {one.name: endpoint.port for one in entry.endpoints if (endpoint := parse_endpoint(one.text))}
    return (endpoints | written).get(interface)


def _served(found: Iterable[Served]) -> list[dict[str, str]]:
    return [{"port": one.name, "interface": one.port.interface.name if one.port else one.name} for one in found]


def _parameters(component: LinkedComponent) -> Iterator[dict[str, Any]]:
    if not component.parameters.broken:
        yield from _members(component.parameters.parameters.root, "", False)


def _present(path: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """The value that a parameter has in this network; the elements of a list are values of their own."""
    if path in values:
        return {"present": values[path]}
    elements = list(takewhile(lambda one: one in values, (f"{path}[{number}]" for number in count())))
    return {"present": [values[one] for one in elements]} if elements else {}


def _members(type_: RecordType, prefix: str, editable: bool) -> Iterator[dict[str, Any]]:
    for member in type_.members:
        path, can = f"{prefix}{member.name}", editable or member.editable
        if isinstance(member.type, RecordType):
            yield from _members(member.type, f"{path}.", can)
        else:
            yield {"path": path, "editable": can, **_field(member)}


def _field(member: ResolvedMember) -> dict[str, Any]:
    type_, secret = member.type, is_secret(member.type)
    made = {
        "type": type_.name if isinstance(type_, (BasicType, RecordType)) else "enum" if isinstance(type_, EnumType)
        else "other",
        "words": in_words(type_), "doc": member.documentation, "unit": unit_of(type_), "secret": secret,
        **_limits(type_),
    }  # fmt: skip
    if member.default is not None and not secret:
        made["default"] = member.default.data
    return made


def _limits(type_: Type) -> dict[str, Any]:
    if isinstance(type_, EnumType):
        return {"choices": list(type_.allowed)}
    if not isinstance(type_, BasicType):
        return {}
    if type_.values:
        return {"choices": [one.value for one in type_.values]}
    if not type_.is_number:
        return {}
    least, most = LIMITS[type_.name]
    found = {"low": least, "high": most} if type_.is_integer else {}
    if type_.range is not None:
        found |= {"low": type_.range.low.value} if type_.range.low else {}
        found |= {"high": type_.range.high.value} if type_.range.high else {}
    return found


def _methods(name: str, port: Port) -> Iterator[dict[str, Any]]:
    for method in port.interface.methods:
        yield {
            "name": f"{name}.{port.name}.{method.name}", "doc": method.doc,
            "inputs": [_input(port.scope, one) for one in method.inputs],
        }  # fmt: skip


def _input(scope: LinkedModule, member: Member, depth: int = 0) -> dict[str, Any]:
    """An argument, or a member of one that is a struct."""
    found, zero = scope.find(member.type), member.default.value if member.default else _zero(scope, member.type, depth)
    made = {"name": member.name, "type": member.type.text, "words": member.type.text, "doc": member.doc,
            "unit": member.unit, "zero": zero}  # fmt: skip
    if found is None:
        return made
    inner, definition = found
    example: Any = zero
    match definition:
        case Enum(enumerators=enumerators):
            return made | {"type": "enum", "choices": [one.name for one in enumerators]}
        case Struct(members=members) if depth < _DEEPEST:
            return made | {"type": "struct", "members": [_input(inner, one, depth + 1) for one in members]}
        case Sequence(element=element):
            example = [_zero(inner, element, depth)]
        case Map(key=key, value=value):
            example = {str(_zero(inner, key, depth) or "…"): _zero(inner, value, depth)}
    return made | {"type": "other", "words": f"{member.type.text}, such as {json.dumps(example, ensure_ascii=False)}"}


def _zero(scope: LinkedModule, ref: TypeRef, depth: int) -> Any:
    """The simplest value of a type, from which a person starts."""
    found = scope.find(ref)
    if found is None:
        return {"string": "", "bool": False, "float": 0.0, "double": 0.0}.get(ref.text, 0)
    inner, definition = found
    match definition:
        case Enum(enumerators=(first, *_)):
            return first.name
        case Sequence():
            return []
        case Struct(members=members) if depth < _DEEPEST:
            return {
                one.name: one.default.value if one.default else _zero(inner, one.type, depth + 1) for one in members
            }  # fmt: skip
        case Map() | _:
            return {}
