"""The value of an expression over complete values of parameters.

A missing optional value and a reference are unknown, None. Components evaluate constraints with the same functions
(`semantics.constraints`) when all references are resolved.
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
    parts,
)
from robocomp_yaml.parameters.types import ListType, MapType, RecordType, Type
from robocomp_yaml.semantics import constraints
from robocomp_yaml.semantics.references import is_reference

_OF_ALL = ("len", "abs", "keys", "values")  # defined even if elements are unknown


def holds(expression: Expression, data: Mapping[str, Any]) -> bool:
    """Whether a constraint holds. `data` has the names that expressions use, see `by_code_names`."""
    return constraints.holds(lambda: value(expression, data))


def value(expression: Expression, scope: Mapping[str, Any]) -> Any:
    """The value of an expression, None if it is unknown. Raises ArithmeticError, LookupError or ValueError if it is
    undefined, as a division by zero is."""
    match expression:
        case NameExpression(name=name):
            return _known(scope.get(name))
        case Attribute(of=of, name=name):
            owner = value(of, scope)
            return None if owner is None else _known(owner.get(name))
        case LiteralExpression(value=literal):
            return literal
        case Compare(first=first, rest=rest):
            others = ((operator, value(part, scope)) for operator, part in rest)
            return constraints.all_of(constraints.compared(value(first, scope), others))
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
        case Logic(operator=operator, operands=operands):
            truths = (value(operand, scope) for operand in operands)
            return constraints.all_of(truths) if operator == "and" else constraints.any_of(truths)
        case Call(function="has", arguments=(argument, *_)):
            return _has(argument, scope)
        case Call(function=function, arguments=arguments):
            return constraints.call(constraints.FUNCTIONS[function], lambda: _operand(function, arguments, scope))


def _known(data: Any) -> Any:
    """The data, or None for a reference, whose value is unknown."""
    return None if is_reference(data) else data


def _has(operand: Expression | Each, scope: Mapping[str, Any]) -> Any:
    """Whether a value is set. A reference sets a value, though it is unknown."""
    if isinstance(operand, NameExpression):
        return scope.get(operand.name) is not None
    if not isinstance(operand, (Attribute, Index)):
        return not isinstance(operand, Each) and value(operand, scope) is not None
    if (outer := _has(operand.of, scope)) is not True:
        return outer
    owner = value(operand.of, scope)
    if isinstance(operand, Attribute):
        return None if owner is None else owner.get(operand.name) is not None
    index = value(operand.index, scope)
    constraints.entry(owner, index)  # raises LookupError if there is no such element
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
    """The values of the element. Where the condition is unknown, the element is unknown."""
    inner = dict(scope)
    for item in source:
        inner[each.variable] = item
        if each.condition is None:
            yield value(each.element, inner)
        else:
            yield from constraints.when(value(each.condition, inner), lambda: value(each.element, inner))


def by_code_names(record: RecordType, data: dict[str, Any]) -> dict[str, Any]:
    """The values by the names that expressions use: `as:` sets a name that differs from the key."""
    return data if not _renames(record, {}) else _renamed(record, data)


def _renames(type_: Type, known: dict[str, bool]) -> bool:
    """Whether a type has names that differ from the keys. `known` caches structs, which are used more than once."""
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


def paths(expression: Expression | Each) -> Iterator[tuple[str, ...]]:
    """The paths that an expression names, in order: `motors`, `Yolo.use_gpu`."""
    match expression:
        case NameExpression(name=name):
            yield (name,)
        case Attribute(of=of, name=name):
            yield from ((*path, name) for path in paths(of))
        case _:
            for part in parts(expression):
                yield from paths(part)
