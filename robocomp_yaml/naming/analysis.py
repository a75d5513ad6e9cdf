"""The names of an analysis, with those in mock scripts, which are no part of the program."""

from __future__ import annotations

from robocomp_yaml.naming.names import Names
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Node, parse


def names_of(analysis: Analysis) -> Names:
    trees: dict[str, Node | None] = {one.path: one.tree for one in analysis.documents.values()}
    for path in analysis.discovered.scripts:
        raw, _ = analysis.disk.read(path)
        text = decode(path, raw)[0] if raw is not None else None
        if text is not None:
            trees[path] = parse(path, text)[0]
    return Names(analysis.program, trees)
