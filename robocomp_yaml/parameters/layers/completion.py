"""Effective values made complete: defaults filled in at every level.

What nobody gives comes from defaults alone, which are the same for all documents of values. What is given is completed
by Cerberus where it lacks something. Cerberus is a hundred times slower than the compiled schema that tells; so of many
records that lack the same it sees one.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

from jsonschema_rs import Draft7Validator

from robocomp_yaml.parameters.defaults import defaults
from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.schema.gate import of_complete
from robocomp_yaml.parameters.types import BasicType, ListType, MapType, Member, RecordType, Type

Data = dict[str, Any]


def completed(linked: ResolvedParameters, data: Data) -> Data:
    """Values that the gate let pass (without null), with their defaults."""
    return linked.once("completion", lambda: _Completion(linked.parameters.root)).of(data)


class _Completion:
    """Completes the values of one document of parameters. What belongs to a part of a value goes by its path."""

    def __init__(self, root: RecordType) -> None:
        self.root = root
        self.defaults = defaults(root)
        self.gates: dict[str, Draft7Validator] = {}
        self.normalizers: dict[str, Callable[[Data], Data]] = {}
        self.added: dict[tuple[str, ...], Data] = {}  # what records with these keys, behind their path, lacked

    def of(self, data: Data) -> Data:
        given = {m.name: self.value(m.name, m.type, data[m.name]) for m in self.root.members if m.name in data}
        return _in_order(self.root, self.defaults | given)

    def value(self, path: str, type_: Type, data: Any) -> Any:
        if path not in self.gates:
            self.gates[path] = of_complete(type_)
        is_complete = self.gates[path].is_valid
        if isinstance(type_, RecordType):
            added = self.added.get((path, *data))
            if added is not None and is_complete(filled := _in_order(type_, data | added)):
                return filled
        if is_complete(data):
            return data
        match type_:
            case ListType(element=element):
                return [self.value(f"{path}[]", element, item) for item in data]
            case MapType(element=element):
                return {name: self.value(f"{path}[]", element, item) for name, item in data.items()}
        assert isinstance(type_, RecordType)
        filled = _in_order(type_, self.normalizer(path, type_)(data))
        self.added[path, *data] = {name: value for name, value in filled.items() if name not in data}
        return filled

    def normalizer(self, path: str, type_: RecordType) -> Callable[[Data], Data]:
        if path not in self.normalizers:
            from cerberus import Validator  # slow to import, and seldom wanted

            self.normalizers[path] = Validator(_rules(type_)).normalized
        return self.normalizers[path]


def _in_order(record: RecordType, data: Data) -> Data:
    return {member.name: data[member.name] for member in record.members if member.name in data}


def _rules(record: RecordType) -> Data:
    """Cerberus's rules for what a record lacks; whether the rest is right has been judged."""
    return {member.name: _rules_of(member.type) | _default(member) for member in record.members}


def _default(member: Member) -> Data:
    data = {} if member.is_group else None if member.default is None else member.default.data
    return {} if data is None else {"default_setter": lambda document: copy.deepcopy(data)}


def _rules_of(type_: Type) -> Data:
    match type_:
        case ListType(element=element):
            return {"type": "list", "schema": _rules_of(element)}
        case MapType(element=element):
            return {"type": "dict", "valuesrules": _rules_of(element)}
        case RecordType():
            return {"type": "dict", "schema": _rules(type_)}
        case BasicType(is_integer=True):
            return {"coerce": lambda value: int(value) if isinstance(value, float) else value}  # 1.0 is a whole number
        case _:
            return {}
