"""How a method of Python ends, and whether it is one that the generated code can call."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator

from robocomp_yaml.emit.usage.code import ASYNC, FUNCTION, PROPERTY, STATIC, YIELDS
from robocomp_yaml.languages.python.syntax import names_of
from robocomp_yaml.languages.python.usage_forms import form_of

_Function = (ast.FunctionDef, ast.AsyncFunctionDef)
_Method = ast.FunctionDef | ast.AsyncFunctionDef
_NEVER_RETURN = frozenset("_exit abort execv execve exit fail quit skip".split())
_PROPERTIES = ([["property"]], [["cached_property"]])


def form_instead(method: _Method, results: int) -> str:
    """What a method is, if the generated code cannot call it as it does, for so many results; '' if it can."""
    decorators = [names_of(one) for one in method.decorator_list]
    if decorators == [["staticmethod"]]:
        first = next(iter([*method.args.posonlyargs, *method.args.args]), None)
        return STATIC if first is not None and first.arg == "self" else ""
    if decorators in _PROPERTIES:
        values = [node.value for node in _own(method) if isinstance(node, ast.Return)]
        may_be_called = any(value is not None and _form(value) in ("", FUNCTION) for value in values)
        return PROPERTY if len(method.args.args) > 1 or not may_be_called else ""
    if decorators:
        return ""
    if isinstance(method, ast.AsyncFunctionDef):
        return ASYNC
    # The results of a generator may be unpacked to several.
    return YIELDS if results < 2 and any(isinstance(one, (ast.Yield, ast.YieldFrom)) for one in _own(method)) else ""


def _form(value: ast.expr) -> str:
    return form_of(value, lambda name: None, lambda name: True)


def returns_nothing(method: _Method, endless: Collection[str]) -> bool:
    """Whether a method returns no value anywhere, and surely ends. `endless` are the functions that never return."""
    own = list(_own(method))
    if any(isinstance(node, (ast.Yield, ast.YieldFrom)) for node in own):
        return False
    returned = [node.value for node in own if isinstance(node, ast.Return)]
    return not any(value is not None for value in returned) and (bool(returned) or _goes_on(method.body, endless))


def endless_functions(tree: ast.Module) -> frozenset[str]:
    """The functions that never return: those that always raise something, and the ones of the standard library."""
    functions = [node for node in ast.walk(tree) if isinstance(node, _Function)]
    found = {one.name for one in functions if set(names_of(one.returns)) & {"NoReturn", "Never"}}
    ending = {one.name for one in functions if any(isinstance(node, ast.Return) for node in _own(one))}
    found |= {one.name for one in functions if not _goes_on(one.body, ())} - ending
    return frozenset(found) | _NEVER_RETURN


def _own(method: _Method) -> Iterator[ast.AST]:
    """The nodes of a method, without those of functions in it."""
    todo: list[ast.AST] = list(method.body)
    while todo:
        node = todo.pop()
        if not isinstance(node, (*_Function, ast.ClassDef, ast.Lambda)):
            yield node
            todo += ast.iter_child_nodes(node)


def _goes_on(body: Iterable[ast.stmt], endless: Collection[str]) -> bool:
    """Whether what follows these statements may be executed."""
    return all(_passes(statement, endless) for statement in body)


def _passes(statement: ast.stmt, endless: Collection[str]) -> bool:
    match statement:
        case ast.Raise() | ast.Return() | ast.Break() | ast.Continue():
            return False
        case ast.Expr(value=ast.Call() as call):
            return not set(names_of(call.func)) & set(endless)
        case ast.If(body=body, orelse=orelse):
            return _goes_on(body, endless) or _goes_on(orelse, endless)
        case ast.While(test=ast.Constant(value=value), body=body) if value:
            return any(isinstance(node, ast.Break) for one in body for node in ast.walk(one))
        case ast.Try(body=body, handlers=handlers, orelse=orelse, finalbody=final):
            ways = [[*body, *orelse], *(handler.body for handler in handlers)]
            return _goes_on(final, endless) and any(_goes_on(way, endless) for way in ways)
        case ast.With(body=body) | ast.AsyncWith(body=body):
            return _goes_on(body, endless)
        case ast.Match(cases=cases):
            return any(_goes_on(case.body, endless) for case in cases) or not any(
                isinstance(case.pattern, ast.MatchAs) and case.pattern.pattern is None for case in cases
            )
        case ast.Assert(test=ast.Constant(value=value)):
            return bool(value)
        case _:
            return True
