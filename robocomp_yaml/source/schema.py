"""Validates documents against the schema of their kind, and translates the validator's errors to diagnostics.

Each error of jsonschema-rs contains its paths in the document and in the schema. The `errorMessage` of a subschema,
which yaml-language-server shows, too, has precedence over a generated message.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator
from collections.abc import Sequence as Path
from functools import cache
from typing import Any

import jsonschema_rs
import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import NO_HINT, Fix, Hint, removal
from robocomp_yaml.diag.span import Span
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import missing_blank
from robocomp_yaml.source.schema_text import schema_text
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, not_plain

_IN_WORDS = {
    "string": "text",
    "integer": "a whole number",
    "number": "a number",
    "boolean": "true or false",
    "array": "a list",
    "object": "a mapping",
    "null": "nothing",
}
NAME = "^[A-Za-z_][A-Za-z0-9_]*$"
_NO_NUL = "^[^\\u0000]*$"
_LINE = "^[^\\u0000-\\u001f\\u007f-\\u009f\\u2028\\u2029]*$"
_LINE_OF_ICE = "^[^\\u0000-\\u0008\\u000a-\\u001f\\u007f-\\u009f\\u2028\\u2029]*$"
_NEVER = {whole: pattern(whole[1:-2].replace("[^", "[")) for whole in (_NO_NUL, _LINE, _LINE_OF_ICE)}
"""The schemas' patterns that exclude characters, each with a pattern that matches these characters."""

_CALLED = {
    "\0": "a NUL", "\n": "a line break", "\r": "a carriage return", "\t": "a tab", "\x1b": "an escape character",
    "\u0085": "a line break", "\u2028": "a line break", "\u2029": "a line break",
}  # fmt: skip
_ENDS_A_LINE = "\n\v\f\r\x85\u2028\u2029"
_AT_END = "; `|-` and `>-` drop the last line break"
_APPLICATORS = frozenset(("allOf", "anyOf", "oneOf", "then", "else", "if"))


@cache
def schema(kind: str, more: tuple[TargetLanguage, ...] = ()) -> dict[str, Any]:
    """The JSON Schema of a kind of document, shared by all callers."""
    loaded: dict[str, Any] = msgspec.json.decode(schema_text(kind, more))
    return loaded


@cache
def _validator(kind: str, more: tuple[TargetLanguage, ...]) -> jsonschema_rs.Draft7Validator:
    return jsonschema_rs.Draft7Validator(schema_text(kind, more))  # `schema` is needed for errors alone


def validate(kind: str, root: Node, more: tuple[TargetLanguage, ...] = ()) -> list[Diagnostic]:
    """All errors of shape in a document, one diagnostic for each cause. `more` are the languages of plug-ins."""
    if not isinstance(root, Mapping):
        return [_without_blank(root) or codes.NOT_A_MAPPING.at(root.span, what=_what(root))]
    validator = _validator(kind, more)
    if validator.is_valid(root.data):
        return []
    explained: dict[tuple[object, ...], list[Diagnostic]] = {}
    for error in validator.iter_errors(root.data):
        instance_path = tuple(error.instance_path)
        of_error = list(_explain(schema(kind, more), root, instance_path, list(error.schema_path), error.kind))
        at_path = explained.setdefault(instance_path, [])
        # Errors of type or value at one path have one cause; every missing or unknown key is a cause of its own.
        at_path += [d for d in of_error if d.code in _KEY_CODES or all(o.code in _KEY_CODES for o in at_path)]
    return [d for at_path in explained.values() for d in _without_misspelled(at_path)]


_KEY_CODES = (codes.UNKNOWN_KEY.id, codes.MISSING_KEY.id, codes.WRONG_NAME.id)


