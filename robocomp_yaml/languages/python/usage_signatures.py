"""The arguments of the user's own functions, methods and classes in Python, as far as they are sure."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping

from robocomp_yaml.digraph import preorder
from robocomp_yaml.emit.usage.offer import OfferedMember

_Function = (ast.FunctionDef, ast.AsyncFunctionDef)
_Callable = ast.FunctionDef | ast.AsyncFunctionDef
_STATIC, _OF_CLASS = "staticmethod", "classmethod"


def methods(trees: Mapping[str, ast.Module]) -> dict[str, OfferedMember]:
    """The methods that only one class in all files defines, once and without unknown decorators."""
    found: dict[str, OfferedMember] = {}
    counts: Counter[str] = Counter()
    for tree in trees.values():
        for class_ in (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)):
            for name, method in _defined(class_.body):
                counts[name] += 1
                if isinstance(method, _Function) and (made := _method(method)) is not None:
                    found[name] = made
    return {name: one for name, one in found.items() if counts[name] == 1}


def functions(tree: ast.Module) -> dict[str, OfferedMember]:
    """The functions and classes that a file defines once, at its top level."""
    counts = Counter(name for name, _ in _defined(tree.body))
    counts.update(_rebound(tree))
    found: dict[str, OfferedMember] = {}
    for node in tree.body:
        if isinstance(node, _Function) and not node.decorator_list:
            made = _signature(node, 0)
        elif isinstance(node, ast.ClassDef):
            made = _of_class(node)
        else:
            continue
        if made is not None and counts[node.name] == 1:
            found[node.name] = made
    return found


def results(tree: ast.Module) -> dict[str, ast.expr]:
    """The annotations of the results of methods, by their names."""
    return {
        method.name: method.returns
        for class_ in tree.body if isinstance(class_, ast.ClassDef)
        for method in class_.body
        if isinstance(method, ast.FunctionDef) and method.returns is not None and not method.decorator_list
    }  # fmt: skip


def _defined(body: list[ast.stmt]) -> Iterator[tuple[str, ast.AST]]:
    """The names that the statements of a scope bind, each with what binds it."""

    def inner(node: ast.AST) -> Iterator[ast.AST]:
        return iter(()) if isinstance(node, (*_Function, ast.ClassDef, ast.Lambda)) else ast.iter_child_nodes(node)

    for node in preorder(list[ast.AST](body), inner):
        if isinstance(node, (*_Function, ast.ClassDef)):
            yield node.name, node
        elif isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            yield node.id, node
        elif isinstance(node, ast.alias):
            yield (node.asname or node.name).partition(".")[0], node


def _rebound(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Global):
            yield from node.names


def _method(node: _Callable) -> OfferedMember | None:
    decorators = [one.id if isinstance(one, ast.Name) else "" for one in node.decorator_list]
    if decorators == [_STATIC]:
        return _signature(node, 0)
    return _signature(node, 1) if decorators in ([], [_OF_CLASS]) else None


def _of_class(node: ast.ClassDef) -> OfferedMember | None:
    """How a class is called; None if it is not sure: it has bases, or makes its values in another way."""
    if node.bases or node.keywords or node.decorator_list:
        return None
    own = list(_defined(node.body))
    makers = [one for name, one in own if name == "__init__"]
    if len(makers) > 1 or any(name == "__new__" for name, _ in own):
        return None
    if not makers:
        return OfferedMember(least=0, most=0, keywords=frozenset(), signature=f"{node.name}()")
    maker = makers[0]
    is_plain = isinstance(maker, _Function) and not maker.decorator_list
    return _signature(maker, 1, node.name) if is_plain and isinstance(maker, _Function) else None


def _signature(node: _Callable, first: int, name: str = "") -> OfferedMember | None:
    """The arguments of a call; the first ones are passed by Python itself."""
    given = node.args
    positional = [*given.posonlyargs, *given.args]
    if given.vararg or given.kwarg or len(positional) < first:
        return None
    optional = len(given.defaults) + sum(one is not None for one in given.kw_defaults)
    every = [one.arg for one in (*positional[first:], *given.kwonlyargs)]
    by_name = [one.arg for one in (*given.args, *given.kwonlyargs) if one.arg in every]
    if any(one.startswith("__") for one in every):
        return None  # mangled
    return OfferedMember(
        least=max(0, len(every) - optional), most=len(every), keywords=frozenset(by_name),
        signature=f"{name or node.name}({', '.join(every)})",
    )  # fmt: skip
