"""The merge of `etc/config`: the properties that a component needs, each with its comment."""

from __future__ import annotations

import re

from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.semantics import connections
from robocomp_yaml.source import properties

_NEEDED = (
    r"(?P<topic>.+)Topic\.Endpoints|(?P<adapter>.+)\.Endpoints|(?P<proxy>.+)Proxy|(?P<manager>TopicManager)\.Proxy"
)


def is_config(path: str) -> bool:
    return path == CONFIG


def missing(base: str | None, yours: str, new: str) -> list[str]:
    """The keys without which the component does not start: those that it did not need before, and that the file has in
    no spelling. Empty if `base`, the file as it was written, is unknown."""
    if base is None:
        return []
    known = {*_keys(yours), *_keys(base)}
    return [key for key in _keys(new) if not known & {key, *spellings(key)} and re.fullmatch(_NEEDED, key)]


def paste(new: str, keys: list[str]) -> str:
    """The lines of these properties, with the comments above them."""
    lines = new.split("\n")
    parts: list[str] = []
    for entry in properties.read(new).entries:
        if entry.key in keys:
            first = entry.line - 1
            while first and lines[first - 1].startswith("#"):
                first -= 1
            parts += lines[first : entry.line]
    return "".join(f"{line}\n" for line in parts)


def merge(base: str | None, yours: str, new: str) -> str:
    """The user's file, with missing properties added at its end. Other differences are default ports and addresses,
    which do not replace those in use."""
    keys = missing(base, yours, new)
    if not keys:
        return yours
    ended = yours if not yours or yours.endswith("\n") else f"{yours}\n"
    return f"{ended}\n{paste(new, keys)}"


def _keys(text: str) -> dict[str, str]:
    return dict(properties.read(text).values)


def spellings(key: str) -> set[str]:
    """The other names under which the run time looks a property up."""
    match = re.fullmatch(_NEEDED, key)
    if match is None:
        return set()
    if match["manager"]:
        return {*connections.MANAGER} - {key}
    names = {"topic": connections.topic_endpoints, "adapter": connections.endpoints, "proxy": connections.proxy}
    return {name for what, of in names.items() if match[what] for name in of(match[what])} - {key}
