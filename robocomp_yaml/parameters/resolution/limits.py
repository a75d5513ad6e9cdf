"""Limits of the values of a type: read from their nodes, checked, and combined with the limits of the type."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

from msgspec.structs import replace

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Diagnosed
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.parameters.patterns import pattern
from robocomp_yaml.parameters.specification.document import LimitNodes
from robocomp_yaml.parameters.types import (
    BasicType,
    Bound,
    EnumType,
    ListType,
    MapType,
    Range,
    RecordType,
    Size,
    Type,
)
from robocomp_yaml.parameters.verdict.plain import KIND, wrong
from robocomp_yaml.parameters.words import kind_in_words
from robocomp_yaml.semantics.limits import CHOICE, LIMITS, PATTERN, RANGE
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence


class _Rejected(Diagnosed):
    """A limit is invalid, and the type is unchanged."""


def limited(type_: Type, limits: LimitNodes, found: list[Diagnostic]) -> Type:
    """The type with more limits. Invalid limits are reported in `found` and skipped."""
    for key in LimitNodes.__struct_fields__:
        node = getattr(limits, key)
        if node is not None:
            try:
                type_ = _values(type_, node, found) if key == "values" else _STEPS[key](type_, node)
            except _Rejected as rejected:
                found.append(rejected.diagnostic)
    return type_


def _misfit(key: str, node: Node, problem: str, hint: str | Hint = "") -> _Rejected:
    return _Rejected(codes.LIMIT_MISFIT.at(node.span, key=key, problem=problem, hint=hint))


def _not_for(key: str, type_: Type, node: Node) -> _Rejected:
    kind = "a group" if isinstance(type_, RecordType) else kind_in_words(type_)
    return _misfit(key, node, f"does not apply to a value that is {kind}")


def _empty(node: Node, problem: str) -> _Rejected:
    return _Rejected(codes.EMPTY_LIMIT.at(node.span, problem=problem))


def _range(type_: Type, node: Node) -> Type:
    if isinstance(type_, EnumType):
        return _enum_range(type_, node)
    if not isinstance(type_, BasicType) or not type_.is_number:
        raise _not_for("range", type_, node)
    ends = list(_ends(node))
    least, most = LIMITS[type_.name]
    for _, _, scalar in ends:
        if not _is_number(scalar.data):
            raise _misfit("range", scalar, f"needs numbers, not '{scalar.lexeme}'")
        if type_.is_integer and scalar.data != int(scalar.data):  # type: ignore[call-overload]
            raise _misfit("range", scalar, "of whole numbers needs whole limits")
        if not least <= scalar.data <= most:  # type: ignore[operator]
            problem = f"{scalar.lexeme} is out of range: {_reach(type_)}"
            raise _Rejected(codes.UNREACHABLE.at(scalar.span, problem=problem))
    _check_keys(node)
    bounds = {end: _bound(scalar, is_open, type_) for end, is_open, scalar in ends}
    new = Range(bounds.get("low"), bounds.get("high"), span=node.span)
    if _is_empty(new, type_.is_integer):
        raise _empty(node, f"no number is {new.in_words}")
    joined = _joined(type_.range, new)
    if type_.range is not None and _is_empty(joined, type_.is_integer):
        raise _empty(node, f"no number is {new.in_words} and, as its type requires, {type_.range.in_words}")
    kept = tuple(value for value in type_.values if joined.holds(value.value))  # type: ignore[arg-type]
    if type_.values and not kept:
        raise _empty(node, f"no value of its type is {new.in_words}")
    return replace(type_, range=joined, values=kept)


def _ends(node: Node) -> Iterator[tuple[str, bool, Scalar]]:
    """The limits of a range: which end, whether it is exclusive, and its node."""
    if isinstance(node, Sequence):
        for end, item in zip(("low", "high"), node.items, strict=True):
            assert isinstance(item, Scalar)
            yield end, False, item
    elif isinstance(node, Mapping):
        for key, (end, is_open) in _KEYS.items():
            if isinstance(scalar := node.get(key), Scalar):
                yield end, is_open, scalar


def _is_number(value: object) -> bool:
    return isinstance(value, int) or (isinstance(value, float) and isfinite(value))


_KEYS = {"from": ("low", False), "above": ("low", True), "to": ("high", False), "below": ("high", True)}


def _check_keys(node: Node) -> None:
    """Raises _Rejected if a range has two limits at one end, or no limit."""
    keys = node.entries.keys() if isinstance(node, Mapping) else ()
    for one, other in (("from", "above"), ("to", "below")):
        if one in keys and other in keys:
            raise _misfit("range", node, f"cannot have both '{one}' and '{other}'")
    if isinstance(node, Mapping) and not set(keys) & set(_KEYS):
        raise _misfit("range", node, "has no limit")


def _bound(scalar: Scalar, is_open: bool, type_: BasicType) -> Bound:
    value = scalar.data
    assert isinstance(value, (int, float))
    return Bound(int(value) if type_.is_integer else value, is_open, scalar.lexeme)


def _joined(one: Range | None, other: Range) -> Range:
    if one is None:
        return other
    low = max((b for b in (one.low, other.low) if b), key=lambda b: (b.value, b.is_open), default=None)
    high = min((b for b in (one.high, other.high) if b), key=lambda b: (b.value, not b.is_open), default=None)
    return Range(low, high, span=other.span)


def _is_empty(range_: Range, is_integer: bool) -> bool:
    low, high = range_.low, range_.high
    if low is None or high is None:
        return False
    if is_integer:
        return low.value + low.is_open > high.value - high.is_open
    return low.value > high.value or (low.value == high.value and (low.is_open or high.is_open))


def _enum_range(type_: EnumType, node: Node) -> Type:
    names = type_.names
    first, last = 0, len(names) - 1
    for end, is_open, scalar in _ends(node):
        if scalar.lexeme not in names:
            raise _unknown_enumerator(scalar, type_, "range")
        index = names.index(scalar.lexeme)
        first, last = (index + is_open, last) if end == "low" else (first, index - is_open)
    _check_keys(node)
    kept = tuple(name for name in names[first : last + 1] if name in type_.allowed)
    if not kept:
        raise _empty(node, f"no enumerator of {type_.name} is in this range")
    return replace(type_, allowed=kept)


def _unknown_enumerator(scalar: Scalar, type_: EnumType, key: str) -> _Rejected:
    hint = did_you_mean(scalar.lexeme, type_.names, otherwise=f"there are: {', '.join(type_.names)}")
    return _misfit(key, scalar, f"names unknown enumerator '{scalar.lexeme}' of {type_.name}", hint)


def _values(type_: Type, node: Node, found: list[Diagnostic]) -> Type:
    """The type with its valid values. Invalid values are reported in `found`."""
    items = [item for item in node.items if isinstance(item, Scalar)] if isinstance(node, Sequence) else []
    before = len(found)
    if isinstance(type_, EnumType):
        for item in items:
            if item.lexeme not in type_.names:
                found.append(_unknown_enumerator(item, type_, "values").diagnostic)
            elif item.lexeme not in type_.allowed:
                found.append(codes.UNREACHABLE.at(item.span, problem=f"'{item.lexeme}' is outside the range"))
        named = {item.lexeme for item in items}
        kept = tuple(name for name in type_.allowed if name in named)
        return type_ if len(found) > before else replace(type_, allowed=kept)
    if not isinstance(type_, BasicType) or type_.name == "bool":
        raise _not_for("values", type_, node)
    values: list[Literal] = []
    for item in items:
        if problem := _problem_of(type_, item, values):
            found.append(codes.UNREACHABLE.at(item.span, problem=problem))
            continue
        value: Any = item.data
        values.append(Literal(int(value) if type_.is_integer else value, item.lexeme, span=item.span))
    return replace(type_, values=tuple(values)) if values else type_


def _problem_of(type_: BasicType, item: Scalar, before: list[Literal]) -> str:
    fault = wrong(type_, item.data)
    if fault == KIND:
        return f"'{item.lexeme}' is not {kind_in_words(type_)}"
    if any(item.data == other.value for other in before):
        return f"'{item.lexeme}' appears twice"
    if fault == CHOICE:
        return f"'{item.lexeme}' is not a value of its type"
    if fault == PATTERN:
        return f"'{item.lexeme}' does not match the pattern"
    if fault == RANGE and type_.range is not None:
        return f"{item.lexeme} is out of range: it must be {type_.range.in_words}"
    return f"{item.lexeme} is out of range: {_reach(type_)}" if fault else ""


def _reach(type_: BasicType) -> str:
    return "{} is from {} to {}".format(type_.name, *LIMITS[type_.name])


def _pattern(type_: Type, node: Node) -> Type:
    if not isinstance(type_, BasicType) or type_.name != "string":
        raise _not_for("pattern", type_, node)
    assert isinstance(node, Scalar)
    if type_.pattern is not None:
        raise _misfit("pattern", node, "is already set by the type")
    try:
        parsed = pattern.parse(node.lexeme)
    except pattern.NotPortable as rejected:
        raise _Rejected(codes.BAD_PATTERN.at(inside(node, rejected.index), problem=str(rejected))) from None
    for value in type_.values:
        if not parsed.matches(str(value.value)):
            problem = f"'{value.lexeme}' does not match the pattern"
            raise _Rejected(codes.UNREACHABLE.at(value.span, problem=problem))
    return replace(type_, pattern=parsed)


def inside(node: Scalar, index: int) -> Span:
    """The location of a character of a scalar's text; the whole scalar if it is escaped or spans several lines."""
    span = node.span
    if span.line != span.end_line or span.end_column - span.column != len(node.lexeme) + 2 * node.quoted:
        return span
    column = span.column + index + node.quoted
    return Span(span.file, span.line, column, span.line, column + 1)


