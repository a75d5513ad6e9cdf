"""The content of a legacy config of any format: settings, whose values are trees."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.document import Notes

CLASSIC, FLAT_TOML, TOML = "classic", "flat-toml", "toml"
BOOL, INT, LONG, FLOAT, DOUBLE, STRING = "bool", "int", "long", "float", "double", "string"

MOST_FLOAT, MOST_DOUBLE = 3.4e38, 1.7e308

_INT = re.compile(r"-?(?:0|[1-9][0-9]*)\Z")
_FLOAT = re.compile(r"[+-]?(?:[0-9]+\.[0-9]*|\.[0-9]+|[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
_ZEROS = re.compile(r"[+-]?0[0-9]+\Z")
_BOOL = re.compile(r"(?:true|false|True|False)\Z")


class Leaf(msgspec.Struct, frozen=True):
    """A plain value: its spelling, and the type of this spelling."""

    text: str
    kind: str = STRING


class Item(msgspec.Struct):
    """A value with its comments."""

    value: Tree
    notes: Notes = msgspec.field(default_factory=Notes)


Tree = Leaf | list[Item] | dict[str, Item]


class Setting(msgspec.Struct, frozen=True):
    """One setting. `key` is the property's name, `path` its parts. `raw` is the property's value as Ice reads it, ''
    in TOML; `value` is without quotes."""

    key: str
    path: tuple[str, ...]
    value: Tree
    span: Span
    notes: Notes
    raw: str = ""
    is_quoted: bool = False

    @property
    def text(self) -> str:
        return self.value.text if isinstance(self.value, Leaf) else ""


class ConfigSettings(msgspec.Struct, frozen=True):
    """A config: `settings` in the order of the file, each key once."""

    dialect: str
    settings: list[Setting] = []


def assign_head_comments(settings: ConfigSettings, around: Notes) -> None:
    """Move the comments directly above the first setting from the file to the setting."""
    if settings.settings:
        last = max((at for at, line in enumerate(around.head) if not line), default=-1)
        settings.settings[0].notes.head[:0] = around.head[last + 1 :]
        del around.head[last + 1 :]


def guess(text: str) -> Leaf:
    """Return a plain value of a flat config with the type of its spelling: a number, a boolean, or text."""
    if _BOOL.match(text):
        return Leaf(text, BOOL)
    if _INT.match(text) and text != "-0":
        return Leaf(text, whole(int(text)) if len(text) < 21 else STRING)
    if _FLOAT.match(text) and not _ZEROS.match(text) and abs(float(text)) < MOST_DOUBLE:
        return Leaf(text, FLOAT if abs(float(text)) < MOST_FLOAT else DOUBLE)
    return Leaf(text)


def whole(number: int) -> str:
    """Return the smallest type that can store an integer; STRING where none can."""
    if -(2**31) <= number < 2**31:
        return INT
    return LONG if -(2**63) <= number < 2**63 else STRING
