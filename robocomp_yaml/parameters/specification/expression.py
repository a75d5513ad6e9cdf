"""The expressions of `constraints:`: a small language without side effects, parsed into its own tree.

all(m.min < m.max for m in motors) low < high and high <= limits.top device in ["/dev/ttyUSB0", "sim"]

The syntax is a subset of Python's, so Python's parser reads it, and Python never evaluates it. What is not in the
subset is rejected at its location. `expressions.types` has the types of expressions, `expressions.evaluate` their
values.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterator
from keyword import kwlist

from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.model.located import Located

MAX_LENGTH = 2000
MAX_DEPTH = 50
FUNCTIONS = ("len", "min", "max", "abs", "sum", "all", "any", "unique", "has", "keys", "values")
GENERATORS = ("min", "max", "sum", "all", "any", "unique")
_BINARY = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Mod: "%"}
_COMPARE = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=", ast.In: "in",
    ast.NotIn: "not in",
}  # fmt: skip
_TRUTHS = {"true": True, "false": False}
_FOREIGN = (
    (re.compile(r"&&"), "and"),
    (re.compile(r"\|\|"), "or"),
    (re.compile(r"!(?!=)"), "not"),
    (re.compile(r"(?<![=<>!])=(?!=)"), "=="),
)

_RESERVED = re.compile(
    r"\b(?:" + "|".join(sorted(set(kwlist) - {"and", "or", "not", "in", "for", "if", "True", "False"})) + r")\b"
)


class ExpressionError(ValueError):
    """An expression is invalid: the problem, the index of its location, and a hint."""

    def __init__(self, problem: str, index: int = 0, hint: str | Hint = "") -> None:
        super().__init__(problem)
        self.index, self.hint = index, hint


class _Part(Located, frozen=True, kw_only=True):
    """`at` is the index in the text of the character that locates the part."""

    at: int = 0


class LiteralExpression(_Part, frozen=True):
    """A number, a text, true or false."""

    value: bool | int | float | str


class ListExpression(_Part, frozen=True):
    """`[a, b]`, for `in`."""

    items: tuple[Expression, ...]


class NameExpression(_Part, frozen=True):
    """A parameter, a group, or the variable of a `for`."""

    name: str


class Attribute(_Part, frozen=True):
    of: Expression
    name: str


class Index(_Part, frozen=True):
    """An element of a list by its number, or of a map by its key."""

    of: Expression
    index: Expression


class Unary(_Part, frozen=True):
    """`operator` is 'not', '-' or '+'."""

    operator: str
    operand: Expression


class Binary(_Part, frozen=True):
    """`operator` is one of + - * / %. As in Python, `/` returns a fraction, and `%` has the sign of the divisor."""

    operator: str
    left: Expression
    right: Expression


class Compare(_Part, frozen=True):
    """`first < second <= third`: each pair must hold. Operators: < <= > >= == != in 'not in'."""

    first: Expression
    rest: tuple[tuple[str, Expression], ...]


class Logic(_Part, frozen=True):
    """`operator` is 'and' or 'or'."""

    operator: str
    operands: tuple[Expression, ...]


class Each(_Part, frozen=True):
    """`element for variable in source if condition`: the argument of all, any, sum, min, max or unique."""

    source: Expression
    variable: str
    element: Expression
    condition: Expression | None = None


class Call(_Part, frozen=True):
    """`function` is one of FUNCTIONS."""

    function: str
    arguments: tuple[Expression | Each, ...]


Expression = (
    LiteralExpression | ListExpression | NameExpression | Attribute | Index | Unary | Binary | Compare | Logic | Call
)


def parts(expression: Expression | Each) -> Iterator[Expression | Each]:
    """The expressions directly inside an expression, in the order of evaluation."""
    for name in expression.__struct_fields__:
        field = getattr(expression, name)
        for part in field if isinstance(field, tuple) else (field,):
            part = part[1] if isinstance(part, tuple) else part  # of a comparison: the operator comes first
            if isinstance(part, _Part):
                yield part  # type: ignore[misc]


def parse(text: str) -> Expression:
    """The tree of an expression. Raises ExpressionError."""
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"an expression has at most {MAX_LENGTH} characters")
    source = _without_keywords(text.replace("\n", " ").replace("\r", " "))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the parser warns about code that is never run
            tree = ast.parse(source, mode="eval")
        return _ExpressionReader(source).read(tree.body)
    except SyntaxError as error:
        raise _syntax(source, error) from None
    except (RecursionError, MemoryError):
        raise ExpressionError("this expression is nested too deeply") from None
    except ValueError as error:
        if isinstance(error, ExpressionError):
            raise
        raise ExpressionError("this is not an expression") from None


def _syntax(source: str, error: SyntaxError) -> ExpressionError:
    for pattern, word in _FOREIGN:
        found = pattern.search(_without_texts(source))
        if found:
            return ExpressionError(f"'{found[0]}' is not an operator", found.start(), _instead(found[0], word))
    return ExpressionError("this is not an expression", max(0, (error.offset or 1) - 1))


def _without_texts(source: str) -> str:
    return re.sub(r"\"[^\"]*\"|'[^']*'", lambda text: " " * len(text[0]), source)


def _without_keywords(source: str) -> str:
    """The source in which Python's other reserved words are names. Their first letters are bold, so that the parser
    accepts them as names; it normalizes names by NFKC, so that they are plain again. Their length is unchanged."""
    bare = _without_texts(source)
    for word in reversed(list(_RESERVED.finditer(bare))):
        first = word[0][0]
        bold = chr(0x1D41A + ord(first) - ord("a")) if first.islower() else chr(0x1D400 + ord(first) - ord("A"))
        source = source[: word.start()] + bold + source[word.start() + 1 :]
    return source


class _ExpressionReader:
    def __init__(self, source: str) -> None:
        self.source = source
        self._bytes = None if source.isascii() else source.encode()
        self._depth = 0

    def at(self, node: ast.AST, offset: int | None = None) -> int:
        """The index of a node's first character, or of an offset in bytes."""
        if offset is None:
            offset = int(getattr(node, "col_offset", 0))
        return offset if self._bytes is None else len(self._bytes[:offset].decode(errors="ignore"))

    def read(self, node: ast.expr) -> Expression:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise ExpressionError(
                "this expression is nested too deeply", self.at(node), "split it into several constraints"
            )
        read = self._read(node, self.at(node))
        self._depth -= 1
        return read

    def _read(self, node: ast.expr, at: int) -> Expression:
        match node:
            case ast.Constant(value=bool() | int() | float() | str() as value):
                return LiteralExpression(value, at=at)
            case ast.Name(id=name):
                return LiteralExpression(_TRUTHS[name], at=at) if name in _TRUTHS else NameExpression(name, at=at)
            case ast.Attribute(value=of, attr=name):
                return Attribute(self.read(of), name, at=self.at(node, node.end_col_offset) - len(name))
            case ast.Subscript(value=of, slice=index) if not isinstance(index, (ast.Slice, ast.Tuple)):
                return Index(self.read(of), self.read(index), at=at)
            case ast.List(elts=items) | ast.Tuple(elts=items):
                return ListExpression(tuple(self.read(item) for item in items), at=at)
            case ast.UnaryOp(op=ast.Not() | ast.USub() | ast.UAdd() as operator, operand=operand):
                spelled = {ast.Not: "not", ast.USub: "-", ast.UAdd: "+"}[type(operator)]
                return Unary(spelled, self.read(operand), at=at)
            case ast.BinOp(left=left, op=binary, right=right) if type(binary) in _BINARY:
                return Binary(_BINARY[type(binary)], self.read(left), self.read(right), at=at)
            case ast.BoolOp(op=logic, values=operands):
                spelled = "and" if isinstance(logic, ast.And) else "or"
                return Logic(spelled, tuple(self.read(operand) for operand in operands), at=at)
            case ast.Compare(left=first, ops=ops, comparators=others) if all(type(op) in _COMPARE for op in ops):
                rest = zip(ops, others, strict=True)
                return Compare(
                    self.read(first), tuple((_COMPARE[type(op)], self.read(other)) for op, other in rest), at=at
                )
            case ast.Call(func=ast.Name(id=function), args=arguments, keywords=[]):
                return self.call(function, arguments, at)
        raise ExpressionError(
            _unsupported(node),
            at,
            "use comparisons, arithmetic, and, or, not, in, and the functions that docs/pdsl.md lists",
        )

    def call(self, function: str, arguments: list[ast.expr], at: int) -> Call:
        from robocomp_yaml.diag.suggest import did_you_mean

        if function not in FUNCTIONS:
            hint = did_you_mean(function, FUNCTIONS, otherwise=f"there are: {', '.join(FUNCTIONS)}")
            raise ExpressionError(f"unknown function '{function}'", at, hint)
        if not arguments or (len(arguments) > 1 and function not in ("min", "max")):
            raise ExpressionError(f"{function}() needs one argument", at)
        read: list[Expression | Each] = []
        for argument in arguments:
            if isinstance(argument, (ast.GeneratorExp, ast.ListComp)):
                read.append(self.each(function, argument))
            else:
                read.append(self.read(argument))
        if len(read) > 1 and any(isinstance(one, Each) for one in read):
            raise ExpressionError(f"{function}() accepts one 'for', or arguments without 'for'", at)
        return Call(function, tuple(read), at=at)

    def each(self, function: str, node: ast.GeneratorExp | ast.ListComp) -> Each:
        at = self.at(node)
        loop = node.generators[0]
        if function not in GENERATORS:
            raise ExpressionError(f"{function}() does not accept 'for'", at, f"{', '.join(GENERATORS)} do")
        if len(node.generators) > 1 or len(loop.ifs) > 1:
            raise ExpressionError("only one 'for' and one 'if' are supported here", at, "nest a second all() or any()")
        if not isinstance(loop.target, ast.Name):
            raise ExpressionError("'for' needs one variable", self.at(loop.target))
        condition = self.read(loop.ifs[0]) if loop.ifs else None
        element = self.read(node.elt)
        return Each(self.read(loop.iter), loop.target.id, element, condition, at=at)


def _instead(found: str, word: str) -> Hint:
    return Hint(f"write '{word}'", found, f"{word} " if found == "!" else word, safe=True)


def _unsupported(node: ast.expr) -> str:
    match node:
        case ast.BinOp(op=ast.Pow()):
            return "powers are not supported"
        case ast.BinOp(op=ast.FloorDiv()):
            return "'//' is not supported"
        case ast.Compare():
            return "'is' is not supported"
        case ast.Constant():
            return "this value is not supported"
        case ast.Call():
            return "only the functions of constraints can be called"
        case ast.GeneratorExp() | ast.ListComp():
            return "'for' is supported only inside all(), any(), sum(), min(), max() and unique()"
        case ast.IfExp():
            return "'if … else' is not supported"
        case ast.Subscript():
            return "only one element of a list or map can be selected"
        case _:
            return "this is not supported in a constraint"
