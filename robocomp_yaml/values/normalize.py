"""Effective values made complete: defaults filled in at every level, by Cerberus where something is missing.

What lacks nothing, or is not given at all, needs none of it, parameter by parameter and entry by entry, since Cerberus
is a hundred times slower than the compiled schema that tells.
"""

from __future__ import annotations

import copy
from typing import Any

import jsonschema_rs

from robocomp_yaml.link.program import LinkedParameters
from robocomp_yaml.model.parameters import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Member,
    RecordType,
    Type,
)
from robocomp_yaml.semantics.references import Unresolved, is_sound
from robocomp_yaml.values.defaults import defaults
from robocomp_yaml.values.json_schema import (
    COMPLETE,
    DOCUMENT,
    EFFECTIVE,
    complete_schema,
    values_schema,
)

Data = dict[str, Any]


def fits(linked: LinkedParameters, mode: str, data: object) -> bool:
    """The JSON Schema's verdict on what stands under `parameters:`."""
    return _gate(linked, mode).is_valid(data)


def _gate(linked: LinkedParameters, mode: str) -> jsonschema_rs.Draft7Validator:
    assert mode in (DOCUMENT, EFFECTIVE, COMPLETE)
    if mode not in linked.compiled:
        linked.compiled[mode] = jsonschema_rs.Draft7Validator(values_schema(linked.parameters, mode))
    gate: jsonschema_rs.Draft7Validator = linked.compiled[mode]
    return gate


def normalized(linked: LinkedParameters, data: Data) -> Data | None:
    """Effective values (without null) with their defaults; None where Cerberus refuses them."""
    if fits(linked, COMPLETE, data):
        return data
    root, out = linked.parameters.root, {}
    for member in root.members:
        if member.name not in data and (member.optional or not _has_default(member)):
            if member.required:
                return None
            continue
        value = _member(linked, member, data)
        if value is None:
            return None
        out[member.name] = value[0]
    return None if data.keys() - {member.name for member in root.members} else out


def _has_default(member: Member) -> bool:
    return member.default is not None or member.is_group


def _member(linked: LinkedParameters, member: Member, data: Data) -> tuple[Any] | None:
    """A parameter's normalized value, in a tuple."""
    gate = _entry_gate(linked, member.name, member)
    value = data[member.name] if member.name in data else defaults(RecordType("", (member,))).get(member.name)
    if gate.is_valid(value):
        return (value,)
    element = member.type.element if isinstance(member.type, ListType) else None
    if isinstance(element, RecordType) and isinstance(data.get(member.name), list):
        return _records(linked, member, element, data[member.name])
    return _by_cerberus(linked, member.name, RecordType("", (member,)), data)


def _records(linked: LinkedParameters, member: Member, element: RecordType, items: list[Any]) -> tuple[Any] | None:
    """A list of records. Only those go through Cerberus that lack something, and of those that lack the same only the
    first: the defaults of a record are always the same."""
    one = Member("entry", element)
    gate = _entry_gate(linked, f"{member.name}[]", one)
    whole = RecordType("", (one,))
    out: list[Any] = []
    added: dict[tuple[str, ...], Data] = {}  # what Cerberus added to a record with these keys
    for item in items:
        if gate.is_valid(item):
            out.append(item)
            continue
        keys = tuple(item)
        filled = {**item, **copy.deepcopy(added[keys])} if keys in added else None
        if filled is None or not gate.is_valid(filled):
            made = _by_cerberus(linked, f"{member.name}[]", whole, {"entry": item})
            if made is None:
                return None
            filled = made[0]
            added[keys] = {name: value for name, value in filled.items() if name not in item}
        out.append(filled)
    assert isinstance(member.type, ListType)
    return (out,) if member.type.size.holds(len(out)) else None


def _entry_gate(linked: LinkedParameters, key: str, member: Member) -> jsonschema_rs.Draft7Validator:
    if ("gate", key) not in linked.compiled:
        linked.compiled["gate", key] = jsonschema_rs.Draft7Validator(complete_schema(member.type))
    gate: jsonschema_rs.Draft7Validator = linked.compiled["gate", key]
    return gate


def _by_cerberus(linked: LinkedParameters, key: str, record: RecordType, data: Data) -> tuple[Any] | None:
    """The one member of `record`, with its defaults."""
    from robocomp_yaml.values.rules import ParameterValidator, rules_of

    if ("cerberus", key) not in linked.compiled:
        linked.compiled["cerberus", key] = ParameterValidator(rules_of(record))
    validator = linked.compiled["cerberus", key]
    name = record.members[0].name
    given = {name: with_references(record.members[0].type, data[name])} if name in data else {}
    if not validator.validate(given):
        return None
    return (as_data(record.members[0].type, validator.document[name]),)


def cerberus_verdict(root: RecordType, data: object) -> tuple[bool, Any]:
    """Cerberus's own verdict on whole effective values, and what it makes of them."""
    from robocomp_yaml.values.rules import ParameterValidator, rules_of

    if not isinstance(data, dict):
        return False, None
    validator = ParameterValidator(rules_of(root))
    verdict = validator.validate(with_references(root, copy.deepcopy(data)))
    return bool(verdict), as_data(root, validator.document)


_NOTHING = object()  # for null, which Cerberus would take for a wish for the default


def with_references(type_: Type, data: Any) -> Any:
    """A reference, where a plain value stands, as an object of its own, so that Cerberus takes it for one."""
    if data is None:
        return _NOTHING
    match type_:
        case BasicType() | EnumType():
            return Unresolved(dict(data)) if is_sound(data) else data
        case ListType(element=element) if isinstance(data, list):
            return [with_references(element, item) for item in data]
        case MapType(element=element) if isinstance(data, dict):
            return {key: with_references(element, value) for key, value in data.items()}
        case RecordType() if isinstance(data, dict):
            types = {member.name: member.type for member in type_.members}
            return {key: with_references(types[key], value) if key in types else value for key, value in data.items()}
        case _:
            return data


def as_data(type_: Type, data: Any) -> Any:
    """What Cerberus made as plain data: references as `{"env": NAME}`, say; members in the order of their type."""
    if isinstance(data, Unresolved):
        return dict(data.data)
    match type_:
        case ListType(element=element) if isinstance(data, list):
            return [as_data(element, item) for item in data]
        case MapType(element=element) if isinstance(data, dict):
            return {key: as_data(element, value) for key, value in data.items()}
        case RecordType() if isinstance(data, dict):
            return {m.name: as_data(m.type, data[m.name]) for m in type_.members if m.name in data}
        case _:
            return data