def _without_misspelled(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """Without missing keys that are present, but misspelled: these have one cause, not two."""
    meant = {d.fact("meant") for d in diagnostics if d.code == codes.UNKNOWN_KEY.id}
    return list(dict.fromkeys(d for d in diagnostics if d.code != codes.MISSING_KEY.id or d.fact("key") not in meant))


def _explain(
    whole: dict[str, Any], root: Node, instance_path: Path[str | int], schema_path: list[str | int], kind: Any
) -> Iterator[Diagnostic]:
    node, key = _find(root, instance_path)
    facts = kind.as_dict()
    match kind.name:
        case "additionalProperties":
            for unknown in facts["unexpected"]:
                around, name = _behind_empty(node, unknown)
                if name is not None and isinstance(around, Mapping):
                    yield _unknown_key(whole, around, instance_path, schema_path, name)
        case "propertyNames":
            name = facts["error"].instance
            around, _ = _behind_empty(node, name)
            entry = around.entries.get(name) if isinstance(around, Mapping) else None
            is_name = "A-Za-z_" in str(_subschema(whole, schema_path))
            hint = _name_hint(name) if is_name else _own_message(whole, schema_path)
            yield codes.WRONG_NAME.at((entry[0] if entry else node).span, name=name, hint=hint)
        case "required":
            yield codes.MISSING_KEY.at(_head(node, key), key=facts["property"], where=_where(instance_path))
        case _:
            # A forbidden key is reported at its own location, with the message of the mapping that contains it.
            forbidden = kind.name == "falseSchema"
            message = _own_message(whole, schema_path[:-1] if forbidden else schema_path)
            if kind.name == "pattern" and facts["pattern"] == NAME and isinstance(node, Scalar):
                yield codes.WRONG_NAME.at(node.span, name=node.lexeme, hint=_name_hint(node.lexeme))
                return
            if kind.name == "pattern" and facts["pattern"] in _NEVER and isinstance(node, Scalar):
                yield _impossible(facts["pattern"], node, instance_path, span=_span(node, key))
                return
            if kind.name == "type" and "object" in facts["types"] and (fault := _without_blank(node)) is not None:
                yield fault
                return
            problem = message or _in_words(kind.name, facts, node, instance_path)
            span = key.span if forbidden and key else _span(node, key)
            yield codes.WRONG_SHAPE.at(
                span,
                problem=problem,
                key=_key_of(instance_path) or "the document",
                rule=kind.name,
                hint=_nearest(facts.get("options"), node),
                fixes=_fixes(kind.name, facts, node, _subschema(whole, schema_path[:-1])),
            )


def _without_blank(node: Node) -> Diagnostic | None:
    """The diagnostic of a text such as `speed:2` where a mapping must be; None if the node is something else."""
    if not isinstance(node, Scalar) or node.quoted or not isinstance(node.data, str):
        return None
    start, word = node.span, node.lexeme.split(" ")[0] if node.span.line != node.span.end_line else node.lexeme
    return missing_blank.in_line(node.file, " " * (start.column - 1) + word, start.line)


def _fixes(keyword: str, facts: dict[str, Any], node: Node, around: Any) -> Iterable[Fix]:
    """Fixes for superfluous or missing quotes, a single value for a list, and the second of two equal elements."""
    if keyword == "type" and isinstance(node, Scalar):
        if isinstance(around, dict) and "pattern" in around and not re.search(around["pattern"], node.lexeme):
            return ()  # in quotes the text would be invalid, too
        from robocomp_yaml.source.retyped import retyped

        return retyped([type_ for type_ in facts["types"] if type_ != "null"], node.lexeme, node.data, node.span)
    if keyword == "uniqueItems" and isinstance(node, Sequence):
        data = [item.data for item in node.items]
        return [removal(item.span) for at, item in enumerate(node.items) if item.data in data[:at]][:1]
    return ()


def _impossible(rule: str, node: Scalar, instance_path: Path[str | int], *, span: Span) -> Diagnostic:
    """The diagnostic of a text with a character that is not allowed in it."""
    match = _NEVER[rule].search(node.lexeme)
    assert match is not None
    is_at_end = match[0] == "\n" and match.end() == len(node.lexeme)
    hint = "write one line of text" + (_AT_END if is_at_end else "") if match[0] in _ENDS_A_LINE else "remove it"
    return codes.IMPOSSIBLE.at(
        span,
        key=_key_of(instance_path) or "the document",
        what=_CALLED.get(match[0], "a control character"),
        character=f"U+{ord(match[0]):04X}",
        hint=hint,
    )


def _unknown_key(
    whole: dict[str, Any], node: Mapping, instance_path: Path[str | int], schema_path: list[str | int], unknown: str
) -> Diagnostic:
    from robocomp_yaml.diag.suggest import hint_for_key, meaning
    from robocomp_yaml.source.holders import holder_of

    key = node.entries[unknown][0]
    around = _subschema(whole, schema_path[:-1])
    if not isinstance(around, dict):
        around = {}
    named = [p for p in around.get("patternProperties", {}) if not p.startswith("^x-")]
    if named and not around.get("properties"):
        return codes.WRONG_NAME.at(key.span, name=unknown, hint=_name_hint(unknown))
    known = around.get("properties", {})
    meant = _foreign(unknown, known)
    if meant and meant not in node.entries:
        hint = meaning(unknown, meant)
    elif unknown in _LIMITS and "range" in known:
        hint = Hint("write `range: [LOWEST, HIGHEST]`")
    else:
        hint = hint_for_key(unknown, known, node.entries)
        if not hint.meant and (holder := holder_of(whole, around, node.entries[unknown][1].data)):
            hint = Hint(f"write it below `{holder}:`")
    return codes.UNKNOWN_KEY.at(key.span, key=unknown, where=_where(instance_path), hint=hint)


def _find(root: Node, instance_path: Path[str | int]) -> tuple[Node, Scalar | None]:
    """The node at a path, and its key if it is the value of a mapping; the nearest node if the path does not exist."""
    node, key = root, None
    for step in instance_path:
        if isinstance(node, Sequence) and isinstance(step, int) and step < len(node.items):
            key, node = None, node.items[step]
            continue
        node, name = _behind_empty(node, step)
        if name is None:
            break
        assert isinstance(node, Mapping)
        key, node = node.entries[name]
    return node, key


def _behind_empty(node: Node, step: str | int) -> tuple[Node, str | None]:
    """The mapping that has the key `step`, and the key as written. The validator's paths omit empty keys, and contain
    keys of digits as numbers (`+1` and `01` alike)."""
    while isinstance(node, Mapping):
        if str(step) in node.entries:
            return node, str(step)
        if isinstance(step, int):
            for key in node.entries:
                if key.lstrip("+").isdecimal() and int(key) == step:
                    return node, key
        if "" not in node.entries:
            break
        node = node.entries[""][1]
    return node, None


def _subschema(whole: dict[str, Any], schema_path: list[str | int]) -> Any:
    part: Any = whole
    for step in schema_path:
        part = part[step] if isinstance(part, dict) else part[int(step)]
    return part


def _own_message(whole: dict[str, Any], schema_path: list[str | int]) -> str:
    """The nearest `errorMessage` around the keyword that failed, for the same path of the document; '' if absent."""
    for end in range(len(schema_path) - 1, -1, -1):
        part = _subschema(whole, schema_path[:end])
        if isinstance(part, dict) and "errorMessage" in part:
            return str(part["errorMessage"])
        step = schema_path[end - 1] if end else ""
        if not (isinstance(step, int) or str(step).isdigit() or step in _APPLICATORS):
            return ""
    return ""


def _key_of(instance_path: Path[str | int]) -> str:
    """The last key in a path; '' if it has none."""
    return next((step for step in reversed(instance_path) if isinstance(step, str)), "")


def _head(node: Node, key: Scalar | None) -> Span:
    """The location of a mapping with a missing key: the mapping's key, its first key, or the mapping."""
    if key is not None:
        return key.span
    if isinstance(node, Mapping) and node.entries:
        return next(iter(node.entries.values()))[0].span
    return node.span


def _span(node: Node, key: Scalar | None) -> Span:
    """A value's location; that of its key if the value is empty or has several lines."""
    span = node.span
    empty = isinstance(node, Scalar) and not node.lexeme and not node.quoted
    return key.span if key is not None and (empty or span.line != span.end_line) else span


def _where(instance_path: Path[str | int]) -> str:
    key = _key_of(instance_path)
    return f"in '{key}'" if key else "at the top level of the document"


def _what(node: Node) -> str:
    if not isinstance(node, Scalar) or node.data is None:
        return not_plain(node)
    kind = {bool: "a boolean", int: "a number", float: "a number"}.get(type(node.data), "text")
    shown = node.lexeme if len(node.lexeme) <= 30 else node.lexeme[:27] + "…"
    return f"{kind}, '{shown}'" if kind == "text" else f"{kind}, {shown}"


def _nearest(options: object, node: Node) -> Hint:
    """A hint at the option with the most similar spelling; none if no option is similar."""
    if not isinstance(options, list) or not isinstance(node, Scalar):
        return NO_HINT
    from robocomp_yaml.diag.suggest import did_you_mean, meaning

    if meant := _foreign(node.lexeme, options):
        return meaning(node.lexeme, meant)
    return did_you_mean(node.lexeme, map(str, options))


def _foreign(word: str, known: Container[str]) -> str:
    """The known word that has the meaning of one of another format; '' if there is none."""
    return next((ours for ours, others in _FOREIGN.items() if ours in known and word.lower() in others.split()), "")


_FOREIGN = {
    "cpp": "c++ cplusplus cxx cc", "python": "py python3", "map": "dictionary dict hash", "struct": "class record",
    "sequence": "list vector array", "list": "vector array sequence", "values": "choices allowed options oneof enum",
    "implements": "provides serves offers", "requires": "needs depends", "after": "depends_on depends dependson",
    "program": "command cmd exec", "env": "environment", "component": "name",
    "in": "params parameters args arguments inputs input", "out": "outputs output results", "returns": "return result",
    "throws": "raises exceptions errors", "default": "initial",
}  # fmt: skip
_LIMITS = ("min", "max", "minimum", "maximum")


def _name_hint(name: str) -> Hint:
    cleaned = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name).strip("_")
    if cleaned[:1].isdigit():
        cleaned = f"n{cleaned}"
    rule = "a name consists of letters, digits and underscores, and does not start with a digit"
    if not cleaned or len(cleaned) >= 60:
        return Hint(rule)
    return Hint(f"{rule}: for example '{cleaned}'", name, cleaned)


