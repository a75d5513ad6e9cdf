"""JSON Schemas (draft-07) of a component's values: for editors, for tools, and as the gate of `check`.

Three of them say the same about each value, and differ in what may be missing. A document may leave out anything, and
`null` returns to the default; of effective values nothing that is required may be missing; complete ones also have
every default, so that there is nothing left to normalize. Only the first is read by people, in their editors, and has
messages, examples and snippets for them; the second, for tools, says what each value is; the third is read by nobody.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import jsonschema_rs
import msgspec

from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.examples.example import example, example_of
from robocomp_yaml.parameters.hidden import holds_secret
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    ResolvedMember,
    ScalarType,
    Size,
    Type,
    json_type,
)
from robocomp_yaml.parameters.words import for_editors, in_words, label, prose
from robocomp_yaml.semantics.limits import LIMITS
from robocomp_yaml.source.schema import new_schema
from robocomp_yaml.source.yaml_text import flow

Schema = dict[str, Any]
DOCUMENT, EFFECTIVE, COMPLETE = "document", "effective", "complete"
_REFERENCE: Schema = {
    "title": "Reference",
    "description": "The value of an environment variable, or the text of a file, taken when the component starts.",
    "type": "object",
    "minProperties": 1,
    "maxProperties": 1,
    "errorMessage": "a value is referred to by {env: NAME} or by {file: PATH}",
    "properties": {
        "env": {
            "title": "Variable",
            "description": "The name of the environment variable.",
            "type": "string",
            "pattern": "^[A-Za-z_][A-Za-z0-9_]*$(?!\\n)",
            "errorMessage": "env: is the name of an environment variable: letters, digits and underscores",
        },
        "file": {
            "title": "File",
            "description": "The path of a file, from the folder of this document. One line end at the "
            "end of its text does not count.",
            "type": "string",
            "pattern": "^[^\\r\\n\\x00]*[^ \\t/\\r\\n\\x00]$(?!\\n)",
            "errorMessage": "file: is the path of a file",
        },
    },
    "additionalProperties": False,
}
_REFERENCE_CHOICE = {
    "type": "object",
    "defaultSnippets": [
        {
            "label": "from the environment",
            "description": "taken when the component starts",
            "body": {"env": "${1:NAME}"},
        },
        {
            "label": "from a file",
            "description": "read when the component starts",
            "body": {"file": "${1:secrets/name}"},
        },
    ],
}


def fits(linked: ResolvedParameters, mode: str, data: object) -> bool:
    """The verdict on what stands under `parameters:`, in one of the modes. What does not fit is judged again, for words
    and places."""
    gate = linked.once(mode, lambda: jsonschema_rs.Draft7Validator(values_schema(linked.parameters, mode)))
    return gate.is_valid(data)


def values_schema(parameters: Parameters, mode: str) -> Schema:
    """The schema of what stands under `parameters:`, by itself."""
    maker = _SchemaBuilder(mode)
    made = maker.record(parameters.root)
    return {"$schema": "http://json-schema.org/draft-07/schema#", **made, "definitions": maker.definitions}


def gate_of_complete(type_: Type) -> jsonschema_rs.Draft7Validator:
    """A gate for one value that lacks nothing."""
    maker = _SchemaBuilder(COMPLETE)
    made = maker.type(type_)
    return jsonschema_rs.Draft7Validator({**made, "definitions": maker.definitions})


def document_schema(parameters: Parameters, name: str, ports: Mapping[str, Iterable[str]], mode: str) -> Schema:
    """The self-contained schema of the whole values document of the component that is called so; `ports` has the names
    that may stand below `endpoints` and `proxies`."""
    maker = _SchemaBuilder(mode)
    made = new_schema("config")
    made["$id"] = f"https://rcyaml.invalid/schemas/values/{name}.{mode}.schema.json"
    made["title"] = f"Values of {name}"
    made["description"] = f"The values of {name}'s parameters, and where it and the others are."
    made["markdownDescription"] = made["description"] + (f"\n\n{prose(parameters.doc)}" if parameters.doc else "")
    made["examples"] = [{"parameters": {}}]
    head = {key: made["properties"]["parameters"][key] for key in ("title", "description", "markdownDescription")}
    made["properties"]["parameters"] = {**maker.record(parameters.root, nullable=mode == DOCUMENT), **head}
    made["definitions"].update(maker.definitions)
    if mode == EFFECTIVE:
        made["required"] = ["parameters"] if any(m.required for m in parameters.root.members) else []
    for key, names in ports.items():
        made["properties"][key]["properties"] = {name: {"$ref": f"#/definitions/{_PORTS[key]}"} for name in names}
    return made


_PORTS = {"endpoints": "endpoint", "proxies": "proxy"}


class _SchemaBuilder(msgspec.Struct):
    """Makes schemas in one mode; structs go to `definitions`."""

    mode: str
    definitions: dict[str, Schema] = msgspec.field(default_factory=lambda: {"reference": _REFERENCE})

    @property
    def for_editors(self) -> bool:
        return self.mode == DOCUMENT

    def type(self, type_: Type, *, nullable: bool = False) -> Schema:
        match type_:
            case BasicType() | EnumType():
                return self.scalar(type_, nullable)
            case ListType(element=element, size=size, unique=unique):
                then: Schema = {"items": self.type(element), **self.size(size, "Items")}
                if unique:
                    then["uniqueItems"] = True
                return self.shape("array", then, nullable, type_)
            case MapType(element=element, size=size):
                nullable_entries = self.mode == DOCUMENT
                then = {"additionalProperties": self.type(element, nullable=nullable_entries)}
                if not nullable_entries:  # layers are merged before entries are counted
                    then |= self.size(size, "Properties")
                return self.shape("object", then, nullable, type_)
            case RecordType(name=""):
                return self.record(type_, nullable=nullable)
            case _:
                name = f"Type.{type_.name}"
                if name not in self.definitions:
                    self.definitions[name] = {}  # for a second mention while it is made
                    self.definitions[name] = self.members(type_)
                return self.shape("object", {"$ref": f"#/definitions/{name}"}, nullable, type_)

    def size(self, size: Size, of: str) -> Schema:
        made: Schema = {f"min{of}": size.least} if size.least else {}
        made |= {f"max{of}": size.most} if size.most is not None else {}
        if not made or not self.for_editors:
            return made
        said = {"type": "string", "errorMessage": f"there must be {size.in_words} entries"}
        return {"allOf": [{"if": made, "then": {}, "else": said}]}

    def shape(self, kind: str, then: Schema, nullable: bool, type_: Type) -> Schema:
        """A list or mapping: what holds for it, and one message for everything else."""
        made: Schema = {"if": {"type": kind}, "then": then, "else": {"type": _types(kind, nullable)}}
        if self.for_editors:
            words = in_words(type_)
            made["else"]["errorMessage"] = f"this is {words}"
            if not (isinstance(type_, RecordType) and type_.is_group):
                snippet = {"label": label(type_), "description": words, "body": flow(example_of(type_))}
                made["anyOf"] = [{"type": "string", "defaultSnippets": [snippet]}, {}]
        return made

    def scalar(self, type_: ScalarType, nullable: bool) -> Schema:
        limits = self.limits(type_)
        said = {"errorMessage": f"this is {in_words(type_)}"} if self.for_editors else {}
        kind = json_type(type_)
        otherwise: Schema
        if "enum" in limits:
            otherwise = {"enum": [*limits["enum"], *([None] if nullable else [])], **said}
        elif isinstance(type_, BasicType) and type_.is_number and self.for_editors:
            # An editor has words of its own for a range, and only for a type takes ours.
            outside = {"if": limits, "then": {}, "else": {"type": "string", **said}}
            otherwise = {"if": {"type": kind}, "then": outside, "else": {"type": _types(kind, nullable), **said}}
        else:
            otherwise = {"type": _types(kind, nullable), **limits, **said}
        made: Schema = {"if": {"type": "object"}, "then": {"$ref": "#/definitions/reference"}, "else": otherwise}
        if self.for_editors:
            made["anyOf"] = [{"enum": limits["enum"]} if "enum" in limits else {"type": kind}, _REFERENCE_CHOICE, {}]
        return made

    def limits(self, type_: ScalarType) -> Schema:
        if isinstance(type_, EnumType):
            return {"enum": list(type_.allowed)}
        if type_.values:
            return {"enum": [literal.value for literal in type_.values]}
        if type_.pattern is not None:
            return {"pattern": type_.pattern.anchored}
        if type_.name not in LIMITS:
            return {}
        least, most = LIMITS[type_.name]
        made: Schema = {"minimum": least, "maximum": most}
        if type_.range and (low := type_.range.low):
            del made["minimum"]
            made["exclusiveMinimum" if low.is_open else "minimum"] = low.value
        if type_.range and (high := type_.range.high):
            del made["maximum"]
            made["exclusiveMaximum" if high.is_open else "maximum"] = high.value
        return made

    def record(self, type_: RecordType, *, nullable: bool = False) -> Schema:
        return self.shape("object", self.members(type_), nullable, type_)

    def members(self, type_: RecordType) -> Schema:
        """What holds for a record that is a mapping."""
        made: Schema = {"properties": {member.name: self.member(member) for member in type_.members}}
        if self.mode == DOCUMENT:
            made["patternProperties"] = {"^x-": {}}
        made["additionalProperties"] = False
        needed = [member.name for member in type_.members if member.required] if self.mode == EFFECTIVE else []
        if self.mode == COMPLETE:
            needed = [member.name for member in type_.members if not member.optional]
        if needed:
            made["required"] = needed
        if type_.name and self.mode != COMPLETE:
            made["title"] = type_.name
        if type_.doc and self.mode != COMPLETE:
            made["description"] = type_.doc
            made |= {"markdownDescription": prose(type_.doc)} if self.for_editors else {}
        return made

    def member(self, member: ResolvedMember) -> Schema:
        made = self.type(member.type, nullable=self.mode == DOCUMENT)
        if self.mode != COMPLETE:
            made |= self.about(member)
        return made

    def about(self, member: ResolvedMember) -> Schema:
        """Title, description, default; an editor also shows Markdown and examples."""
        unit, doc, facts = member.unit, member.documentation, for_editors(member)
        made: Schema = {"title": f"{member.name} ({unit})" if unit else member.name}
        made["description"] = "\n".join(part for part in (doc, facts) if part)
        shown = example(member) if self.for_editors else None
        can_be_shown = _is_simple(shown) and not holds_secret(member.type)
        if member.default is not None and can_be_shown:
            made["default"] = member.default.data
        if self.for_editors:
            made["markdownDescription"] = "\n\n".join(part for part in (prose(doc), prose(facts)) if part)
            made |= {"examples": [shown]} if can_be_shown else {}
        return made


def _types(name: str, nullable: bool) -> str | list[str]:
    return [name, "null"] if nullable else name


def _is_simple(data: object) -> bool:
    """Whether no list holds lists or mappings: of those, editors insert `[object Object]`."""
    if isinstance(data, dict):
        return all(map(_is_simple, data.values()))
    return not (isinstance(data, list) and any(isinstance(item, dict | list) for item in data))
