"""Flat configs to settings; they become documents together with the other configs of their component."""

from __future__ import annotations

import re

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy import flat
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import ConfigDraft, Reader
from robocomp_yaml.legacy.settings.entries import (
    CLASSIC,
    FLAT_TOML,
    STRING,
    Leaf,
    Setting,
    Settings,
    guess,
    settle_head,
)
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source import properties

MAX_KEY = 1000
_CLASSIC_KEY = re.compile(r"\.Endpoints$|Proxy\d*$")
_PROTECTED = re.compile(r'\s*"(?P<value>[^"]*#[^"]*)"\s*(?:#(?P<comment>.*))?$')


def convert(reader: Reader) -> ConfigDraft | None:
    """The settings of a file. Lines that set nothing stay as comments above the next setting."""
    tree = reader.tree
    lines = flat.lines(tree)
    last = properties.last(line.entry for line in lines if line.entry is not None)
    dialect = _dialect(reader, lines)
    found = Settings(dialect)
    around, waiting = reader.placed.around, list[str]()
    for node in lines:
        entry, notes = node.entry, reader.notes(node)
        protected = _protected(node.rest) if dialect == FLAT_TOML and entry is not None else None
        if entry is None:
            reader.repaired("invalid", node)
        elif not entry.value and protected is None:
            reader.repaired("empty", node, entry.key)
        elif reason := properties.unwritable(entry.key, entry.value) or _too_long(entry.key):
            what = reader.rules.losses["unwritable"].format(text=entry.key, reason=reason)
            reader.diagnostics.append(codes.LOST.at(reader.span(node), what=what))
        elif entry.key in last and last[entry.key].line > entry.line:
            reader.repaired("overridden", node, entry.key)
        elif entry.key in last or protected is not None:
            if waiting:
                notes.head[:0] = [line or "" for line in waiting]
                waiting.clear()
            setting = _setting(reader, node, entry, notes, dialect, protected)
            found.settings.append(setting)
            continue
        else:
            reader.repaired("overridden", node, entry.key)
        waiting += [*notes.head, *_as_comment(reader, node, notes)]
    around.foot[:0] = waiting
    settle_head(found, around)
    return ConfigDraft(found, around)


def _too_long(key: str) -> str:
    """Why no YAML document can have such a key, or ''."""
    return f"its name has more than {MAX_KEY} characters" if len(key) > MAX_KEY else ""


def _dialect(reader: Reader, lines: list[flat.LineTree]) -> str:
    """Flat TOML writes the words the other way round: `Endpoints.Laser`."""
    begins = reader.rules.sections["dialect"]
    keys = [line.entry.key for line in lines if line.entry is not None]
    if not any(begins.match(key) for key in keys):
        return CLASSIC
    sure = any(key.startswith(("Endpoints.", "Proxies.")) for key in keys)
    return FLAT_TOML if sure or not any(_CLASSIC_KEY.search(key) for key in keys) else CLASSIC


def _protected(rest: str) -> tuple[str, str] | None:
    """Value and comment of a line whose quotes hold a '#', which flat TOML's reader takes for part of the value. `rest`
    is what stands behind its '='."""
    found = _PROTECTED.match(rest)
    return (found["value"], (found["comment"] or "").strip()) if found else None


def _setting(
    reader: Reader, node: Tree[Token], entry: properties.IceProperty, notes: Notes, dialect: str,
    protected: tuple[str, str] | None,
) -> Setting:  # fmt: skip
    raw, text = entry.value, entry.value
    if protected is not None:
        reader.repaired("protected", node)
        text, notes.tail = protected[0], [protected[1]] if protected[1] else []
        raw = f'"{text}"'
    elif dialect == FLAT_TOML:
        text = unquoted(raw)
        if text == raw and '"' in raw:
            reader.repaired("half_quoted", node, entry.key)
    is_quoted = text != raw
    value = Leaf(text, STRING) if is_quoted else guess(text)
    return Setting(entry.key, tuple(entry.key.split(".")), value, reader.span(node), notes, raw, is_quoted)


def _as_comment(reader: Reader, node: Tree[Token], notes: Notes) -> list[str]:
    """A line that counts for nothing, as the file has it."""
    text = reader.source.text[node.meta.start_pos : node.meta.end_pos].rstrip()
    return ["  # ".join([" ".join(text.split("\t")), *notes.tail]), *notes.foot]
