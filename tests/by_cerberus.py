"""Cerberus as a judge: its verdict on whole effective values, and what it makes of them.

Cerberus takes True for a number, refuses 1.0 where a whole number is asked, lets NaN pass every range, knows no open
ends, and ends its patterns before a last line end: the rules below make its verdict the others'.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

from cerberus import TypeDefinition, Validator

from robocomp_yaml.parameters.patterns.pattern import Pattern
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ResolvedMember,
    ScalarType,
    Size,
    Type,
)
from robocomp_yaml.semantics.limits import LIMITS
from robocomp_yaml.semantics.references import Unresolved, is_sound

Rules = dict[str, Any]


def cerberus_verdict(root: RecordType, data: object) -> tuple[bool, Any]:
    """Cerberus's own verdict on whole effective values, and what it makes of them."""
    if not isinstance(data, dict):
        return False, None
    validator = _validator(root)
    verdict = validator.validate(with_references(root, copy.deepcopy(data)))
    return bool(verdict), as_data(root, validator.document)


_LAST: list[Any] = []  # the type that was judged last, and its validator: tests judge many values of one type


def _validator(root: RecordType) -> ParameterValidator:
    if not _LAST or _LAST[0] is not root:
        _LAST[:] = [root, ParameterValidator(rules_of(root))]
    return _LAST[1]


class ParameterValidator(Validator):  # type: ignore[misc]  # cerberus has no types
    """Cerberus with our types and rules. A reference fits every plain type; its value is judged at start."""

    types_mapping = Validator.types_mapping.copy()
    types_mapping["truth"] = TypeDefinition("truth", (bool, Unresolved), ())
    types_mapping["whole"] = TypeDefinition("whole", (int, Unresolved), (bool,))
    types_mapping["decimal"] = TypeDefinition("decimal", (int, float, Unresolved), (bool,))
    types_mapping["text"] = TypeDefinition("text", (str, Unresolved), ())

    def _validate_from(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Unresolved) and not value >= limit:  # type: ignore[operator]  # so that NaN fails
            self._error(field, f"must be at least {limit}")

    def _validate_to(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Unresolved) and not value <= limit:  # type: ignore[operator]
            self._error(field, f"must be at most {limit}")

    def _validate_above(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Unresolved) and not value > limit:  # type: ignore[operator]
            self._error(field, f"must be above {limit}")

    def _validate_below(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Unresolved) and not value < limit:  # type: ignore[operator]
            self._error(field, f"must be below {limit}")

    def _validate_one_of(self, allowed: list[object], field: str, value: object) -> None:
        """{'type': 'list'}"""
        if not isinstance(value, Unresolved) and value not in allowed:
            self._error(field, f"must be one of {allowed}")

    def _validate_pattern(self, wanted: Pattern, field: str, value: object) -> None:
        """{'nullable': False}"""
        if isinstance(value, str) and not wanted.matches(value):
            self._error(field, f"must match {wanted.text}")

    def _validate_distinct(self, wanted: bool, field: str, value: list[object]) -> None:
        """{'type': 'boolean'}"""
        if wanted and len(set(value)) != len(value):
            self._error(field, "must have no element twice")


def rules_of(type_: RecordType) -> Rules:
    """The rules of a record's members."""
    return {member.name: _member(member) for member in type_.members}


def _member(member: ResolvedMember) -> Rules:
    rules = _type(member.type)
    if member.is_group:
        rules["default_setter"] = _always({})
    elif member.default is not None:
        rules["default_setter"] = _always(member.default.data)
    elif not member.optional:
        rules["required"] = True
    return rules


def _always(data: object) -> Callable[[object], object]:
    return lambda _document: copy.deepcopy(data)


def _type(type_: Type) -> Rules:
    match type_:
        case BasicType() | EnumType():
            return _scalar(type_)
        case ListType(element=element, size=size, unique=unique):
            rules = {"type": "list", "schema": _type(element), **_size(size)}
            return {**rules, "distinct": True} if unique else rules
        case MapType(element=element, size=size):
            return {
                "type": "dict",
                "keysrules": {"type": "string"},
                "valuesrules": _type(element),
                **_size(size),
            }
        case _:
            return {"type": "dict", "schema": rules_of(type_)}


def _size(size: Size) -> Rules:
    rules: Rules = {"minlength": size.least} if size.least else {}
    return rules | ({"maxlength": size.most} if size.most is not None else {})


def _scalar(type_: ScalarType) -> Rules:
    rules: Rules
    if isinstance(type_, EnumType):
        return {"type": "text", "one_of": list(type_.allowed)}
    if type_.name in LIMITS:
        rules = {"type": "whole", "coerce": _whole} if type_.is_integer else {"type": "decimal"}
        rules |= _range(type_)
    else:
        rules = {"type": "truth" if type_.name == "bool" else "text"}
    if type_.values:
        rules["one_of"] = [literal.value for literal in type_.values]
    if type_.pattern is not None:
        rules["pattern"] = type_.pattern
    return rules


def _range(type_: BasicType) -> Rules:
    least, most = LIMITS[type_.name]
    rules: Rules = {"from": least, "to": most}
    if type_.range and (low := type_.range.low):
        rules["above" if low.is_open else "from"] = low.value
    if type_.range and (high := type_.range.high):
        rules["below" if high.is_open else "to"] = high.value
    return rules


def _whole(value: object) -> object:
    """1.0 is a whole number, and becomes 1."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


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
