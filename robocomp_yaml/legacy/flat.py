"""A flat config as a tree: the lines that `source.properties` reads are the constructs that comments belong to."""

from __future__ import annotations

from lark import Token, Tree
from lark.tree import Meta

from robocomp_yaml.legacy.reading import Source
from robocomp_yaml.source import properties
from robocomp_yaml.source.properties import IceProperty, PropertyLine


class LineTree(Tree[Token]):
    """A line that says something: an `entry`, or one that Ice passes over (None). `rest` is all that stands behind its
    `=`, comment and all."""

    def __init__(self, line: PropertyLine, start: int, rest: str) -> None:
        meta = Meta()  # type: ignore[no-untyped-call]
        meta.empty, meta.start_pos, meta.end_pos = False, start, line.stop
        super().__init__("invalid" if line.entry is None else "entry", [], meta)
        self.entry: IceProperty | None = line.entry
        self.rest = rest


def parse(source: Source) -> tuple[Tree[Token], list[Token]]:
    """The tree of a config, and the comments in it."""
    text = source.text
    said: list[LineTree] = []
    comments: list[Token] = []
    for line in properties.read(text).lines:
        if line.entry is not None:
            said.append(LineTree(line, line.start, text[line.entry.at : line.end]))
        elif bare := text[line.start : line.stop].lstrip(" \t\r"):
            said.append(LineTree(line, line.stop - len(bare), ""))
        if line.stop < line.end:
            comment = text[line.stop : line.end]
            comments.append(Token("LINE_COMMENT", comment, start_pos=line.stop, end_pos=line.end))
    return Tree("start", list(said)), comments


def lines(tree: Tree[Token]) -> list[LineTree]:
    return [child for child in tree.children if isinstance(child, LineTree)]
