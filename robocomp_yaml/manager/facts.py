"""What a person needs to know to change a network: the ports of each entry, and the types of its parameters and
methods, from which the page makes its fields."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import Any

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.link.deployments import LinkedInstance, Served, offers
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import Enum, Map, Member, Sequence, Struct, TypeRef
from robocomp_yaml.network.network import PROXY, Network
from robocomp_yaml.parameters.types import BasicType, EnumType, RecordType, ResolvedMember, Type, is_secret, unit_of
from robocomp_yaml.parameters.words import in_words
from robocomp_yaml.semantics.limits import LIMITS

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
             "serves": _served(one.offers())}
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
    component = instances[name].component
    return {
        "name": name,
        "parameters": list(_parameters(component)) if component is not None else [],
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
    written = next((each.name for each in one.document.entries if each.span == entry.span), entry.name)
    return {
        "process": one.name, "entry": f"{one.scope}{written}", "scope": one.scope,
        "document": os.path.normpath(one.document.path), "line": entry.span.line,
        "kind": entry.kind, "host": one.host.name if one.host is not None else "",
        "component": component.component.path if component is not None else "",
        "requires": [
            {"port": port.name, "interface": port.interface.name, "to": used.get(port.name, "")}
            for port in (component.requires if component is not None else ())
        ],
        "serves": _served(offers(one)),
        "topics": [
            {"port": port.name, "interface": port.interface.name, "out": is_out, "topic": topics.get(port.name, "")}
            for is_out, ports in ((True, component.publishes), (False, component.subscribes)) for port in ports
        ] if component is not None else [],
        "instances": entry.instances, "after": [each.text for each in entry.after],
    }  # fmt: skip


def _served(found: Iterable[Served]) -> list[dict[str, str]]:
    return [{"port": one.name, "interface": one.port.interface.name if one.port else one.name} for one in found]


def _parameters(component: LinkedComponent) -> Iterator[dict[str, Any]]:
    if not component.parameters.broken:
        yield from _members(component.parameters.parameters.root, "", False)


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


def _input(scope: LinkedModule, member: Member) -> dict[str, Any]:
    found = scope.find(member.type)
    choices = [one.name for one in found[1].enumerators] if found and isinstance(found[1], Enum) else None
    return {
        "name": member.name, "type": member.type.text if found is None else "enum" if choices else "other",
        "words": member.type.text, "doc": member.doc, "unit": member.unit, "zero": _zero(scope, member.type, 0),
        **({"choices": choices} if choices else {}),
    }  # fmt: skip


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
            return {one.name: _zero(inner, one.type, depth + 1) for one in members}
        case Map() | _:
            return {}
