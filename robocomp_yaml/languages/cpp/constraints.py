"""Constraints as C++: calls of the run time's functions, over values by name. The meaning is that of
`values.evaluate`."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.check.pdsl.expressions import Scope, type_of
from robocomp_yaml.languages.cpp import LANGUAGE
from robocomp_yaml.languages.cpp.literals import value
from robocomp_yaml.languages.cpp.text import quoted
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
from robocomp_yaml.model.parameters import ListType, MapType, RecordType

VALUE = "const runtime::Value&"
_FUNCTIONS = {"len": "size", "abs": "absolute", "min": "least", "max": "most"}
_TAKEN = frozenset(("p", "of", "runtime", "std"))


def lambda_of(expression: Expression, root: RecordType) -> str:
    """A function of the parameters' values, called `p` in there."""
    return _function("p", _Writer(Scope(root)).code(expression), capture="")


def _function(variable: str, body: str, capture: str = "&") -> str:
    used = re.search(rf"\b{variable}\b", body)
    return f"[{capture}]({VALUE}{f' {variable}' if used else ''}) {{ return {body}; }}"


class _Writer(msgspec.Struct, frozen=True):
    scope: Scope

    def code(self, expression: Expression) -> str:
        match expression:
            case Literal(value=data):
                return value(data)
            case Listing(items=items):
                return self.listing(items)
            case Name(name=name):
                return self.name(name)
            case Attribute(of=of, name=name):
                record = type_of(of, self.scope)
                assert isinstance(record, RecordType)
                return f"{self.code(of)}[{_key(record, name)}]"
            case Index(of=of, index=index):
                return f"of::entry({self.code(of)}, {self.code(index)})"
            case Unary(operator=operator, operand=operand):
                inner = self.code(operand)
                negative = f"of::arithmetic('-', 0, {inner})"
                return {"not": f"of::opposite({inner})", "-": negative}.get(operator, inner)
            case Binary(operator=operator, left=left, right=right):
                return f"of::arithmetic('{operator}', {self.code(left)}, {self.code(right)})"
            case Compare(first=first, rest=rest):
                pairs = ", ".join(f"{{{quoted(sign)}, {self.code(part)}}}" for sign, part in rest)
                return f"of::compare({self.code(first)}, {{{pairs}}})"
            case Logic(operator=operator, operands=operands):
                parts = ", ".join(f"[&] {{ return {self.code(operand)}; }}" for operand in operands)
                return f"of::{'every' if operator == 'and' else 'some'}({{{parts}}})"
            case Call():
                return self.call(expression)

    def listing(self, items: tuple[Expression, ...]) -> str:
        return f"runtime::Value(runtime::Value::List{{{', '.join(self.code(item) for item in items)}}})"

    def name(self, name: str) -> str:
        if any(variable == name for variable, _ in self.scope.variables):
            return _variable(name)
        return f"p[{_key(self.scope.root, name)}]"

    def call(self, call: Call) -> str:
        function = f"of::{_FUNCTIONS.get(call.function, call.function)}"
        first = call.arguments[0]
        if isinstance(first, Each):
            return f"{function}({self.each(first)})"
        if len(call.arguments) > 1:
            return f"{function}({self.listing(tuple(part for part in call.arguments if not isinstance(part, Each)))})"
        return f"{function}({self.code(first)})"

    def each(self, each: Each) -> str:
        type_ = type_of(each.source, self.scope)
        assert isinstance(type_, ListType | MapType)
        inner, variable = _Writer(self.scope.with_variable(each.variable, type_.element)), _variable(each.variable)
        functions = [_function(variable, inner.code(each.element))]
        if each.condition is not None:
            functions.append(_function(variable, inner.code(each.condition)))
        return ", ".join((self.code(each.source), *functions))


def _variable(name: str) -> str:
    return f"{name}_" if name in _TAKEN else LANGUAGE.in_code(name)


def _key(record: RecordType, name: str) -> str:
    """The name in data of the member that expressions call so."""
    return quoted(next(member.name for member in record.members if member.code_name == name))
