"""The judge: the problems of values as diagnostics, with parameter, value, limit, unit and location."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import NO_HINT, Fix, Hint, removal
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, hint_for_key
from robocomp_yaml.parameters.spelling.references import node_is_reference
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ScalarType,
    Type,
    is_secret,
    json_type,
    unit_of,
)
from robocomp_yaml.parameters.verdict.other_properties import section_of
from robocomp_yaml.parameters.verdict.plain import KIND, wrong
from robocomp_yaml.parameters.words import kind_in_words
from robocomp_yaml.secrets import HIDDEN, url
from robocomp_yaml.semantics import references
from robocomp_yaml.semantics.limits import CHOICE, PATTERN, RANGE, bounds, elements, one_of
from robocomp_yaml.semantics.paths import Path, in_words
from robocomp_yaml.source.retyped import TRUTHS, retyped
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, not_plain


def judge(type_: Type, node: Node, path: Path, *, complete: bool, key: Scalar | None = None) -> Iterator[Diagnostic]:
    """All problems of a value. `complete`: required values must be set and null is invalid, as in a default; else the
    value is a layer, in which null resets a value to its default and everything may be missing."""
    match type_:
        case BasicType() | EnumType():
            yield from _scalar(type_, node, path, key)
        case ListType() if isinstance(node, Sequence):
            yield from _list(type_, node, path, complete, key)
        case MapType() if isinstance(node, Mapping):
            yield from _map(type_, node, path, complete, key)
        case RecordType() if isinstance(node, Mapping):
            yield from _record(type_, node, path, complete, key)
        case _:
            yield _wrong_type(type_, node, path, key)


def shown(node: Node, type_: Type) -> str:
    """A value for messages, shortened to 40 characters; HIDDEN for a secret."""
    if not isinstance(node, Scalar) or node.data is None:
        return not_plain(node)
    if is_secret(type_):
        return f"the text {HIDDEN}" if isinstance(node.data, str) else HIDDEN
    return f"the text '{_short(node.lexeme)}'" if isinstance(node.data, str) else _short(node.lexeme)


def _short(text: str) -> str:
    text = url(text)
    return text if len(text) <= 40 else f"{text[:39]}…"


def _span(node: Node, key: Scalar | None) -> Span:
    """The location of a value; of its key if the value is empty or spans several lines."""
    is_at_key = _is_empty(node) or node.span.line != node.span.end_line
    return key.span if key is not None and is_at_key else node.span


def _is_empty(node: Node) -> bool:
    return isinstance(node, Scalar) and not node.lexeme and not node.quoted


def _wrong_type(type_: Type, node: Node, path: Path, key: Scalar | None) -> Diagnostic:
    hint = ""
    if is_secret(type_):
        pass  # a hint would show it
    elif isinstance(node, Scalar) and isinstance(node.data, str) and isinstance(type_, BasicType):
        bare = node.lexeme.strip()
        if node.quoted and (
            (type_.is_number and re.fullmatch(r"[-+]?[0-9.]+", bare))
            or (type_.name == "bool" and bare in ("true", "false", "True", "False"))
        ):
            hint = f"write it without quotes: {bare}"
        elif type_.name == "bool" and (meant := TRUTHS.get(bare.lower())):
            hint = f"write {meant}"
    elif isinstance(type_, BasicType) and type_.name == "string" and isinstance(node, Scalar) and node.lexeme:
        hint = f'text needs quotes here: "{node.lexeme}"'
    expected = _expected(type_) if isinstance(type_, BasicType) else kind_in_words(type_)
    found, fixes = shown(node, type_), _retyped(type_, node)
    return codes.WRONG_TYPE.at(
        _span(node, key), path=in_words(path), wanted=expected, found=found, hint=hint, fixes=fixes
    )


def _retyped(type_: Type, node: Node) -> tuple[Fix, ...]:
    if not isinstance(node, Scalar) or not isinstance(type_, BasicType) or is_secret(type_):
        return ()
    return retyped([json_type(type_)], node.lexeme, node.data, node.span)


def _expected(type_: Type) -> str:
    """The values of a type in words, with the unit of numbers."""
    unit = unit_of(type_)
    return f"{kind_in_words(type_)} ({unit})" if unit else kind_in_words(type_)


def _scalar(type_: ScalarType, node: Node, path: Path, key: Scalar | None) -> Iterator[Diagnostic]:
    if node_is_reference(node):
        yield from _reference(node, path)
        return
    fault = wrong(type_, node.data)
    if fault == KIND:
        yield _wrong_type(type_, node, path, key)
    elif fault == PATTERN:
        assert isinstance(type_, BasicType) and type_.pattern is not None
        value = HIDDEN if type_.secret else f"'{_short(str(node.data))}'"
        yield codes.NO_MATCH.at(_span(node, key), path=in_words(path), value=value, pattern=type_.pattern.text)
    elif fault:
        yield _outside(type_, fault, node, path, key)


def _reference(node: Node, path: Path) -> Iterator[Diagnostic]:
    assert isinstance(node, Mapping)
    kind = next(kind for kind in references.KINDS if kind in node.entries)
    key, name = node.entries[kind]
    for other, _ in node.items():
        if other.lexeme != kind:
            problem = f"cannot have '{other.lexeme}' beside '{kind}'"
            yield codes.BAD_REFERENCE.at(other.span, path=in_words(path), problem=problem)
    if problem := references.problem(kind, name.data):
        span, hint = key.span if _is_empty(name) else name.span, _REFERENCE_HINTS[kind]
        yield codes.BAD_REFERENCE.at(span, path=in_words(path), problem=problem, hint=hint)


_REFERENCE_HINTS = {
    references.ENV: "a variable's name has letters, digits and underscores, and does not start with a digit",
    references.FILE: "file: is the path of a file that is read when the component starts",
}


def _outside(type_: ScalarType, fault: str, node: Node, path: Path, key: Scalar | None) -> Diagnostic:
    """The diagnostic for a value of the right kind that is not allowed."""
    assert isinstance(node, Scalar)
    unit = f" {unit}" if (unit := unit_of(type_)) else ""
    hint: str | Hint = NO_HINT
    value = _short(node.lexeme)
    if isinstance(node.data, str):
        value = f"'{node.data}'" if isinstance(type_, EnumType) else repr(value)
    if fault == CHOICE:
        allowed = type_.allowed if isinstance(type_, EnumType) else [each.lexeme for each in type_.values]
        expected = f"{one_of(allowed, type_.secret)}{unit}"
        hint = did_you_mean(node.data, allowed) if isinstance(node.data, str) and not type_.secret else NO_HINT
    elif fault == RANGE and isinstance(type_, BasicType) and type_.range is not None:
        expected = f"{type_.range.in_words}{unit}"
    else:
        expected = bounds(type_.name)
    value = f"{HIDDEN if type_.secret else value}{unit}"
    return codes.OUT_OF_RANGE.at(_span(node, key), path=in_words(path), value=value, wanted=expected, hint=hint)


def _list(type_: ListType, node: Sequence, path: Path, complete: bool, key: Scalar | None) -> Iterator[Diagnostic]:
    yield from wrong_size(type_, len(node.items), node, path, key)
    seen: set[object] = set()
    for index, item in enumerate(node.items):
        yield from judge(type_.element, item, (*path, index), complete=complete)
        if type_.unique:
            known = item.data if isinstance(item.data, (str, int, float)) else repr(item.data)
            if known in seen:
                value, fixes = shown(item, type_.element), [removal(item.span, safe=False)]
                yield codes.NOT_UNIQUE.at(item.span, path=in_words(path), value=value, fixes=fixes)
            seen.add(known)


def wrong_size(
    type_: ListType | MapType, count: int, node: Node, path: Path, key: Scalar | None
) -> Iterator[Diagnostic]:
    if not type_.size.holds(count):
        size = type_.size.in_words
        yield codes.WRONG_SIZE.at(_span(node, key), path=in_words(path), count=elements(count), wanted=size)


def _map(type_: MapType, node: Mapping, path: Path, complete: bool, key: Scalar | None) -> Iterator[Diagnostic]:
    if complete:  # the size of a layer is judged after merging
        yield from wrong_size(type_, len(node.entries), node, path, key)
    for name, value in node.items():
        if value.data is None and not complete:
            continue
        yield from judge(type_.element, value, (*path, name.lexeme), complete=complete, key=name)


def _record(type_: RecordType, node: Mapping, path: Path, complete: bool, key: Scalar | None) -> Iterator[Diagnostic]:
    for name, value in node.items():
        member = type_.member(name.lexeme)
        if member is None:
            if complete or not name.lexeme.startswith("x-"):  # an extension of the user
                yield unknown(name, type_, path, node)
        elif value.data is None and not isinstance(value, (Mapping, Sequence)):
            if complete:
                yield _wrong_type(member.type, value, (*path, name.lexeme), name)
        else:
            yield from judge(member.type, value, (*path, name.lexeme), complete=complete, key=name)
    if complete:
        yield from missing(type_, set(node.entries), path, key.span if key is not None else node.span)


def unknown(name: Scalar, type_: RecordType, path: Path, node: Mapping) -> Diagnostic:
    hint = hint_for_key(name.lexeme, (member.name for member in type_.members), node.entries)
    value = node.entries[name.lexeme][1] if name.lexeme in node.entries else None
    if not path:
        hint = Hint(section_of(name.lexeme, value, is_similar=bool(hint.meant))) or hint
    return codes.UNKNOWN_PARAMETER.at(name.span, path=in_words((*path, name.lexeme)), hint=hint)


def missing(type_: RecordType, present: set[str], path: Path, span: Span) -> Iterator[Diagnostic]:
    """The members that need a value and have none, those of missing groups included."""
    for member in type_.members:
        if member.name in present:
            continue
        if isinstance(member.type, RecordType) and member.type.is_group:
            yield from missing(member.type, set(), (*path, member.name), span)
        elif member.required:
            yield codes.MISSING.at(
                span, path=in_words((*path, member.name)), hint=f"set it to {_expected(member.type)}"
            )