def _counted(count: int, keyword: str) -> str:
    """`1 element`, `2 characters`."""
    one, many = ("character", "characters") if keyword.endswith("Length") else ("element", "elements")
    return f"{count} {one if count == 1 else many}"


def _in_words(keyword: str, facts: dict[str, Any], node: Node, instance_path: Path[str | int]) -> str:
    key = _key_of(instance_path)
    it = f"'{key}'" if key else "the document"
    match keyword:
        case "type":
            *most, last = [_IN_WORDS[t] for t in facts["types"] if t != "null"] or ["nothing"]
            return f"{it} must be {', '.join(most)}{' or ' if most else ''}{last}, and is {_what(node)}"
        case "enum":
            return f"{it} must be one of {', '.join(str(o) for o in facts['options'])}, and is {_what(node)}"
        case "const":
            return f"{it} must be {facts.get('expected_value')}, and is {_what(node)}"
        case "minimum" | "exclusiveMinimum":
            return f"{it} must be {'above' if 'exclusive' in keyword else 'at least'} {facts['limit']}"
        case "maximum" | "exclusiveMaximum":
            return f"{it} must be {'below' if 'exclusive' in keyword else 'at most'} {facts['limit']}"
        case "minItems" | "minProperties" | "minLength":
            least = _counted(facts["limit"], keyword)
            return f"{it} must not be empty" if facts["limit"] == 1 else f"{it} must have at least {least}"
        case "maxItems" | "maxProperties" | "maxLength":
            return f"{it} must have at most {_counted(facts['limit'], keyword)}"
        case "uniqueItems":
            return f"{it} contains the same element twice"
        case _:
            return f"{it} has an invalid form"
