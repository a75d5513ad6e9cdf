"""Mutants of a module: small changes inside its functions, each of which changes what the code means.

They are those that mutmut makes: comparisons, arithmetic, `and` and `or`, `not`, constants, values that become None,
arguments that are dropped; and conditions that are turned round. What only types read is left alone.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import CodeType

_COMPARED = {
    ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==", ast.Is: "is not",
    ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in",
}  # fmt: skip
_COUNTED = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "/", ast.Mod: "/", ast.Pow: "*",
    ast.BitAnd: "|", ast.BitOr: "&",
}  # fmt: skip
_FOR_TYPES = ("cast", "isinstance", "issubclass")
FUNCTIONS = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Mutant:
    """`text` in the place of the bytes from `start` to `end`, in the statement and the function that begin in these
    lines."""

    path: Path
    start: int
    end: int
    text: str
    line: int
    statement: int
    function: int

    def __str__(self) -> str:
        was = " ".join(self.path.read_bytes()[self.start : self.end].decode().split())
        return f"{self.path}:{self.line}: {_short(was)}  →  {_short(self.text)}"

    @property
    def is_python(self) -> bool:
        try:
            return bool(self.code())
        except SyntaxError:
            return False

    def code(self) -> CodeType:
        """The code of the function, as it is with the mutant. Raises SyntaxError where it is no Python."""
        source = self.path.read_bytes()
        module = compile(source[: self.start] + self.text.encode() + source[self.end :], str(self.path), "exec")
        return next(code for code in codes(module) if code.co_firstlineno == self.function and code.co_name[0] != "<")


def codes(code: CodeType) -> Iterator[CodeType]:
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield inner
            yield from codes(inner)


def of(path: Path) -> list[Mutant]:
    """All mutants of a module, in the order of its text; a few are no Python."""
    maker = _Maker(path)
    for function in _outermost(ast.parse(maker.source)):
        maker.function = min([function.lineno, *(decorator.lineno for decorator in function.decorator_list)])
        for statement in function.body:
            maker.visit(statement)
    return sorted(maker.made, key=lambda mutant: (mutant.start, mutant.end, mutant.text))


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:28]} … {text[-28:]}"


def _outermost(tree: ast.AST) -> Iterator[FUNCTIONS]:
    for child in ast.iter_child_nodes(tree):
        if isinstance(child, FUNCTIONS):
            yield child
        elif isinstance(child, ast.ClassDef):
            yield from _outermost(child)


class _Maker(ast.NodeVisitor):
    def __init__(self, path: Path) -> None:
        self.path = path
        self.source = path.read_bytes()
        self.starts = [0]
        for line in self.source.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))
        self.function = self.statement = 0
        self.made: list[Mutant] = []

    def visit(self, node: ast.AST) -> None:
        around = self.statement
        if isinstance(node, ast.stmt):
            self.statement = node.lineno
        super().visit(node)
        self.statement = around

    # Places and texts

    def span(self, node: ast.expr) -> tuple[int, int]:
        assert node.end_lineno is not None and node.end_col_offset is not None
        return self.starts[node.lineno - 1] + node.col_offset, self.starts[node.end_lineno - 1] + node.end_col_offset

    def text(self, node: ast.expr) -> str:
        start, end = self.span(node)
        return self.source[start:end].decode()

    def instead(self, node: ast.expr, text: str) -> None:
        self.put(*self.span(node), text, node.lineno)

    def put(self, start: int, end: int, text: str, line: int) -> None:
        self.made.append(Mutant(self.path, start, end, text, line, self.statement, self.function))

    def between(self, left: ast.expr, right: ast.expr, was: str, now: str) -> None:
        """An operator stands between its operands, perhaps with parentheses and comments."""
        start, end = self.span(left)[1], self.span(right)[0]
        at = self.source.find(was.encode(), start, end)
        if at >= 0:
            self.put(at, at + len(was), now, left.end_lineno or left.lineno)

    # What is changed

    def visit_Compare(self, node: ast.Compare) -> None:
        operands = [node.left, *node.comparators]
        for left, operator, right in zip(operands, node.ops, operands[1:], strict=False):
            self.between(left, right, _SPELLED[type(operator)], _COMPARED[type(operator)])
        for operand in operands:
            if not (isinstance(operand, ast.Constant) and operand.value is None):
                self.visit(operand)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        if new := _COUNTED.get(type(node.op)):
            self.between(node.left, node.right, _SPELLED[type(node.op)], new)
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        if new := _COUNTED.get(type(node.op)):
            self.between(node.target, node.value, f"{_SPELLED[type(node.op)]}=", f"{new}=")
            self.between(node.target, node.value, f"{_SPELLED[type(node.op)]}=", "=")
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        was, now = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in zip(node.values, node.values[1:], strict=False):
            self.between(left, right, was, now)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.Not | ast.USub):
            self.instead(node, f"({self.text(node.operand)})")
        self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        self.turned(node.test)
        self.generic_visit(node)

    def visit_While(self, node: ast.While) -> None:
        self.turned(node.test)
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self.turned(node.test)
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        for test in node.ifs:
            self.turned(test)
        self.generic_visit(node)

    def turned(self, test: ast.expr) -> None:
        """Not where the operator alone is the condition: it has mutants of its own."""
        if not isinstance(test, ast.UnaryOp) and not (isinstance(test, ast.Compare) and len(test.ops) == 1):
            self.instead(test, f"(not ({self.text(test)}))")

    def visit_Constant(self, node: ast.Constant) -> None:
        match node.value:
            case bool():
                self.instead(node, str(not node.value))
            case int() | float():
                self.instead(node, str(node.value + 1))
            case str():
                self.instead(node, repr(f"XX{node.value}XX"))
            case None:
                self.instead(node, "''")

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """What it consists of has no places of its own before Python 3.12."""
        self.instead(node, "'XX'")

    def visit_Return(self, node: ast.Return) -> None:
        if node.value and not (isinstance(node.value, ast.Constant) and node.value.value is None):
            self.instead(node.value, "None")
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        if not isinstance(node.value, ast.Constant):
            self.instead(node.value, "None")
        self.visit(node.value)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_Call(self, node: ast.Call) -> None:
        called = node.func.id if isinstance(node.func, ast.Name) else ""
        arguments = node.args + [keyword.value for keyword in node.keywords]
        if called in _FOR_TYPES:
            for argument in node.args[called == "cast" :][:1]:
                self.visit(argument)
            return
        for argument in arguments:
            if not isinstance(argument, ast.Starred) and not (
                isinstance(argument, ast.Constant) and not argument.value
            ):
                self.instead(argument, "None")
        for number, keyword in enumerate(node.keywords):
            if keyword.arg:
                self.without(keyword.value, f"{keyword.arg}=", is_last=number == len(node.keywords) - 1)
        if not node.keywords and len(node.args) > 1:
            self.put(self.span(node.args[-2])[1], self.span(node.args[-1])[1], "", node.args[-1].lineno)
        self.generic_visit(node)

    def without(self, value: ast.expr, before: str, *, is_last: bool) -> None:
        start, end = self.span(value)
        start = self.source.rfind(before.encode(), 0, start)
        comma = self.source.find(b",", end)
        self.put(start, end if is_last else comma + 1, "", value.lineno)

    def visit_Break(self, node: ast.Break) -> None:
        start = self.starts[node.lineno - 1] + node.col_offset
        self.put(start, start + len("break"), "continue", node.lineno)

    def visit_Continue(self, node: ast.Continue) -> None:
        start = self.starts[node.lineno - 1] + node.col_offset
        self.put(start, start + len("continue"), "break", node.lineno)

    # What is left alone

    def visit_Assert(self, node: ast.Assert) -> None:
        """It is for types."""

    def visit_Expr(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):  # a docstring
            self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for statement in node.body:
            self.visit(statement)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        for statement in node.body:
            self.visit(statement)

    def visit_match_case(self, node: ast.match_case) -> None:
        if node.guard:
            self.turned(node.guard)
            self.visit(node.guard)
        for statement in node.body:
            self.visit(statement)


_SPELLED = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=", ast.Is: "is",
    ast.IsNot: "is not", ast.In: "in", ast.NotIn: "not in", ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
    ast.FloorDiv: "//", ast.Mod: "%", ast.Pow: "**", ast.BitAnd: "&", ast.BitOr: "|",
}  # fmt: skip
