"""Slips in the user's code in Python that need no chain: a name without `self.`, a method without `self`, a method that
is named and not called, and names that the generated modules lack."""

from __future__ import annotations

import ast
import builtins
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import preorder
from robocomp_yaml.emit.usage.code import (
    NO_INIT,
    NO_METHOD,
    NO_RESULT,
    NO_SELF,
    NOT_CALLED,
    NOT_GENERATED,
    REPEATED,
    UNDEFINED,
    VALUE,
    WITHOUT_SELF,
    Slip,
    Word,
)
from robocomp_yaml.languages.python.syntax import names_of
from robocomp_yaml.languages.python.usage_methods import endless_functions, form_instead, returns_nothing

GENERATED = frozenset("component genericworker interfaces parameters runtime statemachine".split())
_OF_WORKER = frozenset(("GenericWorker",))
_OF_MODULES = frozenset("__file__ __path__ __class__ __builtins__ __annotations__ _ reveal_type WindowsError".split())
_Function = (ast.FunctionDef, ast.AsyncFunctionDef)


def slips(
    path: str, text: str, tree: ast.Module, workers: Collection[str], attributes: Collection[str],
    methods: Mapping[str, Collection[str]], modules: Collection[str], called: Mapping[str, int],
) -> Iterator[Slip]:  # fmt: skip
    """The slips of a file. `attributes` are those of the worker that no other name can mean, `methods` those of each
    of these, `modules` the Slice modules, and `called` the methods that the generated code calls, with the number of
    results."""
    lines = text.splitlines()

    def at(name: str, node: ast.expr | ast.stmt | ast.alias, end: bool = False) -> Word | None:
        """The word at the beginning of a node, or at its end."""
        row = (node.end_lineno or node.lineno) if end else node.lineno
        line = lines[row - 1] if row <= len(lines) else ""
        byte = ((node.end_col_offset or 0) - len(name.encode())) if end else node.col_offset
        column = len(line.encode()[:byte].decode(errors="replace"))
        start = line.find(name, column)
        return Word(name, Span(path, row, start + 1, row, start + 1 + len(name))) if start >= 0 else None

    yield from _imports(tree, at)
    bound = _bound(tree)
    if bound is not None:
        yield from _undefined(tree, bound, {*modules, *_OF_WORKER}, attributes, at)
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name in workers]
    written = Counter(method.name for class_ in classes for method in class_.body if isinstance(method, _Function))
    endless = endless_functions(tree)
    for class_ in classes:
        seen = dict[str, int]()
        own = _uncalled(class_, written)
        for name, target in _constants(class_):
            if name in called and (word := at(name, target)) is not None:
                yield Slip(NO_METHOD, word, VALUE)
        for method in (node for node in class_.body if isinstance(node, _Function)):
            if not method.decorator_list and seen.setdefault(method.name, method.lineno) != method.lineno:
                if (word := at(method.name, method)) is not None:
                    yield Slip(REPEATED, word, str(seen[method.name]))
            if method.name == "__init__" and "__init__" not in _called(method):
                if (word := at(method.name, method)) is not None:
                    yield Slip(NO_INIT, word)
            if method.name in called and (form := form_instead(method, called[method.name])):
                if (word := at(method.name, method)) is not None:
                    yield Slip(NO_METHOD, word, form)
            elif called.get(method.name) and not method.decorator_list and returns_nothing(method, endless):
                if written[method.name] == 1 and (word := at(method.name, method)) is not None:
                    yield Slip(NO_RESULT, word)
            given = method.args
            if not (given.posonlyargs or given.args or given.vararg or method.decorator_list):
                if (word := at(method.name, method)) is not None:
                    yield Slip(NO_SELF, word)
        for node in ast.walk(class_):
            match node:
                case ast.Name(id=name, ctx=ast.Load()) if (
                    bound is not None and name in attributes and name not in bound
                ):
                    if (word := at(name, node)) is not None:
                        yield Slip(WITHOUT_SELF, word, f"self.{name}")
                case ast.Expr(
                    value=ast.Attribute(value=ast.Attribute(value=ast.Name(id="self"), attr=proxy), attr=name)
                ):
                    if name in methods.get(proxy, ()) and (word := at(name, node.value, end=True)) is not None:
                        yield Slip(NOT_CALLED, word)
                case ast.Expr(value=ast.Attribute(value=ast.Name(id="self"), attr=name)):
                    if name in own and (word := at(name, node.value, end=True)) is not None:
                        yield Slip(NOT_CALLED, word)


