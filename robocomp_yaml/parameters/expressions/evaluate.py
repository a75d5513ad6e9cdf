"""What a constraint means: an expression's value over normalized parameters.

A value that is not there (an optional one left out, a reference to the environment) is unknown, None: what comes of it
components decide by the same functions (`semantics.constraints`), with every reference resolved.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from robocomp_yaml.parameters.specification.expression import (
    Attribute,
    Binary,
    Call,
    Compare,
    Each,
    Expression,
    Index,
    ListExpression,
    LiteralExpression,
    Logic,
    NameExpression,
    Unary,
)
from robocomp_yaml.parameters.types import ListType, MapType, RecordType, Type
from robocomp_yaml.semantics import constraints
from robocomp_yaml.semantics.references import is_reference

_OF_ALL = ("len", "abs", "keys", "values")  # whatever is known of what it holds


def holds(expression: Expression, data: Mapping[str, Any]) -> bool:
    """Whether a constraint holds; `data` is by the names that expressions use."""
    return constraints.holds(lambda: value(expression, data))


def value(expression: Expression, scope: Mapping[str, Any]) -> Any:
    match expression:
        case LiteralExpression(value=literal):
            return literal
        case NameExpression(name=name):
            return _known(scope.get(name))
        case Attribute(of=of, name=name):
            owner = value(of, scope)
            return None if owner is None else _known(owner.get(name))
        case Index(of=of, index=index):
            return _known(constraints.entry(value(of, scope), value(index, scope)))
        case ListExpression(items=items):
            return tuple(value(item, scope) for item in items)
        case Unary(operator="not", operand=operand):
            return constraints.opposite(value(operand, scope))
        case Unary(operator=operator, operand=operand):
            number = value(operand, scope)
            return constraints.arithmetic("-", 0, number) if operator == "-" else number
        case Binary(operator=operator, left=left, right=right):
            return constraints.arithmetic(operator, value(left, scope), value(right, scope))
        case Compare(first=first, rest=rest):
            others = ((operator, value(part, scope)) for operator, part in rest)
            return constraints.all_of(constraints.compared(value(first, scope), others))
        case Logic(operator=operator, operands=operands):
            parts = (value(operand, scope) for operand in operands)
            return constraints.all_of(parts) if operator == "and" else constraints.any_of(parts)
        case Call(function="has", arguments=(argument, *_)):
            return _has(argument, scope)
        case Call(function=function, arguments=arguments):
            return constraints.call(constraints.FUNCTIONS[function], lambda: _operand(function, arguments, scope))


def _known(data: Any) -> Any:
    """What a reference stands for is not known yet."""
    return None if is_reference(data) else data


def _has(asked: Expression | Each, scope: Mapping[str, Any]) -> Any:
    """Whether there is a value: one that a reference stands for is not known, but there."""
    if isinstance(asked, NameExpression):
        return scope.get(asked.name) is not None
    if not isinstance(asked, Attribute | Index):
        return not isinstance(asked, Each) and value(asked, scope) is not None
    if (around := _has(asked.of, scope)) is not True:
        return around
    owner = value(asked.of, scope)
    if isinstance(asked, Attribute):
        return None if owner is None else owner.get(asked.name) is not None
    index = value(asked.index, scope)
    constraints.entry(owner, index)  # raises where there is none
    return None if owner is None or index is None else True


def _operand(function: str, arguments: tuple[Expression | Each, ...], scope: Mapping[str, Any]) -> Any:
    first = arguments[0]
    if isinstance(first, Each):
        source = value(first.source, scope)
        return None if source is None else _elements(first, source, scope)
    if len(arguments) > 1:
        return tuple(value(argument, scope) for argument in arguments if not isinstance(argument, Each))
    operand = value(first, scope)
    return operand if operand is None or function in _OF_ALL else tuple(map(_known, operand))


def _elements(each: Each, source: Any, scope: Mapping[str, Any]) -> Iterator[Any]:
    """The values of the element; where a condition is unknown, so is the element."""
    inner = dict(scope)
    for item in source:
        inner[each.variable] = item
        if each.condition is None:
            yield value(each.element, inner)
        else:
            yield from constraints.when(value(each.condition, inner), lambda: value(each.element, inner))


def by_code_names(record: RecordType, data: dict[str, Any]) -> dict[str, Any]:
    """The values by the names that expressions use, which differ from the keys where `as:` says so."""
    return data if not _renames(record, {}) else _renamed(record, data)


def _renames(type_: Type, known: dict[str, bool]) -> bool:
    """`known` remembers structs, which stand in many places."""
    match type_:
        case RecordType(name=name, members=members):
            if name not in known:
                found = any(m.code_name != m.name or _renames(m.type, known) for m in members)
                return known.setdefault(name, found) if name else found
            return known[name]
        case ListType(element=element) | MapType(element=element):
            return _renames(element, known)
        case _:
            return False


def _renamed(type_: Type, data: Any) -> Any:
    match type_:
        case RecordType(members=members) if isinstance(data, dict):
            return {m.code_name: _renamed(m.type, data[m.name]) for m in members if m.name in data}
        case ListType(element=element) if isinstance(data, list):
            return [_renamed(element, item) for item in data]
        case MapType(element=element) if isinstance(data, dict):
            return {key: _renamed(element, item) for key, item in data.items()}
        case _:
            return data


def paths(expression: object) -> Iterator[tuple[str, ...]]:
    """The parameters that an expression names, in order: `motors`, `Yolo.use_gpu`."""
    match expression:
        case NameExpression(name=name):
            yield (name,)
        case Attribute(of=of, name=name):
            yield from ((*path, name) for path in paths(of))
        case Each(element=element, source=source, condition=condition):
            yield from paths(source)
            yield from paths(element)
            yield from paths(condition)
        case Index(of=first, index=second) | Binary(left=first, right=second):
            yield from paths(first)
            yield from paths(second)
        case Unary(operand=operand):
            yield from paths(operand)
        case ListExpression(items=parts) | Logic(operands=parts) | Call(arguments=parts):
            for part in parts:
                yield from paths(part)
        case Compare(first=first, rest=rest):
            yield from paths(first)
            for _, part in rest:
                yield from paths(part)
