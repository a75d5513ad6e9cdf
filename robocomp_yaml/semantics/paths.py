# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Paths of values: `motors[0].vel` for people, `motors.0.vel` for properties and command lines."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Union

Step = Union[str, int]
Path = tuple[Step, ...]

_PLAIN = r"[A-Za-z0-9_-]+\Z"
_STEP = r"\[(?:(\d{1,9})|\"((?:[^\"\\]|\\.)*)\"|'([^']*)')\]|\.?([^.\[\]]+)"
_ESCAPE = r"%([0-9A-Fa-f]{2})"


def in_words(steps: Iterable[Step]) -> str:
    """`motors[0].vel`, `offsets["a b"]`."""
    out = ""
    for step in steps:
        if isinstance(step, int):
            out += f"[{step}]"
        elif re.match(_PLAIN, step):
            out += f".{step}" if out else step
        else:
            quoted = step.replace("\\", "\\\\").replace('"', '\\"')
            out += f'["{quoted}"]'
    return out


def dotted(steps: Iterable[Step]) -> str:
    """`motors.0.vel`."""
    return ".".join(str(step) if isinstance(step, int) else escaped(step) for step in steps)


def parse(text: str) -> list[str]:
    """The steps of a path in either spelling, all as text; an empty list if the text is not a path."""
    steps: list[str] = []
    at = 0
    while at < len(text):
        found = re.compile(_STEP).match(text, at)
        if found is None or (found[4] is not None and (text[at] == ".") != bool(steps)):
            return []
        number, double, single, name = found.groups()
        if name is not None:
            steps.append(unescaped(name))
        elif number is not None:
            steps.append(number)
        else:
            steps.append(single if double is None else re.sub(r"\\(.)", r"\1", double))
        at = found.end()
    return steps


def escaped(key: str) -> str:
    """A map's key as a segment of a property's name: dots, blanks, `=`, `%` and unprintable characters as `%2E`.

    The empty key is a single `%`. The first letter of the key `keys` is escaped, because `keys` is the list of keys.
    """
    if not key:
        return "%"
    if key == "keys":
        return "%6Beys"
    return "".join(
        char
        if char.isprintable() and not char.isspace() and char not in ".=%\ufeff"
        else "".join(f"%{byte:02X}" for byte in char.encode("utf-8", "surrogatepass"))
        for char in key
    )


def unescaped(segment: str) -> str:
    """The key that a segment spells. Text that is not an escape is unchanged."""
    if segment == "%":
        return ""
    if "%" not in segment:
        return segment
    raw = bytearray()
    at = 0
    for found in re.finditer(_ESCAPE, segment):
        raw += segment[at : found.start()].encode("utf-8", "surrogatepass")
        raw.append(int(found[1], 16))
        at = found.end()
    raw += segment[at:].encode("utf-8", "surrogatepass")
    return raw.decode("utf-8", "replace")
