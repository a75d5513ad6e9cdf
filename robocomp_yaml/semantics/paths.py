# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Paths of values: `motors[0].vel` for people, `motors.0.vel` for properties and command lines."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Union

Step = Union[str, int]

_PLAIN = re.compile(r"[A-Za-z0-9_-]+\Z")
_STEP = re.compile(r"\[(?:(\d{1,9})|\"((?:[^\"\\]|\\.)*)\"|'([^']*)')\]|\.?([^.\[\]]+)")
_ESCAPE = re.compile(r"%([0-9A-Fa-f]{2})")


def in_words(steps: Iterable[Step]) -> str:
    """`motors[0].vel`, `offsets["a b"]`."""
    out = ""
    for step in steps:
        if isinstance(step, int):
            out += f"[{step}]"
        elif _PLAIN.match(step):
            out += f".{step}" if out else step
        else:
            quoted = step.replace("\\", "\\\\").replace('"', '\\"')
            out += f'["{quoted}"]'
    return out


def dotted(steps: Iterable[Step]) -> str:
    """`motors.0.vel`."""
    return ".".join(str(step) if isinstance(step, int) else escaped(step) for step in steps)


def parse(text: str) -> list[str]:
    """The steps of a path in either spelling, all as text; none for what is no path."""
    steps: list[str] = []
    at = 0
    while at < len(text):
        found = _STEP.match(text, at)
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
    """A map's key as a segment of a property's name: dots, blanks, `=`, `%` and what does not print as `%2E`.

    The empty key is a lone `%`; the key `keys`, which would be mistaken for the list of keys, has its first letter
    escaped.
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
    """The key that a segment spells; what is no escape stands for itself."""
    if segment == "%":
        return ""
    if "%" not in segment:
        return segment
    raw = bytearray()
    at = 0
    for found in _ESCAPE.finditer(segment):
        raw += segment[at : found.start()].encode("utf-8", "surrogatepass")
        raw.append(int(found[1], 16))
        at = found.end()
    raw += segment[at:].encode("utf-8", "surrogatepass")
    return raw.decode("utf-8", "replace")
