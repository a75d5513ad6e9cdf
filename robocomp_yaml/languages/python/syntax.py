"""Python's syntax trees: names, parameters and literals."""

from __future__ import annotations

import ast
from collections.abc import Iterable


def parameters_of(given: ast.arguments | None) -> list[ast.arg]:
    if given is None:
        return []
    more = [one for one in (given.vararg, given.kwarg) if one is not None]
    return [*given.posonlyargs, *given.args, *given.kwonlyargs, *more]


def plain_parameters(given: ast.arguments | None) -> list[ast.arg]:
    """The parameters that get one argument each."""
    return [] if given is None else [*given.posonlyargs, *given.args, *given.kwonlyargs]


def annotations_of(node: ast.FunctionDef | ast.AsyncFunctionDef) -> list[ast.expr]:
    found = [argument.annotation for argument in parameters_of(node.args)]
    return [one for one in (*found, node.returns) if one is not None]


def names_of(node: ast.expr | None) -> list[str]:
    """The last words of the names in a name, a call or a tuple of them."""
    match node:
        case ast.Name(id=name):
            return [name]
        case ast.Attribute(attr=name):
            return [name]
        case ast.Call(func=function):
            return names_of(function)
        case ast.Tuple(elts=elements):
            return all_names(elements)
        case _:
            return []


def all_names(nodes: Iterable[ast.expr]) -> list[str]:
    return [name for node in nodes for name in names_of(node)]


def constant(node: ast.expr) -> bool | int | float | str | None:
    """A literal number, text or truth value; None for any other expression."""
    match node:
        case ast.Constant(value=bool() | int() | float() | str() as value):
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
            return -value
        case _:
            return None


def imports_all(node: ast.AST, modules: Iterable[str]) -> bool:
    return isinstance(node, ast.ImportFrom) and (node.module or "") in modules and node.names[0].name == "*"


def unpacked_count(targets: list[ast.expr]) -> int:
    """The number of variables to which a value is unpacked; 0 if it is not, or if it may be any."""
    for target in targets:
        if isinstance(target, (ast.Tuple, ast.List)):
            return 0 if any(isinstance(one, ast.Starred) for one in target.elts) else len(target.elts)
    return 0
