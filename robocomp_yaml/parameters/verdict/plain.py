"""What is wrong with a plain value, whoever asks: the judge of values, of limits, or of examples."""

from __future__ import annotations

from math import isfinite

from robocomp_yaml.parameters.types import EnumType, ScalarType
from robocomp_yaml.semantics.limits import beyond

KIND, CHOICE, PATTERN, RANGE, LIMIT = "kind", "choice", "pattern", "range", "limit"


def wrong(type_: ScalarType, data: object) -> str:
    """KIND for data of another kind, CHOICE for none of the values allowed, PATTERN for a text that does not match,
    RANGE for a number out of its range, LIMIT for one that its type cannot hold; '' where all is well."""
    if isinstance(type_, EnumType):
        return "" if data in type_.allowed and isinstance(data, str) else CHOICE if isinstance(data, str) else KIND
    if type_.name == "bool":
        return "" if isinstance(data, bool) else KIND
    if type_.name == "string":
        if not isinstance(data, str):
            return KIND
    elif isinstance(data, bool) or not isinstance(data, int | float):
        return KIND
    elif isinstance(data, float) and (not isfinite(data) or (type_.is_integer and data != int(data))):
        return KIND
    if type_.values:
        return "" if any(data == allowed.value for allowed in type_.values) else CHOICE
    if isinstance(data, str):
        return "" if type_.pattern is None or type_.pattern.matches(data) else PATTERN
    if type_.range and not type_.range.holds(data):
        return RANGE
    return LIMIT if beyond(type_.name, data) else ""
