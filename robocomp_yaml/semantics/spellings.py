# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""How properties spell parameters: by their paths, or as a table says."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

_PLACEHOLDER = r"\{([A-Za-z0-9_][A-Za-z0-9_-]*)\}"
_TOML = r"(?:Endpoints|Period|Agent)\.|Proxies\.(?!.*Prefix$)"


@dataclass(frozen=True)
class Spelling:
    """How properties spell a parameter. A plain value has just `key`. For rows, `key` has holes: `{i}`, a row's number
    from `first` on, or members' names; `columns` say what a row holds, and `count` is the property that counts them.
    With `fields`, each member has a property of its own. `separators` are for lists in one property."""

    key: str = ""
    fields: tuple[tuple[str, str], ...] = ()
    first: int = 0
    columns: tuple[str, ...] = ()
    separator: str = ","
    separators: tuple[str, ...] = ()
    trailing: bool = False
    count: str = ""


def placeholders(key: str) -> tuple[str, ...]:
    """The holes of a property's name: `i` of `JointMotor.M{i}`, `from` and `to` of `ID:{from}-{to}`."""
    return tuple(re.findall(_PLACEHOLDER, key))


def filled(key: str, values: Mapping[str, str]) -> str:
    """The name with those holes filled that there are values for."""
    return re.sub(_PLACEHOLDER, lambda hole: values.get(hole[1], hole[0]), key)


def pattern(key: str) -> re.Pattern[str]:
    """Reads the holes back; each as short as the rest allows, a number where it is the row's."""
    out, at = "", 0
    for hole in re.finditer(_PLACEHOLDER, key):
        out += re.escape(key[at : hole.start()]) + ("([0-9]+)" if hole[1] == "i" else "(.+?)")
        at = hole.end()
    return re.compile(out + re.escape(key[at:]) + r"\Z", re.DOTALL)


def quotes_texts(keys: Iterable[str]) -> bool:
    """Whether a file with these keys has its texts in quotes, as TOML wants them."""
    return any(re.match(_TOML, key) for key in keys)
