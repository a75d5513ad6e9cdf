"""Effective values completed with defaults at every level.

Parameters that no document sets have their defaults, which are computed once for a parameters document. Cerberus
completes records that are set and lack members. It is a hundred times slower than the compiled schema that detects such
records, so that of all records that lack the same members it completes only one.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import partial
from typing import Any

from robocomp_yaml.parameters.defaults import defaults
from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.json_schema import COMPLETE, fits, schema_of_complete
from robocomp_yaml.parameters.types import BasicType, ListType, MapType, RecordType, ResolvedMember, Type
from robocomp_yaml.parameters.validators import ValuesValidator

Data = dict[str, Any]
Completer = Callable[[Any], Any]


def complete_at_once(linked: ResolvedParameters, data: Data) -> Data | None:
    """The complete values, if only whole parameters with defaults are missing; else None, valid or not."""
    whole = _defaults(linked) | data
    return _in_order(linked.parameters.root, whole) if fits(linked, COMPLETE, whole) else None


def completed(linked: ResolvedParameters, data: Data) -> Data:
    """The complete values. `data` is valid, and has no null."""
    root = linked.parameters.root
    completers = linked.once("completers", lambda: {m.name: _completer(m.type) or _unchanged for m in root.members})
    own = {name: completers[name](value) for name, value in data.items()}
    return _in_order(root, _defaults(linked) | own)


def _defaults(linked: ResolvedParameters) -> Data:
    return linked.once("defaults", lambda: defaults(linked.parameters.root))


def _unchanged(value: Any) -> Any:
    return value


def _in_order(record: RecordType, data: Data) -> Data:
    return {member.name: data[member.name] for member in record.members if member.name in data}


def _completer(type_: Type) -> Completer | None:
    """The function that completes values of a type; None if they are always complete."""
    match type_:
        case ListType(element=element) | MapType(element=element):
            inner = _completer(element)
            return None if inner is None else partial(_entries, inner)
        case RecordType(members=members) if any(m.default is not None or _completer(m.type) for m in members):
            return _RecordCompleter(type_).complete
        case _:
            return None


def _entries(inner: Completer, value: Any) -> Any:
    if isinstance(value, dict):
        return {name: inner(entry) for name, entry in value.items()}
    return [inner(item) for item in value]


class _RecordCompleter:
    """Completes records of a type. `added` are the members that records with these keys lack."""

    def __init__(self, type_: RecordType) -> None:
        self.type = type_
        self.validator = ValuesValidator()
        self.added: dict[tuple[str, ...], Data] = {}
        self.normalize: Completer | None = None

    def is_complete(self, data: Data) -> bool:
        return self.validator.is_valid(data, lambda: schema_of_complete(self.type))

    def complete(self, data: Data) -> Data:
        keys = tuple(data)
        if keys in self.added and self.is_complete(whole := _in_order(self.type, data | self.added[keys])):
            return whole
        if self.is_complete(data):
            return data
        if self.normalize is None:
            from cerberus import Validator  # slow to import, and rarely needed

            self.normalize = Validator(_rules(self.type)).normalized
        whole = _in_order(self.type, self.normalize(data))
        self.added[keys] = {name: value for name, value in whole.items() if name not in data}
        return whole


def _rules(record: RecordType) -> Data:
    """Cerberus's rules for missing members. The present ones have been judged."""
    return {member.name: _type_rules(member.type) | _default(member) for member in record.members}


def _default(member: ResolvedMember) -> Data:
    data = {} if member.is_group else None if member.default is None else member.default.data
    return {} if data is None else {"default_setter": lambda document: copy.deepcopy(data)}


def _type_rules(type_: Type) -> Data:
    match type_:
        case ListType(element=element):
            return {"type": "list", "schema": _type_rules(element)}
        case MapType(element=element):
            return {"type": "dict", "valuesrules": _type_rules(element)}
        case RecordType():
            return {"type": "dict", "schema": _rules(type_)}
        case BasicType(is_integer=True):
            return {"coerce": lambda value: int(value) if isinstance(value, float) else value}  # 1.0 is a whole number
        case _:
            return {}
