"""Convert flat configs to settings. The configs of a component become documents together."""

from __future__ import annotations

import re

from lark import Token, Tree

from robocomp_yaml.legacy import grammar
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import ConfigDraft, Reader
from robocomp_yaml.legacy.settings import entries
from robocomp_yaml.legacy.settings.entries import CLASSIC, FLAT_TOML, ConfigSettings, Leaf, Setting
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source import properties

MAX_KEY = 1000
_CLASSIC_KEY = re.compile(r"\.Endpoints$|Proxy\d*$")
_PROTECTED = re.compile(r'\s*"(?P<value>[^"]*#[^"]*)"\s*(?:#(?P<comment>.*))?$')


def convert(reader: Reader) -> ConfigDraft | None:
    """Return the settings of a file. Lines that set nothing become comments above the next setting."""
    tree = reader.tree
    lines = [line for line in tree.children if isinstance(line, grammar.LineTree)]
    last = properties.last(line.entry for line in lines if line.entry is not None)
    dialect = _dialect(reader, lines)
    settings = ConfigSettings(dialect)
    around, pending = reader.placed.around, list[str]()
    for node in lines:
        entry, notes = node.entry, reader.notes(node)
        protected = _protected(node.rest) if dialect == FLAT_TOML and entry is not None else None
        if entry is None:
            reader.repaired("invalid", node)
        elif not entry.value and protected is None:
            reader.repaired("empty", node, entry.key)
        elif reason := properties.unwritable(entry.key, entry.value) or _too_long(entry.key):
            reader.lost("unwritable", node, entry.key, reason=reason)
        elif entry.key in last and last[entry.key].line > entry.line:
            reader.repaired("overridden", node, entry.key)
        elif entry.key in last or protected is not None:
            if pending:
                notes.head[:0] = [line or "" for line in pending]
                pending.clear()
            setting = _setting(reader, node, entry, notes, dialect, protected)
            settings.settings.append(setting)
            continue
        else:
            reader.repaired("overridden", node, entry.key)
        pending += [*notes.head, *_as_comment(reader, node, notes)]
    around.foot[:0] = pending
    entries.assign_head_comments(settings, around)
    return ConfigDraft(settings, around)


def _too_long(key: str) -> str:
    """Why no YAML document can have such a key, or ''."""
    return f"its name has more than {MAX_KEY} characters" if len(key) > MAX_KEY else ""


def _dialect(reader: Reader, lines: list[grammar.LineTree]) -> str:
    """Return the dialect of a config. Flat TOML reverses the parts of keys: `Endpoints.Laser`."""
    begins = reader.rules.sections["dialect"]
    keys = [line.entry.key for line in lines if line.entry is not None]
    if not any(begins.match(key) for key in keys):
        return CLASSIC
    sure = any(key.startswith(("Endpoints.", "Proxies.")) for key in keys)
    return FLAT_TOML if sure or not any(_CLASSIC_KEY.search(key) for key in keys) else CLASSIC


def _protected(rest: str) -> tuple[str, str] | None:
    """Return value and comment of a line with a '#' in quotes, which is part of the value in flat TOML; None for other
    lines. `rest` is the text after its '='."""
    match = _PROTECTED.match(rest)
    return (match["value"], (match["comment"] or "").strip()) if match else None


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
    value = Leaf(text, entries.STRING) if is_quoted else entries.guess(text)
    return Setting(entry.key, tuple(entry.key.split(".")), value, reader.span(node), notes, raw, is_quoted)


def _as_comment(reader: Reader, node: Tree[Token], notes: Notes) -> list[str]:
    """Return a line that sets nothing as comments, in the spelling of the file."""
    text = reader.source.text[node.meta.start_pos : node.meta.end_pos].rstrip()
    return ["  # ".join([" ".join(text.split("\t")), *notes.tail]), *notes.foot]
