"""Cerberus as a judge: its verdict on whole effective values, and what it makes of them."""

from __future__ import annotations

import copy
from typing import Any

from cerberus_rules import ParameterValidator, rules_of
from robocomp_yaml.parameters.kinds import as_data
from robocomp_yaml.parameters.types import BasicType, EnumType, ListType, MapType, RecordType, Type
from robocomp_yaml.semantics.references import Unresolved, is_sound


def cerberus_verdict(root: RecordType, data: object) -> tuple[bool, Any]:
    """Cerberus's own verdict on whole effective values, and what it makes of them."""
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
