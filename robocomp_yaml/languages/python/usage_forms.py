"""What an expression of Python surely is, by its form: a list, a text, a mapping, or at least no mapping."""

from __future__ import annotations

import ast
from collections.abc import Callable

from robocomp_yaml.emit.usage.code import (
    FUNCTION,
    GENERATOR,
    LIST,
    MAPPING,
    NO_MAPPING,
    NOTHING,
    NUMBER,
    SET,
    TEXT,
    TRUTH,
    TUPLE,
)

_FORMS = {
    ast.List: LIST, ast.ListComp: LIST, ast.Tuple: TUPLE, ast.Set: SET, ast.SetComp: SET, ast.Dict: MAPPING,
    ast.DictComp: MAPPING, ast.JoinedStr: TEXT, ast.Lambda: FUNCTION, ast.GeneratorExp: GENERATOR,
    ast.Compare: NO_MAPPING,
}  # fmt: skip
_BUILTINS = {
    "float": NUMBER, "int": NUMBER, "len": NUMBER, "str": TEXT, "repr": TEXT, "list": LIST, "sorted": LIST,
    "tuple": TUPLE, "set": SET, "dict": MAPPING, "bool": TRUTH, "print": NOTHING, "map": GENERATOR,
    "filter": GENERATOR, "zip": GENERATOR, "reversed": GENERATOR, "enumerate": GENERATOR,
}  # fmt: skip
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
            return TRUTH
        case ast.Constant(value=int() | float()) | ast.UnaryOp(operand=ast.Constant(value=int() | float())):
            return NUMBER
        case ast.Constant(value=str()):
            return TEXT
        case ast.Constant(value=None):
            return NOTHING
        case ast.UnaryOp():
            return NO_MAPPING
        case ast.BinOp(op=ast.BitOr()):
            return ""
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() | ast.FloorDiv(), right=right):
            sides = {form_of(side, bound, is_builtin) for side in (left, right)}
            return NUMBER if sides == {NUMBER} else NO_MAPPING
        case ast.BinOp():
            return NO_MAPPING
        case ast.Call(func=ast.Name(id=name)) if is_builtin(name):
            return _BUILTINS.get(name, "")
        case ast.Call(func=ast.Attribute(value=ast.Name(id=module), attr=name)):
            return NUMBER if module in _MODULES and name not in _MODULES[module] else ""
        case _:
            return _FORMS.get(type(node), "")
