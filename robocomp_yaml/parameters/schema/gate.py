"""The fast gate: whether values fit their JSON Schema. What does not is judged again, for words and places."""

from __future__ import annotations

import jsonschema_rs

from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.schema.json_schema import complete_schema, values_schema
from robocomp_yaml.parameters.types import Type


def fits(linked: ResolvedParameters, mode: str, data: object) -> bool:
    """The verdict on what stands under `parameters:`, in one of the schema's modes."""
    return linked.once(mode, lambda: jsonschema_rs.Draft7Validator(values_schema(linked.parameters, mode))).is_valid(
        data
    )


def of_complete(type_: Type) -> jsonschema_rs.Draft7Validator:
    """A gate for one value that lacks nothing."""
    return jsonschema_rs.Draft7Validator(complete_schema(type_))
