"""A line of a property file as it may be shown: known as an entry of Ice's, or by the words of any other text."""

from __future__ import annotations

from collections.abc import Collection

from robocomp_yaml import secrets
from robocomp_yaml.source import properties


def without_secret(line: str, names: Collection[str] = ()) -> str:
    """A line (without its end) whose value, and what stands behind it, is hidden where its key is secret, or is one of
    `names`."""
    for entry in properties.read(line).entries:
        if secrets.value(entry.key, entry.value, names) == secrets.HIDDEN:
            return f"{line[: entry.at]}{secrets.HIDDEN}"
    return line
