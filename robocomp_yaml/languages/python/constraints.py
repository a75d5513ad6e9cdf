"""Constraints as Python: plain expressions if all values are known, functions of the run time if an optional parameter
may be missing. The meaning is that of `parameters.expressions`."""

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

_OF_RUN_TIME = ("unique", "keys", "values")  # functions that Python does not have
_TAKEN = frozenset(("p", "constraints", "all", "any", "len", "min", "max", "abs", "sum"))


class PythonCode(msgspec.Struct, frozen=True):
    """Python for an expression; `may_miss` if its value may be None, which means unknown."""

    text: str
    may_miss: bool = False


def lambda_of(expression: Expression, root: RecordType) -> str:
    """A lambda with the parameters' values as its argument `p`."""
    return f"lambda p: {_ConstraintWriter(Scope(root)).code(expression).text}"


class _ConstraintWriter(msgspec.Struct, frozen=True):
    scope: Scope

    def code(self, expression: Expression) -> PythonCode:
        match expression:
            case LiteralExpression(value=value):
                return PythonCode(literal(value))
            case ListExpression(items=items):
                parts = [self.code(item) for item in items]
                return PythonCode(f"({_joined(parts)},)", _any_may(parts))
            case NameExpression(name=name):
                return self.name(name)
            case Attribute(of=of, name=name):
                return self.attribute(of, name)
            case Index(of=of, index=index):
                parts = [self.code(of), self.code(index)]
                return PythonCode(f"constraints.entry({_joined(parts)})", _any_may(parts))
            case Unary():
                return self.unary(expression)
            case Binary(operator=operator, left=left, right=right):
                parts = [self.operand(left), self.operand(right)]
                if _any_may(parts):
                    return PythonCode(f"constraints.arithmetic({literal(operator)}, {_joined(parts)})", True)
                return PythonCode(f"{parts[0].text} {operator} {parts[1].text}")
            case Compare():
                return self.compare(expression)
            case Logic(operator=operator, operands=operands):
                parts = [self.operand(operand) for operand in operands]
                if _any_may(parts):
                    function = "every" if operator == "and" else "some"
                    return PythonCode(
                        f"constraints.{function}({', '.join(f'lambda: {part.text}' for part in parts)})", True
                    )
                return PythonCode(f" {operator} ".join(part.text for part in parts))
            case Call():
                return self.call(expression)

    def operand(self, expression: Expression) -> PythonCode:
        """The code of an operand, in parentheses if needed."""
        made = self.code(expression)
        is_open = isinstance(expression, (Unary, Binary, Compare, Logic)) and not made.text.startswith("constraints.")
        return PythonCode(f"({made.text})", made.may_miss) if is_open else made

    def name(self, name: str) -> PythonCode:
        if any(variable == name for variable, _ in self.scope.variables):
            return PythonCode(_variable(name))
        member = next(member for member in self.scope.root.members if member.code_name == name)
        return PythonCode(f"p.{LANGUAGE.in_code(name)}", member.optional)

    def attribute(self, of: Expression, name: str) -> PythonCode:
        owner, record = self.code(of), type_of(of, self.scope)
        assert isinstance(record, RecordType)
        assert find_member(record, name) is not None
        member = next(member for member in record.members if member.code_name == name)
        attribute = LANGUAGE.in_code(name)
        if owner.may_miss:
            return PythonCode(f"constraints.attribute({owner.text}, {literal(attribute)})", True)
        return PythonCode(f"{owner.text}.{attribute}", member.optional)

    def unary(self, unary: Unary) -> PythonCode:
        operand = self.operand(unary.operand)
        if not operand.may_miss:
            return PythonCode(f"{unary.operator}{' ' if unary.operator == 'not' else ''}{operand.text}")
        if unary.operator == "not":
            return PythonCode(f"constraints.opposite({operand.text})", True)
        zero = f'constraints.arithmetic("-", 0, {operand.text})'
        return PythonCode(zero, True) if unary.operator == "-" else operand

    def compare(self, compare: Compare) -> PythonCode:
        first = self.operand(compare.first)
        rest = [(operator, self.operand(part)) for operator, part in compare.rest]
        if not _any_may([first, *(part for _, part in rest)]):
            return PythonCode(first.text + "".join(f" {operator} {part.text}" for operator, part in rest))
        arguments = "".join(f", {literal(operator)}, {part.text}" for operator, part in rest)
        return PythonCode(f"constraints.compare({first.text}{arguments})", True)

    def call(self, call: Call) -> PythonCode:
        function, first = call.function, call.arguments[0]
        if function == "has":
            assert not isinstance(first, Each)
            return PythonCode(f"({self.code(first).text} is not None)")
        if isinstance(first, Each):
            argument = self.each(first)
        else:
            parts = [self.code(part) for part in call.arguments if not isinstance(part, Each)]
            argument = PythonCode(f"({_joined(parts)})" if len(parts) > 1 else parts[0].text, _any_may(parts))
        called = f"constraints.{function}" if function in _OF_RUN_TIME else function
        if argument.may_miss:
            return PythonCode(f"constraints.call({called}, lambda: {argument.text})", True)
        return PythonCode(f"{called}{argument.text}" if argument.text.startswith("(") else f"{called}({argument.text})")

    def each(self, each: Each) -> PythonCode:
        source, type_ = self.code(each.source), type_of(each.source, self.scope)
        assert isinstance(type_, (ListType, MapType))
        inner = _ConstraintWriter(self.scope.with_variable(each.variable, type_.element))
        element = inner.code(each.element)
        condition = inner.code(each.condition) if each.condition is not None else PythonCode("")
        loop = f"for {_variable(each.variable)} in "
        loop += f"constraints.known({source.text})" if source.may_miss else source.text
        may_miss = source.may_miss or element.may_miss or condition.may_miss
        if condition.may_miss:
            return PythonCode(
                f"(part {loop} for part in constraints.when({condition.text}, lambda: {element.text}))", True
            )
        return PythonCode(f"({element.text} {loop}{f' if {condition.text}' if condition.text else ''})", may_miss)


def _variable(name: str) -> str:
    return f"{name}_" if name in _TAKEN else LANGUAGE.in_code(name)


def _joined(parts: Iterable[PythonCode]) -> str:
    return ", ".join(part.text for part in parts)


def _any_may(parts: Iterable[PythonCode]) -> bool:
    return any(part.may_miss for part in parts)
