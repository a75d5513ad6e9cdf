"""Limits of a type's values: read from their nodes, joined with those that the type already has, and judged."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

from msgspec.structs import replace

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.parameters.patterns import pattern
from robocomp_yaml.parameters.specification.document import Limits
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
from robocomp_yaml.parameters.verdict.plain import CHOICE, KIND, PATTERN, RANGE, wrong
from robocomp_yaml.parameters.words import kind_in_words
from robocomp_yaml.semantics.limits import LIMITS
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

Found = list[Diagnostic]


def limited(type_: Type, limits: Limits, found: Found) -> Type:
    """The type with more limits; what is wrong with them goes to `found`."""
    for key in Limits.__struct_fields__:
        node = getattr(limits, key)
        if node is not None:
            type_ = _STEPS[key](type_, node, found)
    return type_


def _misfit(key: str, type_: Type, node: Node, found: Found) -> Type:
    says = "a group" if isinstance(type_, RecordType) else kind_in_words(type_)
    found.append(codes.LIMIT_MISFIT.at(node.span, key=key, problem=f"says nothing about a value that is {says}"))
    return type_


def _range(type_: Type, node: Node, found: Found) -> Type:
    if isinstance(type_, EnumType):
        return _enum_range(type_, node, found)
    if not isinstance(type_, BasicType) or not type_.is_number:
        return _misfit("range", type_, node, found)
    ends = list(_ends(node))
    for _, _, scalar in ends:
        if not _is_number(scalar.data):
            problem = f"needs numbers, not '{scalar.lexeme}'"
            found.append(codes.LIMIT_MISFIT.at(scalar.span, key="range", problem=problem))
            return type_
        if type_.is_integer and scalar.data != int(scalar.data):  # type: ignore[call-overload]
            found.append(codes.LIMIT_MISFIT.at(scalar.span, key="range", problem="of whole numbers has whole limits"))
            return type_
        least, most = LIMITS[type_.name]
        if not least <= scalar.data <= most:  # type: ignore[operator]
            problem = f"{scalar.lexeme} cannot be reached: {_reach(type_)}"
            found.append(codes.UNREACHABLE.at(scalar.span, problem=problem))
            return type_
    if problem := _both_ends(node):
        found.append(codes.LIMIT_MISFIT.at(node.span, key="range", problem=problem))
        return type_
    bounds = {end: _bound(scalar, is_open, type_) for end, is_open, scalar in ends}
    new = Range(bounds.get("low"), bounds.get("high"), span=node.span)
    if _is_empty(new, type_.is_integer):
        found.append(codes.EMPTY_LIMIT.at(node.span, problem=f"no number is {new.in_words}"))
        return type_
    joined = _joined(type_.range, new)
    if _is_empty(joined, type_.is_integer):
        assert type_.range is not None
        found.append(
            codes.EMPTY_LIMIT.at(
                node.span, problem=f"no number is {new.in_words} and {type_.range.in_words}, as its type says"
            )
        )
        return type_
    kept = tuple(value for value in type_.values if joined.holds(value.value))  # type: ignore[arg-type]
    if type_.values and not kept:
        found.append(codes.EMPTY_LIMIT.at(node.span, problem=f"none of the values of its type is {new.in_words}"))
        return type_
    return replace(type_, range=joined, values=kept)


def _ends(node: Node) -> Iterator[tuple[str, bool, Scalar]]:
    """Each limit of a range: which end, whether open, and its node."""
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


def _both_ends(node: Node) -> str:
    keys = node.entries.keys() if isinstance(node, Mapping) else ()
    for one, other in (("from", "above"), ("to", "below")):
        if one in keys and other in keys:
            return f"has either '{one}' or '{other}', not both"
    return "" if not isinstance(node, Mapping) or set(keys) & set(_KEYS) else "has no limit"


def _bound(scalar: Scalar, is_open: bool, type_: BasicType) -> Bound:
    value = scalar.data
    assert isinstance(value, int | float)
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


def _enum_range(type_: EnumType, node: Node, found: Found) -> Type:
    names = type_.names
    first, last = 0, len(names) - 1
    for end, is_open, scalar in _ends(node):
        if scalar.lexeme not in names:
            found.append(_unknown_enumerator(scalar, type_, "range"))
            return type_
        place = names.index(scalar.lexeme)
        first, last = (place + is_open, last) if end == "low" else (first, place - is_open)
    kept = tuple(name for name in names[first : last + 1] if name in type_.allowed)
    if problem := _both_ends(node):
        found.append(codes.LIMIT_MISFIT.at(node.span, key="range", problem=problem))
    elif not kept:
        found.append(codes.EMPTY_LIMIT.at(node.span, problem=f"no enumerator of {type_.name} lies in this range"))
    else:
        return replace(type_, allowed=kept)
    return type_


def _unknown_enumerator(scalar: Scalar, type_: EnumType, key: str) -> Diagnostic:
    hint = did_you_mean(scalar.lexeme, type_.names, otherwise=f"there are: {', '.join(type_.names)}")
    problem = f"names '{scalar.lexeme}', which is no enumerator of {type_.name}"
    return codes.LIMIT_MISFIT.at(scalar.span, key=key, problem=problem, hint=hint)


def _values(type_: Type, node: Node, found: Found) -> Type:
    items = [item for item in node.items if isinstance(item, Scalar)] if isinstance(node, Sequence) else []
    if isinstance(type_, EnumType):
        unknown = [item for item in items if item.lexeme not in type_.allowed]
        found += [
            _unknown_enumerator(item, type_, "values")
            if item.lexeme not in type_.names
            else codes.UNREACHABLE.at(item.span, problem=f"'{item.lexeme}' lies outside of the range")
            for item in unknown
        ]
        return (
            type_
            if unknown
            else replace(
                type_, allowed=tuple(name for name in type_.allowed if name in {item.lexeme for item in items})
            )
        )
    if not isinstance(type_, BasicType) or type_.name == "bool":
        return _misfit("values", type_, node, found)
    kept: list[Literal] = []
    for item in items:
        if problem := _unreachable(type_, item, kept):
            found.append(codes.UNREACHABLE.at(item.span, problem=problem))
            continue
        value: Any = item.data
        kept.append(Literal(int(value) if type_.is_integer else value, item.lexeme, span=item.span))
    return replace(type_, values=tuple(kept)) if kept else type_


def _unreachable(type_: BasicType, item: Scalar, before: list[Literal]) -> str:
    fault = wrong(type_, item.data)
    if fault == KIND:
        return f"'{item.lexeme}' is not {kind_in_words(type_)}"
    if any(item.data == other.value for other in before):
        return f"'{item.lexeme}' stands twice"
    if fault == CHOICE:
        return f"'{item.lexeme}' is none of the values of its type"
    if fault == PATTERN:
        return f"'{item.lexeme}' does not match the pattern"
    if fault == RANGE and type_.range is not None:
        return f"{item.lexeme} cannot be reached: the range goes {type_.range.in_words}"
    return f"{item.lexeme} cannot be reached: {_reach(type_)}" if fault else ""


def _reach(type_: BasicType) -> str:
    return "{} goes from {} to {}".format(type_.name, *LIMITS[type_.name])


def _pattern(type_: Type, node: Node, found: Found) -> Type:
    if not isinstance(type_, BasicType) or type_.name != "string":
        return _misfit("pattern", type_, node, found)
    assert isinstance(node, Scalar)
    if type_.pattern is not None:
        found.append(codes.LIMIT_MISFIT.at(node.span, key="pattern", problem="stands at the type already"))
        return type_
    try:
        parsed = pattern.parse(node.lexeme)
    except pattern.NotPortable as refused:
        found.append(codes.BAD_PATTERN.at(inside(node, refused.index), problem=str(refused)))
        return type_
    for value in type_.values:
        if not parsed.matches(str(value.value)):
            found.append(codes.UNREACHABLE.at(value.span, problem=f"'{value.lexeme}' does not match the pattern"))
            return type_
    return replace(type_, pattern=parsed)


def inside(node: Scalar, index: int) -> Span:
    """The place of a character of a scalar's text, as far as its spelling on one line tells."""
    span = node.span
    if span.line != span.end_line or span.end_column - span.column != len(node.lexeme) + 2 * node.quoted:
        return span
    column = span.column + index + node.quoted
    return Span(span.file, span.line, column, span.line, column + 1)