def _size(type_: Type, node: Node) -> Type:
    if not isinstance(type_, (ListType, MapType)):
        raise _not_for("size", type_, node)
    data, old = node.data, type_.size
    ends: list[Any] = data if isinstance(data, list) else [data, data]
    if isinstance(data, dict):
        ends = [data.get("from", 0), data.get("to")]
    limits = [int(most) for most in (ends[1], old.most) if most is not None]
    size = Size(max(int(ends[0]), old.least), min(limits, default=None), span=node.span)
    if size.most is not None and size.least > size.most:
        raise _empty(node, f"at least {size.least} and at most {size.most} elements")
    return replace(type_, size=size)


def _unique(type_: Type, node: Node) -> Type:
    if node.data is not True:
        return type_
    if not isinstance(type_, ListType) or not isinstance(element := type_.element, (BasicType, EnumType)):
        hint = "for records, write a constraint: unique(m.name for m in motors)"
        raise _misfit("unique", node, "applies only to lists of plain values", hint)
    possible = element.allowed if isinstance(element, EnumType) else element.values
    count = len(possible) or (2 if element.name == "bool" else None)
    if count is not None and type_.size.least > count:
        raise _empty(node, f"{type_.size.least} different elements need more than {count} values")
    return replace(type_, unique=True)


def _unit(type_: Type, node: Node) -> Type:
    if isinstance(type_, (ListType, MapType)):
        return replace(type_, element=_unit(type_.element, node))
    if not isinstance(type_, BasicType) or not type_.is_number:
        raise _not_for("unit", type_, node)
    return replace(type_, unit=str(node.data))


_STEPS: dict[str, Callable[[Type, Node], Type]] = {
    "range": _range, "pattern": _pattern, "size": _size, "unique": _unique, "unit": _unit,
}  # fmt: skip
