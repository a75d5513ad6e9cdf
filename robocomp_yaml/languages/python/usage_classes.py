"""The classes of the user's files in Python: those that are derived from the generic worker, and what all define."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.digraph import preorder

_GENERIC = "GenericWorker"
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
_DYNAMIC = frozenset(("__getattr__", "__getattribute__", "__setattr__"))


class UserClasses(msgspec.Struct, frozen=True):
    """`workers` are the classes that are derived from the generic worker and from nothing unknown, `defined` the
    functions and classes of all files, `own` the names that class bodies define. `is_open`: a class defines how
    attributes are looked up."""

    workers: frozenset[str]
    defined: frozenset[str]
    own: frozenset[str]
    is_open: bool


def classes_of(files: Mapping[str, Sequence[ast.AST]]) -> UserClasses:
    """The classes among the nodes of each file."""
    classes: dict[str, ast.ClassDef] = {}
    defined: set[str] = set()
    twice: set[str] = set()
    for nodes in files.values():
        for node in nodes:
            if isinstance(node, ast.ClassDef):
                twice.update({node.name} & classes.keys())
                classes[node.name] = node
                defined.add(node.name)
            elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                defined.add(node.name)
    own = {name for node in classes.values() for name in _defined_in(node.body)}
    workers = {name for name in classes.keys() - twice if _is_worker(name, classes, set())}
    if _GENERIC in classes:
        workers = set()
    is_open = bool(own & _DYNAMIC) or any(
        classes[name].decorator_list or classes[name].keywords for name in workers
    )  # fmt: skip
    return UserClasses(frozenset(workers), frozenset(defined), frozenset(own), is_open)


def _bases(node: ast.ClassDef) -> list[str]:
    """The last words of the base classes; '' for an expression."""
    return [
        base.id if isinstance(base, ast.Name) else base.attr if isinstance(base, ast.Attribute) else ""
        for base in node.bases
    ]


def _is_worker(name: str, classes: Mapping[str, ast.ClassDef], seen: set[str]) -> bool:
    """Whether a class is derived from the generic worker, and all its bases are known."""
    every = set(_known_bases(name, classes, seen))
    return _GENERIC in every and "" not in every


def _known_bases(name: str, classes: Mapping[str, ast.ClassDef], seen: set[str]) -> Iterator[str]:
    """All bases of a class; '' for one that is unknown."""
    for base in _bases(classes[name]):
        if base in classes and base not in seen:
            seen.add(base)
            yield from _known_bases(base, classes, seen)
        elif base not in classes:
            yield base if base in (_GENERIC, "object", "ABC") else ""


def _defined_in(body: list[ast.stmt]) -> Iterator[str]:
    """The names that a class body binds."""
    for node in preorder(
        list[ast.AST](body), lambda node: () if isinstance(node, _SCOPES) else ast.iter_child_nodes(node)
    ):
        if isinstance(node, _SCOPES):
            yield node.name
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.alias):
            yield (node.asname or node.name).partition(".")[0]
