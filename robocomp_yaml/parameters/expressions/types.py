"""Types of expressions: every name is known, and every operator and function has operands of the right types.

A constraint with a valid type can be generated in every language of components.
"""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.parameters.specification.expression import (
    Attribute,
    Binary,
    Call,
    Compare,
    Each,
    Expression,
    ExpressionError,
    Index,
    ListExpression,
    LiteralExpression,
    Logic,
    NameExpression,
    Unary,
)
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    Type,
    is_text,
)
from robocomp_yaml.parameters.words import in_brief

BOOL, WHOLE, NUMBER, TEXT = BasicType("bool"), BasicType("long"), BasicType("double"), BasicType("string")


class Scope(msgspec.Struct, frozen=True):
    """The names of parameters, and of the variables of the enclosing `for`."""

    root: RecordType
    variables: tuple[tuple[str, Type], ...] = ()

    def with_variable(self, name: str, type_: Type) -> Scope:
        return Scope(self.root, (*self.variables, (name, type_)))

    def find(self, name: str) -> Type | None:
        for variable, type_ in reversed(self.variables):
            if variable == name:
                return type_
        return find_member(self.root, name)

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.variables] + [member.code_name for member in self.root.members]


def find_member(record: RecordType, name: str) -> Type | None:
    """The type of a member by its name in expressions, which is its name in code; None if it is unknown."""
    return next((member.type for member in record.members if member.code_name == name), None)


def check_constraint(expression: Expression, root: RecordType) -> None:
    """Raises ExpressionError unless the expression has a valid type and is true or false."""
    type_ = type_of(expression, Scope(root))
    if not is_bool(type_):
        raise ExpressionError(
            f"a constraint must be true or false, and this is {in_brief(type_)}", 0, "compare it: … > 0"
        )


def is_bool(type_: Type) -> bool:
    return isinstance(type_, BasicType) and type_.name == "bool"


def is_number(type_: Type) -> bool:
    return isinstance(type_, BasicType) and type_.is_number


def comparable(one: Type, other: Type) -> bool:
    """Whether two types can be compared with ==."""
    return any(fits(one) and fits(other) for fits in (is_bool, is_number, is_text))


def type_of(expression: Expression, scope: Scope) -> Type:
    """The type of an expression. Raises ExpressionError."""
    match expression:
        case LiteralExpression(value=bool()):
            return BOOL
        case LiteralExpression(value=str()):
            return TEXT
        case LiteralExpression(value=value):
            return WHOLE if isinstance(value, int) else NUMBER
        case NameExpression(name=name, at=at):
            found = scope.find(name)
            if found is None:
                raise _unknown("parameter", name, scope.names, at)
            return found
        case Attribute(of=of, name=name, at=at):
            return _attribute(type_of(of, scope), name, at)
        case Index():
            return _index(expression, scope)
        case ListExpression(items=items, at=at):
            return _listing(items, scope, at)
        case Unary(operator=operator, operand=operand):
            fits = is_bool if operator == "not" else is_number
            return _expect(operand, fits, "true or false" if operator == "not" else "a number", operator, scope)
        case Binary(operator=operator, left=left, right=right):
            types = [_expect(side, is_number, "a number", operator, scope) for side in (left, right)]
            whole = operator != "/" and all(isinstance(t, BasicType) and t.is_integer for t in types)
            return WHOLE if whole else NUMBER
        case Logic(operator=operator, operands=operands):
            for operand in operands:
                _expect(operand, is_bool, "true or false", operator, scope)
            return BOOL
        case Compare():
            return _compare(expression, scope)
        case Call():
            return _call(expression, scope)


def _expect(expression: Expression, fits: object, expected: str, where: str, scope: Scope) -> Type:
    found = type_of(expression, scope)
    if not fits(found):  # type: ignore[operator]
        raise _needs(f"'{where}'", expected, found, expression.at)
    return found


def _needs(what: str, expected: str, found: Type, at: int) -> ExpressionError:
    return ExpressionError(f"{what} needs {expected} here, and this is {in_brief(found)}", at)


def _unknown(what: str, name: str, known: list[str], at: int, of: str = "") -> ExpressionError:
    hint = did_you_mean(name, known, otherwise=f"there are: {', '.join(known[:20])}")
    return ExpressionError(f"unknown {what} '{name}'{of}", at, hint)


def _attribute(owner: Type, name: str, at: int) -> Type:
    if not isinstance(owner, RecordType):
        hint = "select an element with [0], or loop over the elements with 'for'" if isinstance(owner, ListType) else ""
        raise ExpressionError(f"{in_brief(owner)} has no members, so no '{name}'", at, hint)
    found = find_member(owner, name)
    if found is None:
        raise _unknown("member", name, [member.code_name for member in owner.members], at)
    return found


