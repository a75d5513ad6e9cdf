"""What an expression of Python surely is, by its form: a list, a text, a mapping, or at least no mapping."""

from __future__ import annotations

import ast
from collections.abc import Callable

from robocomp_yaml.emit.usage.code import MAPPING, NOTHING

_NUMBER, _TEXT, _NO_MAPPING = "a number", "a text", "no mapping"
_FORMS = {
    ast.List: "a list", ast.ListComp: "a list", ast.Tuple: "a tuple", ast.Set: "a set", ast.SetComp: "a set",
    ast.Dict: MAPPING, ast.DictComp: MAPPING, ast.JoinedStr: _TEXT, ast.Lambda: "a function",
    ast.GeneratorExp: "a generator", ast.Compare: _NO_MAPPING,
}  # fmt: skip
_BUILTINS = {"float": _NUMBER, "int": _NUMBER, "len": _NUMBER, "str": _TEXT, "repr": _TEXT, "list": "a list",
             "tuple": "a tuple", "set": "a set", "dict": MAPPING, "bool": "true or false"}  # fmt: skip
_MODULES = {"math": ("frexp", "modf"), "random": ("choices", "sample", "Random", "SystemRandom", "choice", "getstate")}
"""Modules whose functions return numbers, and those that do not."""
_DEPTH = 8


def form_of(node: ast.expr, bound: Callable[[str], ast.expr | None], is_builtin: Callable[[str], bool]) -> str:
    """What an expression is, in words; '' if that is not sure. `bound` is the only value of a variable."""
    for _ in range(_DEPTH):
        if isinstance(node, ast.NamedExpr):
            node = node.value
        elif isinstance(node, ast.Name) and (value := bound(node.id)) is not None:
            node = value
        else:
            break
    match node:
        case ast.Constant(value=bool()):
            return "true or false"
        case ast.Constant(value=int() | float()) | ast.UnaryOp(operand=ast.Constant(value=int() | float())):
            return _NUMBER
        case ast.Constant(value=str()):
            return _TEXT
        case ast.Constant(value=None):
            return NOTHING
        case ast.UnaryOp():
            return _NO_MAPPING
        case ast.BinOp(op=ast.BitOr()):
            return ""
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() | ast.FloorDiv(), right=right):
            sides = {form_of(side, bound, is_builtin) for side in (left, right)}
            return _NUMBER if sides == {_NUMBER} else _NO_MAPPING
        case ast.BinOp():
            return _NO_MAPPING
        case ast.Call(func=ast.Name(id=name)) if is_builtin(name):
            return _BUILTINS.get(name, "")
        case ast.Call(func=ast.Attribute(value=ast.Name(id=module), attr=name)):
            return _NUMBER if module in _MODULES and name not in _MODULES[module] else ""
        case _:
            return _FORMS.get(type(node), "")
