"""What a constraint means: an expression's value over normalized parameters.

A value that is not there (an optional one left out, a reference to the environment) is UNKNOWN. It makes comparisons
and arithmetic unknown; `and`, `or`, `not`, all() and any() go by the rest where that decides. A constraint that stays
unknown holds. has() knows that what is a reference will have a value. Generated accessors follow the same rules, with
every reference resolved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from robocomp_yaml.model.expression import (
    Attribute,
    Binary,
    Call,
    Compare,
    Each,
    Expression,
    Index,
    Listing,
    Literal,
    Logic,
    Name,
    Unary,
)
from robocomp_yaml.model.parameters import ListType, MapType, RecordType, Type
from robocomp_yaml.values.references import is_reference

UNKNOWN: Any = type("Unknown", (), {"__repr__": lambda self: "UNKNOWN"})()


class Undefined(ArithmeticError):
    """A division by zero, or an entry that a list or map does not have: the constraint does not hold."""


def holds(expression: Expression, data: Mapping[str, Any]) -> bool:
    """Whether a constraint holds; `data` is by the names that expressions use."""
    try:
        return value(expression, data) is not False
    except Undefined:
        return False


def value(expression: Expression, scope: Mapping[str, Any]) -> Any:
    match expression:
        case Literal(value=literal):
            return literal
        case Name(name=name):
            return _known(scope.get(name, UNKNOWN))
        case Attribute(of=of, name=name):
            owner = value(of, scope)
            return UNKNOWN if owner is UNKNOWN else _known(owner.get(name, UNKNOWN))
        case Index(of=of, index=index):
            return _entry(value(of, scope), value(index, scope))
        case Listing(items=items):
            return [value(item, scope) for item in items]
        case Unary(operator="not", operand=operand):
            return _not(value(operand, scope))
        case Unary(operator=operator, operand=operand):
            number = value(operand, scope)
            return UNKNOWN if number is UNKNOWN else -number if operator == "-" else number
        case Binary(operator=operator, left=left, right=right):
            return _arithmetic(operator, value(left, scope), value(right, scope))
        case Compare(first=first, rest=rest):
            return _all(_compared(first, rest, scope))
        case Logic(operator=operator, operands=operands):
            parts = (value(operand, scope) for operand in operands)
            return _all(parts) if operator == "and" else _any(parts)
        case Call(function=function, arguments=arguments):
            return _call(function, arguments, scope)


def _known(data: Any) -> Any:
    """What a reference stands for is not known yet."""
    return UNKNOWN if data is None or is_reference(data) else data


def _entry(owner: Any, index: Any) -> Any:
    if owner is UNKNOWN or index is UNKNOWN:
        return UNKNOWN
    try:
        if isinstance(owner, list) and index < 0:
            raise IndexError
        return _known(owner[index])
    except (IndexError, KeyError):
        raise Undefined(f"there is no entry {index!r}") from None


def _not(truth: Any) -> Any:
    return UNKNOWN if truth is UNKNOWN else not truth


def _all(parts: Iterator[Any]) -> Any:
    unknown = False
    for part in parts:
        if part is UNKNOWN:
            unknown = True
        elif not part:
            return False
    return UNKNOWN if unknown else True


def _any(parts: Iterator[Any]) -> Any:
    unknown = False
    for part in parts:
        if part is UNKNOWN:
            unknown = True
        elif part:
            return True
    return UNKNOWN if unknown else False


def _arithmetic(operator: str, left: Any, right: Any) -> Any:
    if left is UNKNOWN or right is UNKNOWN:
        return UNKNOWN
    try:
        match operator:
            case "+":
                return left + right
            case "-":
                return left - right
            case "*":
                return left * right
            case "/":
                return left / right
            case _:
                return left % right
    except (ZeroDivisionError, OverflowError):
        raise Undefined("a division by zero") from None


_COMPARE: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "in": lambda a, b: a in b,
    "not in": lambda a, b: a not in b,
}


def _compared(first: Expression, rest: tuple[tuple[str, Expression], ...], scope: Mapping[str, Any]) -> Iterator[Any]:
    left = value(first, scope)
    for operator, expression in rest:
        right = value(expression, scope)
        if left is UNKNOWN or right is UNKNOWN or (isinstance(right, list) and UNKNOWN in right):
            yield UNKNOWN
        else:
            yield _COMPARE[operator](left, right)
        left = right


def _call(function: str, arguments: tuple[Expression | Each, ...], scope: Mapping[str, Any]) -> Any:
    if function == "has":
        return _has(arguments[0], scope)
    if isinstance(arguments[0], Each):
        operand: Any = _each(arguments[0], scope)
    elif len(arguments) > 1:
        operand = [value(argument, scope) for argument in arguments if not isinstance(argument, Each)]
    else:
        operand = value(arguments[0], scope)
    if operand is UNKNOWN:
        return UNKNOWN
    if function in ("all", "any"):
        parts = (_known(part) for part in operand)
        return _all(parts) if function == "all" else _any(parts)
    if function in ("len", "abs", "keys", "values"):
        return _SIMPLE[function](operand)
    return _gathered(function, [_known(part) for part in operand])


def _has(asked: Expression | Each, scope: Mapping[str, Any]) -> Any:
    """Whether there is a value: one that a reference stands for is not known, but there."""
    if isinstance(asked, Name):
        return scope.get(asked.name) is not None and scope[asked.name] is not UNKNOWN
    if not isinstance(asked, Attribute | Index):
        return not isinstance(asked, Each) and value(asked, scope) is not UNKNOWN
    if (around := _has(asked.of, scope)) is not True:
        return around
    owner = value(asked.of, scope)
    if isinstance(asked, Attribute):
        return UNKNOWN if owner is UNKNOWN else owner.get(asked.name) is not None
    index = value(asked.index, scope)
    _entry(owner, index)  # raises where there is none
    return UNKNOWN if owner is UNKNOWN or index is UNKNOWN else True


_SIMPLE: dict[str, Callable[[Any], Any]] = {
    "len": len,
    "abs": abs,
    "keys": list,
    "values": lambda mapping: list(mapping.values()),
}


def _gathered(function: str, parts: list[Any]) -> Any:
    if any(part is UNKNOWN for part in parts):
        return UNKNOWN
    if function == "sum":
        return sum(parts)
    if function == "unique":
        return len(set(parts)) == len(parts)
    if not parts:
        raise Undefined(f"{function}() of nothing")
    return min(parts) if function == "min" else max(parts)


def _each(each: Each, scope: Mapping[str, Any]) -> Any:
    source = value(each.source, scope)
    return UNKNOWN if source is UNKNOWN else _elements(each, source, scope)


def _elements(each: Each, source: Any, scope: Mapping[str, Any]) -> Iterator[Any]:
    """The values of the element; where a condition is unknown, so is the element."""
    inner = dict(scope)
    for item in source:
        inner[each.variable] = item
        if each.condition is not None:
            wanted = value(each.condition, inner)
            if wanted is UNKNOWN:
                yield UNKNOWN
            if wanted is UNKNOWN or not wanted:
                continue
        yield value(each.element, inner)


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
        case Name(name=name):
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
        case Listing(items=parts) | Logic(operands=parts) | Call(arguments=parts):
            for part in parts:
                yield from paths(part)
        case Compare(first=first, rest=rest):
            yield from paths(first)
            for _, part in rest:
                yield from paths(part)
