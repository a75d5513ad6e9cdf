"""Parses the specific class in C++: a header with declarations, and definitions in any file."""

from __future__ import annotations

import re
from collections.abc import Iterator

import tree_sitter_cpp
from msgspec.structs import replace
from tree_sitter import Node, Tree

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
    words,
)
from robocomp_yaml.languages.cpp.signature_types import SignatureTypes as SignatureTypes

_PARAMETERS = ("parameter_declaration", "optional_parameter_declaration")
# Qt's additions to C++, which the grammar does not have, are replaced by blanks of the same length.
_QT = re.compile(rb"\bQ_OBJECT\b|\bQ_SLOTS\b|(?<=[a-z])(\s+)slots\b(?=\s*:)|\bsignals\b(?=\s*:)|\bQ_SIGNALS\b(?=\s*:)")


def parse(source: str) -> Tree:
    """The syntax tree of a file, at the same positions."""
    return parser(tree_sitter_cpp.language).parse(_QT.sub(_replacement, source.encode()))


def read(path: str, source: str) -> SourceCode:
    root = parse(source).root_node
    lines = lines_of(source)
    imports, import_end = [], 0
    for node in _at_top(root):
        if node.type == "preproc_include":
            line = " ".join(text(node).split())
            imports.append(ImportLine(line.partition("include")[2].strip(), f"{line}\n"))
            import_end = node.start_point[0] + 1
    definitions = tuple(_definitions(root, lines))
    class_ = next(_classes(root), None)
    if class_ is None:
        return SourceCode(path, lines, faults(root), (), definitions, tuple(imports), import_end)
    body = class_.child_by_field_name("body")
    assert body is not None
    clause = next((node for node in class_.children if node.type == "base_class_clause"), None)
    bases = [text(node) for node in clause.named_children if node.type != "access_specifier"] if clause else []
    return SourceCode(
        path, lines, faults(root), tuple(_members(body, lines)), definitions, tuple(imports), import_end,
        location(field(class_, "name"), lines), body.end_point[0], bases=tuple(bases),
    )  # fmt: skip


def _at_top(root: Node) -> Iterator[Node]:
    """The nodes at the top of a file, or in its include guard."""
    for node in root.children:
        yield from node.children if node.type == "preproc_ifdef" and text(node.children[0]) == "#ifndef" else (node,)


def compiles(code: SourceCode) -> bool:
    """Always true: the syntax tree already has all faults."""
    return True


def _replacement(found: re.Match[bytes]) -> bytes:
    word = b"public" if found[0].endswith(b"ignals") or found[0] == b"Q_SIGNALS" else b""
    return word.ljust(len(found[0])) if b"\n" not in found[0] else found[0]


def _is_condition(node: Node) -> bool:
    return node.type.startswith(("preproc_if", "preproc_el"))


def _is_scope(node: Node) -> bool:
    return _is_condition(node) or node.type in ("namespace_definition", "declaration_list", "declaration")


def _classes(root: Node) -> Iterator[Node]:
    for node, _ in below(root, _is_scope):
        if node.type in ("class_specifier", "struct_specifier"):
            if node.child_by_field_name("body") and text(field(node, "name")) == CLASS:
                yield node


def _members(body: Node, lines: list[str]) -> Iterator[SourceMethod]:
    for node, nested in below(body, _is_condition):
        if node.type in ("field_declaration", "function_definition", "declaration"):
            if found := _method(node, lines, nested, has_body=node.type == "function_definition"):
                yield found


def _definitions(root: Node, lines: list[str]) -> Iterator[SourceMethod]:
    for node, nested in below(root, _is_scope):
        found = _method(node, lines, nested) if node.type == "function_definition" else None
        if found and found.name.startswith(f"{CLASS}::"):
            yield replace(found, name=found.name.removeprefix(f"{CLASS}::"))


def _method(node: Node, lines: list[str], nested: bool, *, has_body: bool = True) -> SourceMethod | None:
    """The function that a declaration declares; None if it declares something else."""
    declarator, around = node.child_by_field_name("declarator"), ""
    while declarator is not None and declarator.type in ("reference_declarator", "pointer_declarator"):
        around += declarator.children[0].type
        declarator = declarator.named_children[-1]
    if declarator is None or declarator.type != "function_declarator":
        return None
    name = declarator.child_by_field_name("declarator")
    if name is None or name.type not in ("field_identifier", "qualified_identifier", "identifier"):
        return None
    first = node.start_point[0]
    while first and lines[first - 1].lstrip().startswith("///"):
        first -= 1
    parameters = field(declarator, "parameters")
    typed = [child for child in parameters.children if child.type in _PARAMETERS]
    optional = sum(child.type.startswith("optional") for child in typed)
    trailing = next((child for child in declarator.children if child.type == "trailing_return_type"), None)
    returns = plain(trailing).removeprefix("-> ") if trailing else plain(node.child_by_field_name("type")) + around
    last = name
    while (inner := last.child_by_field_name("name")) is not None:
        last = inner
    signature = Signature(
        tuple(_type(child) for child in typed),
        tuple(_name(child) for child in typed),
        returns,
        len(typed) - optional,
        len(typed),
    )
    whole = "".join(text(name).split())
    return SourceMethod(whole, location(last, lines), first, node.end_point[0] + 1, signature, has_body, nested)


def _type(parameter: Node) -> str:
    """A parameter's type without its name and default."""
    default = parameter.child_by_field_name("default_value")
    unnamed = words(parameter, (_identifier(parameter), default))
    return " ".join(word for word in unnamed if word != "=")


def _name(parameter: Node) -> str:
    name = _identifier(parameter)
    return text(name) if name else ""


def _identifier(parameter: Node) -> Node | None:
    node = parameter.child_by_field_name("declarator")
    while node is not None and node.type != "identifier":
        node = node.named_children[-1] if node.named_children else None
    return node
