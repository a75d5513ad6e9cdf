"""Convert TOML configs to settings. The configs of a component become documents together."""

from __future__ import annotations

import tomllib

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import ConfigDraft, Reader
from robocomp_yaml.legacy.grammar import trees
from robocomp_yaml.legacy.settings import entries
from robocomp_yaml.legacy.settings.entries import BOOL, STRING, TOML, ConfigSettings, Item, Leaf, Setting

_Path = tuple[str, ...]


def convert(reader: Reader) -> ConfigDraft | None:
    """Return the settings of a file, by their full paths."""
    tree = toml_tree(reader)
    return None if tree is None else _TomlConverter(reader).draft(tree)


def toml_tree(reader: Reader) -> Tree[Token] | None:
    """Return the tree of a file; None, with a diagnostic, where it is not valid TOML."""
    try:
        tomllib.loads(reader.source.text)  # the grammar does not check all: repeated keys, for example
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        at = reader.source.span(0, 1)
        reader.diagnostics.append(codes.SYNTAX.at(at, problem=f"this is not valid TOML: {error}", hint=""))
        return None
    return reader.tree


class _TomlConverter:
    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.settings = ConfigSettings(TOML)
        self.arrays: dict[_Path, Setting] = {}
        self.pending: list[str] = []

    def draft(self, tree: Tree[Token]) -> ConfigDraft:
        table: _Path = ()
        row: dict[str, Item] | None = None
        for node in trees(tree):
            if node.data in ("table", "tables"):
                table, row = self.path(trees(node, "key")[0]), None
                notes = self.reader.notes(node)
                self.pending += [*notes.head, *notes.tail, *notes.foot]
                if node.data == "tables":
                    row = self.row(node, table)
                continue
            path = self.path(trees(node, "key")[0])
            notes = self.reader.notes(node)
            if self.pending:
                notes.head[:0], self.pending = self.pending, []
            value = self.value(trees(node)[1])
            if row is not None:
                self.put(row, path, Item(value, notes))
                continue
            for full, leaf in self.flat((*table, *path), value):
                self.settings.settings.append(Setting(".".join(full), full, leaf, self.reader.span(node), notes))
                notes = Notes()
        self.reader.placed.around.foot[:0] = self.pending
        entries.assign_head_comments(self.settings, self.reader.placed.around)
        return ConfigDraft(self.settings, self.reader.placed.around)

    def flat(self, path: _Path, value: entries.Tree) -> list[tuple[_Path, entries.Tree]]:
        """Return the plain values and lists of a value: an inline table is equivalent to a table."""
        if not isinstance(value, dict):
            return [(path, value)]
        return [leaf for name, item in value.items() for leaf in self.flat((*path, name), item.value)]

    def row(self, node: Tree[Token], path: _Path) -> dict[str, Item]:
        """Add a table to an array of tables, and return it."""
        setting = self.arrays.get(path)
        if setting is None:
            setting = Setting(".".join(path), path, [], self.reader.span(node), Notes())
            self.arrays[path] = setting
            self.settings.settings.append(setting)
        body: dict[str, Item] = {}
        assert isinstance(setting.value, list)
        setting.value.append(Item(body, Notes(head=self.pending)))
        self.pending = []
        return body

    def put(self, row: dict[str, Item], path: _Path, item: Item) -> None:
        for part in path[:-1]:
            inner = row.setdefault(part, Item({})).value
            assert isinstance(inner, dict)
            row = inner
        row[path[-1]] = item

    def path(self, key: Tree[Token]) -> _Path:
        return tuple(text(str(part)) if part.type == "QUOTED_KEY" else str(part)
                     for part in key.children if isinstance(part, Token))  # fmt: skip

    def value(self, node: Tree[Token]) -> entries.Tree:
        if node.data == "array":
            return [Item(self.value(trees(item)[0]), self.reader.notes(item)) for item in trees(node, "item")]
        if node.data == "inline":
            body: dict[str, Item] = {}
            for pair in trees(node, "pair"):
                self.put(body, self.path(trees(pair, "key")[0]), Item(self.value(trees(pair)[1])))
            return body
        lexeme = str(node.children[0])
        match str(node.data):
            case "text":
                return Leaf(text(lexeme), STRING)
            case "boolean":
                return Leaf(lexeme, BOOL)
            case "number":
                return _number(lexeme)
            case other:
                self.reader.repaired(other, node, lexeme)
                return Leaf(lexeme, STRING)


def text(lexeme: str) -> str:
    """Return the value of a text in quotes."""
    return str(tomllib.loads(f"x = {lexeme}")["x"])


def _number(lexeme: str) -> Leaf:
    """Return a number as it is spelled, where YAML reads the same number."""
    data = tomllib.loads(f"x = {lexeme}")["x"]
    if isinstance(data, int):
        return Leaf(str(data), entries.whole(data))
    plain = lexeme.replace("_", "")
    return Leaf(plain, entries.guess(plain).kind)
