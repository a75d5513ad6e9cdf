"""Parses the specific class in Python."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator

import tree_sitter_python
from msgspec.structs import replace
from tree_sitter import Node

from robocomp_yaml.digraph import preorder
from robocomp_yaml.emit.specific.code import (
    CLASS,
    ImportLine,
    Signature,
    SourceCode,
    SourceMethod,
    below,
    faults,
    field,
    lines_of,
    location,
    parser,
    plain,
    text,
)
from robocomp_yaml.languages.python.signature_types import SignatureTypes as SignatureTypes


def read(path: str, source: str) -> SourceCode:
    root = parser(tree_sitter_python.language).parse(source.encode()).root_node
    lines = lines_of(source)
    code = _read(path, root, lines)
    older = _python_2(root) if not compiles(code) else None
    return replace(code, older=location(older, lines)) if older is not None else code


def _python_2(root: Node) -> Node | None:
    """The first word of a statement that only Python 2 has."""
    every = preorder([root], lambda node: node.children)
    return next((node.children[0] for node in every if node.type in ("print_statement", "exec_statement")), None)


def _read(path: str, root: Node, lines: list[str]) -> SourceCode:
    imports = list(_imports(root))
    tops = [node for node in root.children if node.type.startswith(("import", "future_import"))]
    import_end = tops[-1].end_point[0] + 1 if tops else _behind_docstring(root)
    found = next((node for node in _classes(root) if text(field(node, "name")) == CLASS), None)
    if found is None:
        return SourceCode(path, lines, faults(root), imports=tuple(imports), import_end=import_end)
    body = field(found, "body")
    members = tuple(_members(body, lines))
    bases = found.child_by_field_name("superclasses")
    return SourceCode(
        path, lines, faults(root), members, (), tuple(imports), import_end,
        location(field(found, "name"), lines),
        _last_line(body),
        _indent(body, lines) or "    ",
        tuple(text(base) for base in bases.named_children) if bases else (),
    )  # fmt: skip


def compiles(code: SourceCode) -> bool:
    """Whether Python compiles it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile("".join(code.lines), code.path, "exec", dont_inherit=True)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


def _is_condition(node: Node) -> bool:
    """Whether a node contains statements that may or may not be executed."""
    return node.type in ("if_statement", "try_statement", "with_statement", "block") or node.type.endswith("_clause")


def _classes(root: Node) -> Iterator[Node]:
    """The classes of the module, also those in conditional statements."""
    for node, _ in below(root, _is_condition):
        inner = field(node, "definition") if node.type == "decorated_definition" else node
        if inner.type == "class_definition":
            yield inner


def _members(body: Node, lines: list[str]) -> Iterator[SourceMethod]:
    for node, nested in below(body, _is_condition):
        inner = field(node, "definition") if node.type == "decorated_definition" else node
        if inner.type == "function_definition":
            name = field(inner, "name")
            first = _with_comments(node.start_point[0], lines)
            yield SourceMethod(
                text(name), location(name, lines), first, _last_line(node), _signature(inner), nested=nested
            )
        elif node.type == "expression_statement":
            yield from _assigned(node, lines)


def _assigned(statement: Node, lines: list[str]) -> Iterator[SourceMethod]:
    """`name = something` in the class."""
    for node in statement.children:
        name = node.child_by_field_name("left") if node.type == "assignment" else None
        if name is not None and name.type == "identifier":
            row = statement.start_point[0]
            yield SourceMethod(text(name), location(name, lines), row, _last_line(statement), None)


def _signature(function: Node) -> Signature:
    parameters, names, least, most = [], [], 0, 0
    limited, keywords = True, False
    for node in field(function, "parameters").named_children[1:]:  # without self
        word = plain(node)
        if node.type in ("comment", "positional_separator"):
            continue
        if word.startswith("**"):
            continue
        if word.startswith("*"):
            keywords = True
            limited = limited and word == "*"
            continue
        if keywords:
            least += "default" not in node.type  # a servant never passes it
            continue
        parameters.append(word)
        names.append(re.split(r"[ :=]", word, maxsplit=1)[0])
        most += 1
        least += "default" not in node.type
    returns = plain(function.child_by_field_name("return_type"))
    return Signature(tuple(parameters), tuple(names), returns, least, most if limited else None)


def _imports(root: Node) -> Iterator[ImportLine]:
    """The names that come from generated modules."""
    for node in root.children:
        module = node.child_by_field_name("module_name") if node.type == "import_from_statement" else None
        if module is None or not text(module).startswith("generated"):
            continue
        for name in node.children_by_field_name("name"):
            words = plain(name)
            yield ImportLine(f"{text(module)} {words}", f"from {text(module)} import {words}\n")


def _with_comments(row: int, lines: list[str]) -> int:
    """The first of the comment lines directly above a row."""
    while row and lines[row - 1].lstrip().startswith("#"):
        row -= 1
    return row


def _behind_docstring(root: Node) -> int:
    strings = [node for node in root.named_children if node.type != "comment"][:1]
    is_docstring = strings and strings[0].type == "expression_statement" and strings[0].children[0].type == "string"
    return _last_line(strings[0]) if is_docstring else 0


def _last_line(node: Node) -> int:
    """The number of the line after a node."""
    row, column = node.end_point
    return row + 1 if column else row


def _indent(body: Node, lines: list[str]) -> str:
    line = lines[body.start_point[0]]
    return line[: len(line) - len(line.lstrip())]
