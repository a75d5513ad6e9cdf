"""JSON Schemas (draft-07) of a component's values: for editors, for tools, and as the validator of `check`.

The three modes accept the same values, and differ in what may be missing. In a DOCUMENT everything may be missing, and
`null` resets a value to its default. EFFECTIVE values have everything that is required. COMPLETE values also have all
defaults, so that nothing is left to complete. The validator has no words. The schemas that are written have titles and
descriptions; that of a document also has messages, examples and snippets, because people see it in editors.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

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
from robocomp_yaml.parameters.validators import ValuesValidator
from robocomp_yaml.parameters.words import elements_in_words, for_editors, in_words, label, prose
from robocomp_yaml.semantics.limits import LIMITS
from robocomp_yaml.source.schema_names import with_examples
from robocomp_yaml.source.yaml_text import flow

Schema = dict[str, Any]
DOCUMENT, EFFECTIVE, COMPLETE = "document", "effective", "complete"
_REFERENCE: Schema = {
    "title": "Reference",
    "description": "The value of an environment variable, or the text of a file. It is read when the component starts.",
    "type": "object",
    "minProperties": 1,
    "maxProperties": 1,
    "errorMessage": "a reference must be {env: NAME} or {file: PATH}",
    "properties": {
        "env": {
            "title": "Variable",
            "description": "The name of the environment variable.",
            "type": "string",
            "pattern": "^[A-Za-z_][A-Za-z0-9_]*$(?!\\n)",
            "errorMessage": "env: must be the name of an environment variable: letters, digits and underscores",
        },
        "file": {
            "title": "File",
            "description": "The path of a file, relative to the folder of this document. The last line "
            "end of the file is not part of the value.",
            "type": "string",
            "pattern": "^[^\\r\\n\\x00]*[^ \\t/\\r\\n\\x00]$(?!\\n)",
            "errorMessage": "file: must be the path of a file",
        },
    },
    "additionalProperties": False,
}
_TEXTS = ("title", "description", "errorMessage")
_REFERENCE_OF_GATES: Schema = {
    **{key: value for key, value in _REFERENCE.items() if key not in _TEXTS},
    "properties": {
        name: {key: value for key, value in made.items() if key not in _TEXTS}
        for name, made in _REFERENCE["properties"].items()
    },
}
_REFERENCE_CHOICE = {
    "type": "object",
    "defaultSnippets": [
        {
            "label": "from the environment",
            "description": "read when the component starts",
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
    """The verdict of the validator on the data under `parameters:`, in one of the modes."""
    validator = linked.once(mode, ValuesValidator)
    return validator.is_valid(data, lambda: values_schema(linked.parameters, mode))


def values_schema(parameters: Parameters, mode: str) -> Schema:
    """The schema of the data under `parameters:` alone, without texts: the schema of the gate."""
    builder = _SchemaBuilder(mode, is_gate=True)
    made = builder.record(parameters.root)
    return {"$schema": "http://json-schema.org/draft-07/schema#", **made, "definitions": builder.definitions}


def schema_of_complete(type_: Type) -> Schema:
    """The schema of the gate for one complete value of a type."""
    builder = _SchemaBuilder(COMPLETE, is_gate=True)
    made = builder.type(type_)
    return {**made, "definitions": builder.definitions}


def document_schema(parameters: Parameters, name: str, ports: Mapping[str, Iterable[str]], mode: str) -> Schema:
    """The self-contained schema of a values document of the component `name`. `ports` has the names that are known
    under `endpoints` and `proxies`."""
    builder = _SchemaBuilder(mode)
    made = with_examples("config")
    made["$id"] = f"https://rcyaml.invalid/schemas/values/{name}.{mode}.schema.json"
    made["title"] = f"Values of {name}"
    made["description"] = f"The values of {name}'s parameters, its endpoints and its proxies."
    made["markdownDescription"] = made["description"] + (f"\n\n{prose(parameters.doc)}" if parameters.doc else "")
    made["examples"] = [{"parameters": {}}]
    head = {key: made["properties"]["parameters"][key] for key in ("title", "description", "markdownDescription")}
    made["properties"]["parameters"] = {**builder.record(parameters.root, nullable=mode == DOCUMENT), **head}
    made["definitions"].update(builder.definitions)
    if mode == EFFECTIVE:
        made["required"] = ["parameters"] if any(m.required for m in parameters.root.members) else []
    for key, names in ports.items():
        made["properties"][key]["properties"] = {name: {"$ref": f"#/definitions/{_PORTS[key]}"} for name in names}
    return made


_PORTS = {"endpoints": "endpoint", "proxies": "proxy"}


class _SchemaBuilder(msgspec.Struct):
    """Builds schemas in one mode. Structs are in `definitions`. A gate has no texts."""

    mode: str
    is_gate: bool = False
    definitions: dict[str, Schema] = {}
    snippets: dict[tuple[str, str], Schema] = {}

    def __post_init__(self) -> None:
        self.definitions["reference"] = _REFERENCE_OF_GATES if self.is_gate else _REFERENCE

    @property
    def for_editors(self) -> bool:
        return self.mode == DOCUMENT and not self.is_gate

    @property
    def has_texts(self) -> bool:
        return not self.is_gate

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
                nullable_elements = self.mode == DOCUMENT
                then = {"additionalProperties": self.type(element, nullable=nullable_elements)}
                if not nullable_elements:  # elements are counted after layers are merged
                    then |= self.size(size, "Properties")
                return self.shape("object", then, nullable, type_)
            case RecordType(name=""):
                return self.record(type_, nullable=nullable)
            case _:
                name = f"Type.{type_.name}"
                if name not in self.definitions:
                    self.definitions[name] = {}  # for a second use while it is built
                    self.definitions[name] = self.members(type_)
                return self.shape("object", {"$ref": f"#/definitions/{name}"}, nullable, type_)

    def size(self, size: Size, of: str) -> Schema:
        made: Schema = {f"min{of}": size.least} if size.least else {}
        made |= {f"max{of}": size.most} if size.most is not None else {}
        if not made or not self.for_editors:
            return made
        otherwise = {"type": "string", "errorMessage": f"there must be {elements_in_words(size)}"}
        return {"allOf": [{"if": made, "then": {}, "else": otherwise}]}

    def shape(self, kind: str, then: Schema, nullable: bool, type_: Type) -> Schema:
        """The schema of a list or mapping, with one message for all other values."""
        made: Schema = {"if": {"type": kind}, "then": then, "else": {"type": _types(kind, nullable)}}
        if self.for_editors:
            words = in_words(type_)
            made["else"]["errorMessage"] = f"this must be {words}"
            if not (isinstance(type_, RecordType) and type_.is_group):
                made["anyOf"] = [{"type": "string", "defaultSnippets": [self.snippet(type_, words)]}, {}]
        return made

    def snippet(self, type_: Type, words: str) -> Schema:
        """What an editor inserts for a type; types that read the same have the same example."""
        name = label(type_)
        if (name, words) not in self.snippets:
            made = {"label": name, "description": words, "body": flow(example_of(type_))}
            self.snippets[name, words] = made
        return self.snippets[name, words]

    def scalar(self, type_: ScalarType, nullable: bool) -> Schema:
        limits = self.limits(type_)
        message = {"errorMessage": f"this must be {in_words(type_)}"} if self.for_editors else {}
        kind = json_type(type_)
        otherwise: Schema
        if "enum" in limits:
            otherwise = {"enum": [*limits["enum"], *([None] if nullable else [])], **message}
        elif isinstance(type_, BasicType) and type_.is_number and self.for_editors:
            # Editors have their own message for a range, and use `errorMessage` only for a type.
            outside = {"if": limits, "then": {}, "else": {"type": "string", **message}}
            otherwise = {"if": {"type": kind}, "then": outside, "else": {"type": _types(kind, nullable), **message}}
        else:
            otherwise = {"type": _types(kind, nullable), **limits, **message}
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
        """The schema of a record that is a mapping."""
        made: Schema = {"properties": {member.name: self.member(member) for member in type_.members}}
        if self.mode == DOCUMENT:
            made["patternProperties"] = {"^x-": {}}
        made["additionalProperties"] = False
        needed = [member.name for member in type_.members if member.required] if self.mode == EFFECTIVE else []
        if self.mode == COMPLETE:
            needed = [member.name for member in type_.members if not member.optional]
        if needed:
            made["required"] = needed
        if type_.name and self.has_texts:
            made["title"] = type_.name
        if type_.doc and self.has_texts:
            made["description"] = type_.doc
            made |= {"markdownDescription": prose(type_.doc)} if self.for_editors else {}
        return made

    def member(self, member: ResolvedMember) -> Schema:
        made = self.type(member.type, nullable=self.mode == DOCUMENT)
        if self.has_texts:
            made |= self.about(member)
        return made

    def about(self, member: ResolvedMember) -> Schema:
        """Title, description and default; for editors also Markdown and examples."""
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
    """Whether no list contains lists or mappings, for which editors insert `[object Object]`."""
    if isinstance(data, dict):
        return all(map(_is_simple, data.values()))
    return not (isinstance(data, list) and any(isinstance(item, (dict, list)) for item in data))