def _undefined(
    tree: ast.Module, bound: set[str], imported: Collection[str], attributes: Collection[str],
    at: Callable[..., Word | None],
) -> Iterator[Slip]:  # fmt: skip
    """The names that nothing in a file defines. `imported` are those that the generated code has."""
    known = bound | set(dir(builtins)) | _OF_MODULES | set(attributes)  # a name of the worker is another slip
    seen = set[str]()
    caught = {name for node in ast.walk(tree) if isinstance(node, ast.ExceptHandler) for name in names_of(node.type)}
    if "NameError" in caught:
        return
    owners = set[ast.AST]()  # the names before a dot
    for node in _outside_annotations(tree):
        if isinstance(node, ast.Attribute):
            owners.add(node.value)
        if (
            isinstance(node, ast.Name)
            and isinstance(node.ctx, ast.Load)
            and node.id not in known
            and node.id not in seen
        ):
            if (word := at(node.id, node)) is not None:
                seen.add(node.id)
                meant = _import_of(node.id, imported, is_owner=node in owners)
                yield Slip(UNDEFINED, word, meant, tuple(sorted({*bound, *imported})))


def _import_of(name: str, imported: Collection[str], *, is_owner: bool) -> str:
    """The import that defines a name; '' if it is not sure."""
    if name in imported:
        return f"from generated.{'interfaces' if name not in _OF_WORKER else 'genericworker'} import {name}"
    if is_owner and (name == "Ice" or name in sys.stdlib_module_names):
        return f"import {name}"
    module = next((module for module, names in _KNOWN.items() if name in names.split()), "")
    return f"from {module} import {name}" if module else ""


_KNOWN = {
    "pathlib": "Path", "dataclasses": "dataclass", "enum": "Enum IntEnum", "collections": "deque defaultdict Counter",
    "functools": "partial", "threading": "Thread Lock Event", "time": "sleep monotonic",
    "datetime": "datetime timedelta",
    "math": "sqrt pi sin cos atan2 hypot inf", "typing": "Any Optional", "contextlib": "suppress contextmanager",
}  # fmt: skip
"""Names of the standard library that are rarely anything else."""


def _outside_annotations(tree: ast.Module) -> Iterator[ast.AST]:

    def inner(node: ast.AST) -> Iterable[ast.AST]:
        annotation: ast.AST | None = None
        if isinstance(node, (ast.AnnAssign, ast.arg)):
            annotation = node.annotation
        elif isinstance(node, _Function):
            annotation = node.returns
        return (child for child in ast.iter_child_nodes(node) if child is not annotation)

    return preorder([tree], inner)


def _called(method: ast.AST) -> set[str]:
    """The last words of what a method calls."""
    return {name for node in ast.walk(method) if isinstance(node, ast.Call) for name in names_of(node.func)}


def _uncalled(class_: ast.ClassDef, written: Counter[str]) -> set[str]:
    """The methods of every worker, and those that the class defines once: to name one alone is no call."""
    plain = {method.name for method in class_.body if isinstance(method, _Function) and not method.decorator_list}
    return {name for name in plain if written[name] == 1} | {"getPeriod", "killYourSelf", "mayTake", "setPeriod"}


def _constants(class_: ast.ClassDef) -> Iterator[tuple[str, ast.expr]]:
    """The names to which a class binds literals."""
    for node in class_.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name) as target], value=ast.Constant()):
                yield name, target


def _imports(tree: ast.Module, at: Callable[..., Word | None]) -> Iterator[Slip]:
    """Imports of what the generated modules lack."""
    for node in tree.body:
        if not isinstance(node, ast.ImportFrom) or node.level or not node.module:
            continue
        package, _, module = node.module.partition(".")
        if package != "generated" or "." in module:
            continue
        if module and module not in GENERATED and (word := at(module, node)) is not None:
            yield Slip(NOT_GENERATED, word, known=tuple(sorted(GENERATED)))
        elif module == "genericworker":
            for alias in node.names:
                if alias.name.lower().startswith("generic") and alias.name not in _OF_WORKER:
                    if (word := at(alias.name, alias)) is not None:
                        yield Slip(NOT_GENERATED, word, known=tuple(_OF_WORKER))


def _bound(tree: ast.Module) -> set[str] | None:
    """All names that a file binds anywhere; None if it may bind any."""
    found: set[str] = set()
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name):
                found.add(name)
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
                found.add(name)
            case ast.Import(names=names) | ast.ImportFrom(names=names):
                if any(alias.name == "*" for alias in names):
                    return None
                found.update((alias.asname or alias.name).partition(".")[0] for alias in names)
            case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                found.add(name)
            case ast.MatchMapping(rest=str(name)):
                found.add(name)
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                found.update(names)
            case ast.Name(id="exec" | "eval" | "globals" | "locals" | "vars"):
                return None
    return found
