# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""How properties spell parameters: by their paths, or by a table."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

_PLACEHOLDER = r"\{([A-Za-z0-9_][A-Za-z0-9_-]*)\}"
_TOML = r"(?:Endpoints|Period|Agent)\.|Proxies\.(?!.*Prefix$)"


@dataclass(frozen=True)
class Spelling:
    """How properties spell a parameter. A plain value has only `key`. For rows, `key` has placeholders: `{i}`, the
    number of a row, starting at `first`, or names of members. `columns` are the members in a row, and `count` is the
    property with the number of rows. With `fields`, each member has its own property. `separators` are for lists in one
    property."""

    key: str = ""
    fields: tuple[tuple[str, str], ...] = ()
    first: int = 0
    columns: tuple[str, ...] = ()
    separator: str = ","
    separators: tuple[str, ...] = ()
    trailing: bool = False
    count: str = ""


def placeholders(key: str) -> tuple[str, ...]:
    """The placeholders of a property's name: `i` of `JointMotor.M{i}`, `from` and `to` of `ID:{from}-{to}`."""
    return tuple(re.findall(_PLACEHOLDER, key))


def filled(key: str, values: Mapping[str, str]) -> str:
    """The name with values in place of the placeholders that have one."""
    return re.sub(_PLACEHOLDER, lambda found: values.get(found[1], found[0]), key)


def pattern(key: str) -> re.Pattern[str]:
    """A pattern that reads the placeholders back: `{i}` as a number, the others as short as possible."""
    out, at = "", 0
    for found in re.finditer(_PLACEHOLDER, key):
        out += re.escape(key[at : found.start()]) + ("([0-9]+)" if found[1] == "i" else "(.+?)")
        at = found.end()
    return re.compile(out + re.escape(key[at:]) + r"\Z", re.DOTALL)


def quotes_texts(keys: Iterable[str]) -> bool:
    """Whether a file with these keys has its texts in quotes, as TOML requires."""
    return any(re.match(_TOML, key) for key in keys)
