"""Parses the specific class in Java."""

from __future__ import annotations

import re
from collections.abc import Iterator

import tree_sitter_java
from tree_sitter import Node, Tree

from robocomp_yaml.emit.specific.code import (
    CLASS,
    ImportLine,
    Signature,
    SourceCode,
    SourceMethod,
    faults,
    field,
    lines_of,
    location,
    parser,
    text,
)
from robocomp_yaml.languages.java.signature_types import SignatureTypes as SignatureTypes

COMMENTS = ("line_comment", "block_comment")
_TOKEN = re.compile(r"\w+|\.\.\.|\S")


def parse(source: str) -> Tree:
    return parser(tree_sitter_java.language).parse(source.encode())


def read(path: str, source: str) -> SourceCode:
    root, lines = parse(source).root_node, lines_of(source)
    imports, import_end = [], 0
    for node in root.children:
        if node.type in ("import_declaration", "package_declaration"):
            import_end = node.end_point[0] + 1
        if node.type == "import_declaration":
            line = " ".join(text(node).split())
            imports.append(ImportLine(line.removeprefix("import ").rstrip(" ;"), f"{line}\n"))
    classes = (node for node in root.children if node.type == "class_declaration")
    class_ = next((node for node in classes if text(field(node, "name")) == CLASS), None)
    if class_ is None:
        return SourceCode(path, lines, faults(root), imports=tuple(imports), import_end=import_end)
    body, above = field(class_, "body"), class_.child_by_field_name("superclass")
    bases = tuple(text(node).rpartition(".")[2] for node in above.named_children) if above else ()
    members = tuple(_method(node, lines) for node in body.children if node.type == "method_declaration")
    return SourceCode(
        path, lines, faults(root), members, (), tuple(imports), import_end, location(field(class_, "name"), lines),
        body.end_point[0], bases=bases,
    )  # fmt: skip


def compiles(code: SourceCode) -> bool:
    """Always true: the syntax tree already has all faults."""
    return True


def _method(node: Node, lines: list[str]) -> SourceMethod:
    name, first = field(node, "name"), node.start_point[0]
    last = node.prev_sibling
    while last is not None and last.type in COMMENTS and last.end_point[0] + 1 >= first > last.start_point[0]:
        if not lines[last.start_point[0]].lstrip().startswith(("/**", "///")):
            break
        first, last = last.start_point[0], last.prev_sibling
    parameters = [one for one in field(node, "parameters").named_children if one.type.endswith("formal_parameter")]
    spread = any(one.type == "spread_parameter" for one in field(node, "parameters").named_children)
    signature = Signature(
        tuple(" ".join(_words(field(one, "type"))) + _dimensions(one) for one in parameters),
        tuple(text(field(one, "name")) for one in parameters),
        " ".join(_words(field(node, "type"))) + _dimensions(node),
        len(parameters),
        None if spread else len(parameters),
    )
    return SourceMethod(
        text(name), location(name, lines), first, node.end_point[0] + 1, signature,
        has_body=node.child_by_field_name("body") is not None,
    )  # fmt: skip


def _dimensions(node: Node) -> str:
    """The brackets behind a name, as in `int a[]`."""
    found = node.child_by_field_name("dimensions")
    return f" {' '.join(_words(found))}" if found is not None else ""


def _words(node: Node) -> Iterator[str]:
    yield from _TOKEN.findall(re.sub(r"/\*.*?\*/|//[^\n]*|@\w+(?:\([^)]*\))?", " ", text(node), flags=re.DOTALL))
