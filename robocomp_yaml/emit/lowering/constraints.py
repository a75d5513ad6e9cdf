"""Lowers constraints to calls of functions of the run time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec

from robocomp_yaml.parameters.expressions.types import Scope, type_of
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
from robocomp_yaml.parameters.types import ListType, MapType, RecordType

_FUNCTIONS = {"len": "size", "abs": "absolute", "min": "least", "max": "most"}


class Calls(msgspec.Struct, frozen=True):
    """How a language spells the calls. `prefix` is the prefix of all functions. `value`, `text` and `sign` make
    literals of a value, of a text and of an operator. `listing` is a list of values, `pairs` the rest of a comparison,
    `later` an expression with lazy evaluation, and `parts` a list of these. `function` is a function of one variable,
    `member` the access to a member. `variable` is the name of a variable, and the number of variables around it."""

    prefix: str
    value: Callable[[object], str]
    text: Callable[[str], str]
    sign: Callable[[str], str]
    listing: Callable[[Sequence[str]], str]
    pairs: Callable[[Sequence[tuple[str, str]]], str]
    later: Callable[[str], str]
    parts: Callable[[Sequence[str]], str]
    function: Callable[[str, str], str]
    member: Callable[[str, str], str]
    variable: Callable[[str, int], str]

    def of(self, expression: Expression, root: RecordType) -> str:
        """The expression in code, in which `p` are the values of all parameters."""
        return _ConstraintWriter(Scope(root), self).code(expression)


class _ConstraintWriter(msgspec.Struct, frozen=True):
    scope: Scope
    calls: Calls

    def code(self, expression: Expression) -> str:
        calls = self.calls
        of = calls.prefix
        match expression:
            case LiteralExpression(value=data):
                return calls.value(data)
            case ListExpression(items=items):
                return self.listing(items)
            case NameExpression(name=name):
                return self.name(name)
            case Attribute(of=owner, name=name):
                record = type_of(owner, self.scope)
                assert isinstance(record, RecordType)
                return calls.member(self.code(owner), calls.text(_key(record, name)))
            case Index(of=owner, index=index):
                return f"{of}entry({self.code(owner)}, {self.code(index)})"
            case Unary(operator=operator, operand=operand):
                inner = self.code(operand)
                negative = f"{of}arithmetic({calls.sign('-')}, {calls.value(0)}, {inner})"
                return {"not": f"{of}opposite({inner})", "-": negative}.get(operator, inner)
            case Binary(operator=operator, left=left, right=right):
                return f"{of}arithmetic({calls.sign(operator)}, {self.code(left)}, {self.code(right)})"
            case Compare(first=first, rest=rest):
                pairs = calls.pairs([(calls.text(sign), self.code(part)) for sign, part in rest])
                return f"{of}compare({self.code(first)}, {pairs})"
            case Logic(operator=operator, operands=operands):
                parts = calls.parts([calls.later(self.code(operand)) for operand in operands])
                return f"{of}{'every' if operator == 'and' else 'some'}({parts})"
            case Call():
                return self.call(expression)

    def listing(self, items: Sequence[Expression]) -> str:
        return self.calls.listing([self.code(item) for item in items])

    def name(self, name: str) -> str:
        depths = [depth for depth, (variable, _) in enumerate(self.scope.variables) if variable == name]
        if depths:
            return self.calls.variable(name, depths[-1])
        return self.calls.member("p", self.calls.text(_key(self.scope.root, name)))

    def call(self, call: Call) -> str:
        function = f"{self.calls.prefix}{_FUNCTIONS.get(call.function, call.function)}"
        first = call.arguments[0]
        if isinstance(first, Each):
            return f"{function}({self.each(first)})"
        if len(call.arguments) > 1:
            return f"{function}({self.listing([part for part in call.arguments if not isinstance(part, Each)])})"
        return f"{function}({self.code(first)})"

    def each(self, each: Each) -> str:
        type_ = type_of(each.source, self.scope)
        assert isinstance(type_, (ListType, MapType))
        inner = _ConstraintWriter(self.scope.with_variable(each.variable, type_.element), self.calls)
        variable = self.calls.variable(each.variable, len(self.scope.variables))
        functions = [self.calls.function(variable, inner.code(each.element))]
        if each.condition is not None:
            functions.append(self.calls.function(variable, inner.code(each.condition)))
        return ", ".join((self.code(each.source), *functions))


def _key(record: RecordType, name: str) -> str:
    """The name in documents of the member with this name in expressions."""
    return next(member.name for member in record.members if member.code_name == name)
