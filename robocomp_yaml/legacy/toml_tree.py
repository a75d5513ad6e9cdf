"""TOML as a tree with its places: what our grammar has read, once `tomllib` has judged it."""

from __future__ import annotations

import tomllib

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy.draft import Reader


def toml_tree(reader: Reader) -> Tree[Token] | None:
    """The tree of a file; None, with a diagnostic, where it is no TOML."""
    try:
        tomllib.loads(reader.source.text)  # what the grammar does not judge: keys that stand twice
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        at = reader.source.span(0, 1)
        reader.diagnostics.append(codes.SYNTAX.at(at, problem=f"this is no TOML: {error}", hint=""))
        return None
    return reader.tree