def _size(type_: Type, node: Node, found: Found) -> Type:
    if not isinstance(type_, ListType | MapType):
        return _misfit("size", type_, node, found)
    data, old = node.data, type_.size
    ends: list[Any] = data if isinstance(data, list) else [data, data]
    if isinstance(data, dict):
        ends = [data.get("from", 0), data.get("to")]
    limits = [int(most) for most in (ends[1], old.most) if most is not None]
    size = Size(max(int(ends[0]), old.least), min(limits, default=None), span=node.span)
    if size.most is not None and size.least > size.most:
        found.append(codes.EMPTY_LIMIT.at(node.span, problem=f"at least {size.least} and at most {size.most} entries"))
        return type_
    return replace(type_, size=size)


def _unique(type_: Type, node: Node, found: Found) -> Type:
    if node.data is not True:
        return type_
    if not isinstance(type_, ListType) or not isinstance(type_.element, BasicType | EnumType):
        found.append(
            codes.LIMIT_MISFIT.at(
                node.span,
                key="unique",
                problem="is for lists of plain values",
                hint="for records, a constraint says it: unique(m.name for m in motors)",
            )
        )
        return type_
    element = type_.element
    count = (
        len(element.allowed)
        if isinstance(element, EnumType)
        else len(element.values) or (2 if element.name == "bool" else None)
    )
    if count is not None and type_.size.least > count:
        found.append(
            codes.EMPTY_LIMIT.at(
                node.span, problem=f"{type_.size.least} entries, all different, of only {count} values"
            )
        )
        return type_
    return replace(type_, unique=True)


def _unit(type_: Type, node: Node, found: Found) -> Type:
    if isinstance(type_, ListType | MapType):
        return replace(type_, element=_unit(type_.element, node, found))
    if not isinstance(type_, BasicType) or not type_.is_number:
        return _misfit("unit", type_, node, found)
    return replace(type_, unit=str(node.data))


_STEPS = {"range": _range, "values": _values, "pattern": _pattern, "size": _size, "unique": _unique, "unit": _unit}
