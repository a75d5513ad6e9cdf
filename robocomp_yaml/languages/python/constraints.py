"""Constraints as Python: plain expressions where everything is known, the run time's functions where an optional
parameter may be missing. The meaning is that of `values.evaluate`."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from robocomp_yaml.languages.python import LANGUAGE
from robocomp_yaml.languages.python.text import literal
from robocomp_yaml.parameters.expressions.types import Scope, find_member, type_of
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

_OURS = ("unique", "keys", "values")  # the functions that are not Python's
_TAKEN = frozenset(("p", "constraints", "all", "any", "len", "min", "max", "abs", "sum"))


class Code(msgspec.Struct, frozen=True):
    """Python for an expression; `may_miss` when its value may be None: unknown."""

    text: str
    may_miss: bool = False


def lambda_of(expression: Expression, root: RecordType) -> str:
    """A function of the parameters' values, called `p` in there."""
    return f"lambda p: {_Writer(Scope(root)).code(expression).text}"


class _Writer(msgspec.Struct, frozen=True):
    scope: Scope

    def code(self, expression: Expression) -> Code:
        match expression:
            case LiteralExpression(value=value):
                return Code(literal(value))
            case ListExpression(items=items):
                parts = [self.code(item) for item in items]
                return Code(f"({_joined(parts)},)", _any_may(parts))
            case NameExpression(name=name):
                return self.name(name)
            case Attribute(of=of, name=name):
                return self.attribute(of, name)
            case Index(of=of, index=index):
                parts = [self.code(of), self.code(index)]
                return Code(f"constraints.entry({_joined(parts)})", _any_may(parts))
            case Unary():
                return self.unary(expression)
            case Binary(operator=operator, left=left, right=right):
                parts = [self.operand(left), self.operand(right)]
                if _any_may(parts):
                    return Code(f"constraints.arithmetic({literal(operator)}, {_joined(parts)})", True)
                return Code(f"{parts[0].text} {operator} {parts[1].text}")
            case Compare():
                return self.compare(expression)
            case Logic(operator=operator, operands=operands):
                parts = [self.operand(operand) for operand in operands]
                if _any_may(parts):
                    function = "every" if operator == "and" else "some"
                    return Code(f"constraints.{function}({', '.join(f'lambda: {part.text}' for part in parts)})", True)
                return Code(f" {operator} ".join(part.text for part in parts))
            case Call():
                return self.call(expression)

    def operand(self, expression: Expression) -> Code:
        """In parentheses where it is not one thing."""
        made = self.code(expression)
        is_open = isinstance(expression, Unary | Binary | Compare | Logic) and not made.text.startswith("constraints.")
        return Code(f"({made.text})", made.may_miss) if is_open else made

    def name(self, name: str) -> Code:
        if any(variable == name for variable, _ in self.scope.variables):
            return Code(_variable(name))
        member = next(member for member in self.scope.root.members if member.code_name == name)
        return Code(f"p.{LANGUAGE.in_code(name)}", member.optional)

    def attribute(self, of: Expression, name: str) -> Code:
        owner, record = self.code(of), type_of(of, self.scope)
        assert isinstance(record, RecordType)
        assert find_member(record, name) is not None
        member = next(member for member in record.members if member.code_name == name)
        attribute = LANGUAGE.in_code(name)
        if owner.may_miss:
            return Code(f"constraints.attribute({owner.text}, {literal(attribute)})", True)
        return Code(f"{owner.text}.{attribute}", member.optional)

    def unary(self, unary: Unary) -> Code:
        operand = self.operand(unary.operand)
        if not operand.may_miss:
            return Code(f"{unary.operator}{' ' if unary.operator == 'not' else ''}{operand.text}")
        if unary.operator == "not":
            return Code(f"constraints.opposite({operand.text})", True)
        zero = f'constraints.arithmetic("-", 0, {operand.text})'
        return Code(zero, True) if unary.operator == "-" else operand

    def compare(self, compare: Compare) -> Code:
        first = self.operand(compare.first)
        rest = [(operator, self.operand(part)) for operator, part in compare.rest]
        if not _any_may([first, *(part for _, part in rest)]):
            return Code(first.text + "".join(f" {operator} {part.text}" for operator, part in rest))
        arguments = "".join(f", {literal(operator)}, {part.text}" for operator, part in rest)
        return Code(f"constraints.compare({first.text}{arguments})", True)

    def call(self, call: Call) -> Code:
        function, first = call.function, call.arguments[0]
        if function == "has":
            assert not isinstance(first, Each)
            return Code(f"({self.code(first).text} is not None)")
        if isinstance(first, Each):
            argument = self.each(first)
        else:
            parts = [self.code(part) for part in call.arguments if not isinstance(part, Each)]
            argument = Code(f"({_joined(parts)})" if len(parts) > 1 else parts[0].text, _any_may(parts))
        called = f"constraints.{function}" if function in _OURS else function
        if argument.may_miss:
            return Code(f"constraints.call({called}, lambda: {argument.text})", True)
        return Code(f"{called}{argument.text}" if argument.text.startswith("(") else f"{called}({argument.text})")

    def each(self, each: Each) -> Code:
        source, type_ = self.code(each.source), type_of(each.source, self.scope)
        assert isinstance(type_, ListType | MapType)
        inner = _Writer(self.scope.with_variable(each.variable, type_.element))
        element = inner.code(each.element)
        condition = inner.code(each.condition) if each.condition is not None else Code("")
        loop = f"for {_variable(each.variable)} in "
        loop += f"constraints.known({source.text})" if source.may_miss else source.text
        may_miss = source.may_miss or element.may_miss or condition.may_miss
        if condition.may_miss:
            return Code(f"(part {loop} for part in constraints.when({condition.text}, lambda: {element.text}))", True)
        return Code(f"({element.text} {loop}{f' if {condition.text}' if condition.text else ''})", may_miss)


def _variable(name: str) -> str:
    return f"{name}_" if name in _TAKEN else LANGUAGE.in_code(name)


def _joined(parts: Iterable[Code]) -> str:
    return ", ".join(part.text for part in parts)


def _any_may(parts: Iterable[Code]) -> bool:
    return any(part.may_miss for part in parts)
