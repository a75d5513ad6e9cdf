"""Parses YAML text to a tree of nodes with locations.

libyaml composes the nodes in C. Text that libyaml rejects, because it knows only the syntax of YAML 1.1, is parsed by
ruamel.yaml's own YAML 1.2 parser, which is twenty times slower. Both are imported when the first document is parsed:
most modules only need the types of nodes.
"""

from __future__ import annotations

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.nodes import (
    Base,
    Mapping,
    Node,
    Scalar,
    Sequence,
    below,
    child,
    core,
    end_of,
    found_in,
    last_end,
    mapping_at,
    node_at,
    not_plain,
    once,
    pairs_below,
    scalar_at,
    sequence_at,
    text_at,
    value_at,
    whole,
)

__all__ = [
    "Base", "Mapping", "Node", "Scalar", "Sequence", "below", "child", "core", "end_of", "found_in",
    "last_end", "mapping_at", "node_at", "not_plain", "once", "pairs_below", "parse", "part", "scalar_at",
    "sequence_at", "text_at", "value_at", "whole",
]  # fmt: skip


def parse(path: str, text: str, *, by_libyaml: bool = False) -> tuple[Node | None, list[Diagnostic]]:
    """The tree of a document's text, or None with all errors. Raises Rejected if only libyaml may parse it, and does
    not."""
    from robocomp_yaml.source import composed, syntax

    try:
        root = syntax.compose(path, text, by_libyaml=by_libyaml)
    except syntax.SyntaxFault as fault:
        return None, [fault.diagnostic]
    if root is None:
        return None, [codes.EMPTY.at(Span(path))]
    builder = composed.TreeBuilder(path, text)
    tree = builder.build(root)
    return (None if builder.diagnostics else tree), builder.diagnostics


def part(path: str, text: str, base: Base) -> Mapping | None:
    """The tree of a text that is a part of a document, and begins at `base`; None if it is no mapping without any
    error."""
    from robocomp_yaml.source import composed, syntax

    try:
        root = syntax.compose(path, text)
    except syntax.SyntaxFault:
        return None
    builder = composed.TreeBuilder(path, text, base)
    tree = builder.build(root) if root is not None else None
    return tree if isinstance(tree, Mapping) and not builder.diagnostics else None