def _index(expression: Index, scope: Scope) -> Type:
    owner = type_of(expression.of, scope)
    if isinstance(owner, ListType):
        index = expression.index
        if isinstance(index, Unary) or not (isinstance(found := type_of(index, scope), BasicType) and found.is_integer):
            raise ExpressionError("an element of a list is selected by its number, counted from 0", index.at)
        return owner.element
    if isinstance(owner, MapType):
        _expect(expression.index, is_text, "text", "[]", scope)
        return owner.element
    raise ExpressionError(f"{in_brief(owner)} has no elements", expression.at)


def _listing(items: tuple[Expression, ...], scope: Scope, at: int) -> Type:
    types = [type_of(item, scope) for item in items]
    if not types:
        raise ExpressionError("an empty list contains nothing to compare with", at)
    for item, type_ in zip(items, types, strict=True):
        if not comparable(types[0], type_):
            raise ExpressionError(f"a list cannot contain both {in_brief(types[0])} and {in_brief(type_)}", item.at)
    return ListType(types[0])


def _compare(expression: Compare, scope: Scope) -> Type:
    left_node, left = expression.first, type_of(expression.first, scope)
    for operator, node in expression.rest:
        right = type_of(node, scope)
        if operator in ("in", "not in"):
            if not isinstance(right, (ListType, MapType)):
                raise _needs(f"'{operator}'", "a list or a map", right, node.at)
            inner = right.element if isinstance(right, ListType) else TEXT
            _same(left, inner, left_node, node, operator)
            if isinstance(node, ListExpression):
                for item in node.items:
                    _same(left, type_of(item, scope), left_node, item, operator)
        else:
            _same(left, right, left_node, node, operator)
            if operator in ("<", "<=", ">", ">=") and not (is_number(left) and is_number(right)):
                raise ExpressionError(f"'{operator}' compares numbers, and this is {in_brief(left)}", left_node.at)
        left_node, left = node, right
    return BOOL


def _same(left: Type, right: Type, left_node: Expression, right_node: Expression, operator: str) -> None:
    if not comparable(left, right):
        raise ExpressionError(f"'{operator}' cannot compare {in_brief(left)} with {in_brief(right)}", right_node.at)
    for type_, node in ((left, right_node), (right, left_node)):
        if isinstance(type_, EnumType) and isinstance(node, LiteralExpression) and node.value not in type_.names:
            raise _unknown("enumerator", str(node.value), list(type_.names), node.at, f" of {type_.name}")


def _call(call: Call, scope: Scope) -> Type:
    function, first = call.function, call.arguments[0]
    if function == "has":
        if not isinstance(first, (NameExpression, Attribute, Index)):
            raise ExpressionError("has() needs the name of a parameter, member or element", call.at)
        type_of(first, scope)
        return BOOL
    if isinstance(first, Each):
        element = _each(first, scope)
    elif len(call.arguments) > 1:
        arguments = (one for one in call.arguments if not isinstance(one, Each))
        types = [_expect(one, is_number, "a number", f"{function}()", scope) for one in arguments]
        return WHOLE if all(isinstance(t, BasicType) and t.is_integer for t in types) else NUMBER
    else:
        operand = type_of(first, scope)
        if function in _OF_ONE:
            return _of_one(function, operand, first)
        if not isinstance(operand, ListType):
            raise _needs(f"{function}()", "a list", operand, first.at)
        element = operand.element
    return _of_many(function, element, first)


_OF_ONE = ("len", "abs", "keys", "values")


def _of_one(function: str, operand: Type, node: Expression) -> Type:
    if function == "abs" and is_number(operand):
        return operand
    if function == "len" and isinstance(operand, (ListType, MapType)):
        return WHOLE
    if function in ("keys", "values") and isinstance(operand, MapType):
        return ListType(TEXT if function == "keys" else operand.element)
    expected = {"abs": "a number", "len": "a list or a map"}.get(function, "a map")
    raise _needs(f"{function}()", expected, operand, node.at)


def _of_many(function: str, element: Type, node: Expression | Each) -> Type:
    at = node.element.at if isinstance(node, Each) else node.at
    if function in ("all", "any"):
        if not is_bool(element):
            raise _needs(f"{function}()", "true or false", element, at)
        return BOOL
    if function == "unique":
        if not isinstance(element, (BasicType, EnumType)):
            raise _needs("unique()", "plain values", element, at)
        return BOOL
    if not is_number(element):
        raise _needs(f"{function}()", "numbers", element, at)
    return element


def _each(each: Each, scope: Scope) -> Type:
    source = type_of(each.source, scope)
    if isinstance(source, MapType):
        hint = "use keys(…) or values(…) of the map"
        raise ExpressionError("'for' needs a list here, and this is a map", each.source.at, hint)
    if not isinstance(source, ListType):
        raise _needs("'for'", "a list", source, each.source.at)
    inner = scope.with_variable(each.variable, source.element)
    if each.condition is not None:
        _expect(each.condition, is_bool, "true or false", "if", inner)
    return type_of(each.element, inner)
