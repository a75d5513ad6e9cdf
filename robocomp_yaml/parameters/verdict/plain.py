"""Whether a plain value fits its type: for values, limits and examples.

Components decide with the same code, `semantics.limits`.
"""

from __future__ import annotations

from robocomp_yaml.parameters.types import EnumType, ScalarType
from robocomp_yaml.semantics.limits import is_of, outside

KIND = "kind"


def wrong(type_: ScalarType, data: object) -> str:
    """KIND if the data has another kind, else the result of `outside`: '' if the value fits."""
    if isinstance(type_, EnumType):
        return outside(type_.name, data, type_.allowed) if is_of("string", data) else KIND
    if not is_of(type_.name, data):
        return KIND
    values = [allowed.value for allowed in type_.values]
    matches = type_.pattern.matches if type_.pattern is not None else None
    return outside(type_.name, data, values, type_.range.limits if type_.range is not None else {}, matches)
