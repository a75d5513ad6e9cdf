"""Cerberus's rules of a component's parameters, and what Cerberus lacks.

Cerberus takes True for a number, refuses 1.0 where a whole number is asked, lets NaN pass every range, knows no open
ends, and ends its patterns before a last line end: the rules below make its verdict the others'.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

from cerberus import TypeDefinition, Validator

from robocomp_yaml.parameters.spelling import lexemes
from robocomp_yaml.parameters.types import (
    LIMITS,
    BasicType,
    EnumType,
    ListType,
    MapType,
    Member,
    RecordType,
    ScalarType,
    Size,
    Type,
)

Rules = dict[str, Any]


class Reference:
    """`{env: NAME}` or `{file: PATH}`: a value that is known only when the component starts."""

    __slots__ = ("data",)

    def __init__(self, data: dict[str, str]) -> None:
        self.data = data

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Reference) and other.data == self.data

    def __hash__(self) -> int:
        return hash(tuple(self.data.items()))


class ParameterValidator(Validator):  # type: ignore[misc]  # cerberus has no types
    """Cerberus with our types and rules. A reference fits every plain type; its value is judged at start."""

    types_mapping = Validator.types_mapping.copy()
    types_mapping["truth"] = TypeDefinition("truth", (bool, Reference), ())
    types_mapping["whole"] = TypeDefinition("whole", (int, Reference), (bool,))
    types_mapping["decimal"] = TypeDefinition("decimal", (int, float, Reference), (bool,))
    types_mapping["text"] = TypeDefinition("text", (str, Reference), ())

    def _validate_from(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Reference) and not value >= limit:  # type: ignore[operator]  # so that NaN fails
            self._error(field, f"must be at least {limit}")

    def _validate_to(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Reference) and not value <= limit:  # type: ignore[operator]
            self._error(field, f"must be at most {limit}")

    def _validate_above(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Reference) and not value > limit:  # type: ignore[operator]
            self._error(field, f"must be above {limit}")

    def _validate_below(self, limit: float, field: str, value: object) -> None:
        """{'type': 'number'}"""
        if not isinstance(value, Reference) and not value < limit:  # type: ignore[operator]
            self._error(field, f"must be below {limit}")

    def _validate_one_of(self, allowed: list[object], field: str, value: object) -> None:
        """{'type': 'list'}"""
        if not isinstance(value, Reference) and value not in allowed:
            self._error(field, f"must be one of {allowed}")

    def _validate_pattern(self, expression: str, field: str, value: object) -> None:
        """{'type': 'string'}"""
        from robocomp_yaml.parameters.patterns.match import matcher

        if isinstance(value, str) and not matcher(expression).matches(value):
            self._error(field, f"must match {expression}")

    def _validate_distinct(self, wanted: bool, field: str, value: list[object]) -> None:
        """{'type': 'boolean'}"""
        if wanted and len(set(value)) != len(value):
            self._error(field, "must have no entry twice")


def rules_of(type_: RecordType, *, from_text: bool = False) -> Rules:
    """The rules of a record's members. `from_text`: plain values are legacy strings, to be coerced."""
    return {member.name: _member(member, from_text) for member in type_.members}


def _member(member: Member, from_text: bool) -> Rules:
    rules = _type(member.type, from_text)
    if member.is_group:
        rules["default_setter"] = _always({})
    elif member.default is not None:
        rules["default_setter"] = _always(_spelled(member.default.data) if from_text else member.default.data)
    elif not member.optional:
        rules["required"] = True
    return rules


def _spelled(data: object) -> object:
    """A default among legacy strings: it is coerced like its neighbours."""
    if isinstance(data, dict):
        return {key: _spelled(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_spelled(item) for item in data]
    return lexemes.spelled(data)


def _always(data: object) -> Callable[[object], object]:
    return lambda _document: copy.deepcopy(data)


def _type(type_: Type, from_text: bool) -> Rules:
    match type_:
        case BasicType() | EnumType():
            return _scalar(type_, from_text)
        case ListType(element=element, size=size, unique=unique):
            rules = {"type": "list", "schema": _type(element, from_text), **_size(size)}
            return {**rules, "distinct": True} if unique else rules
        case MapType(element=element, size=size):
            return {
                "type": "dict",
                "keysrules": {"type": "string"},
                "valuesrules": _type(element, from_text),
                **_size(size),
            }
        case _:
            return {"type": "dict", "schema": rules_of(type_, from_text=from_text)}


def _size(size: Size) -> Rules:
    rules: Rules = {"minlength": size.least} if size.least else {}
    return rules | ({"maxlength": size.most} if size.most is not None else {})


def _scalar(type_: ScalarType, from_text: bool) -> Rules:
    rules: Rules
    if isinstance(type_, EnumType):
        return {"type": "text", "one_of": list(type_.allowed)}
    if type_.name in LIMITS:
        rules = {"type": "whole" if type_.is_integer else "decimal", "coerce": _whole if type_.is_integer else _same}
        rules |= _range(type_)
    else:
        rules = {"type": "truth" if type_.name == "bool" else "text"}
    if type_.values:
        rules["one_of"] = [literal.value for literal in type_.values]
    if type_.pattern is not None:
        rules["pattern"] = type_.pattern.portable
    if from_text and type_.name != "string":
        rules["coerce"] = lambda value: value if isinstance(value, Reference) else lexemes.read(type_, value)
    elif rules.get("coerce") is _same:
        del rules["coerce"]
    return rules


def _range(type_: BasicType) -> Rules:
    least, most = LIMITS[type_.name]
    rules: Rules = {"from": least, "to": most}
    if type_.range and (low := type_.range.low):
        rules["above" if low.is_open else "from"] = low.value
    if type_.range and (high := type_.range.high):
        rules["below" if high.is_open else "to"] = high.value
    return rules


def _same(value: object) -> object:
    return value


def _whole(value: object) -> object:
    """1.0 is a whole number, and becomes 1."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def as_data(type_: Type, data: Any) -> Any:
    """What Cerberus made as plain data: references as `{"env": NAME}`, say; members in the order of their type."""
    if isinstance(data, Reference):
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
