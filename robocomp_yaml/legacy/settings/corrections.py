"""What the user knows better than a guess: `--names KEY=a,b,c`, and `--rules FILE` for a whole repository."""

from __future__ import annotations

import re
from collections.abc import Sequence

from robocomp_yaml.legacy.settings.plan import Corrections
from robocomp_yaml.parameters.types import BASIC_TYPES
from robocomp_yaml.source.tree import parse

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


class CorrectionError(ValueError):
    """What is wrong with the user's corrections, in words."""


def read_corrections(names: Sequence[str], rules: str | None) -> Corrections:
    """Both together; what `--names` says comes before the file. Raises Wrong, or OSError where it cannot be read."""
    told = _file(rules) if rules is not None else Corrections()
    columns = dict(told.names)
    for text in names:
        key, found, listed = text.partition("=")
        if not found or not key.strip():
            raise CorrectionError(f"--names takes KEY=a,b,c, not '{text}'")
        columns[key.strip()] = _columns(f"--names {key}", [part.strip() for part in listed.split(",")])
    return Corrections(columns, told.types, told.text)


def _file(path: str) -> Corrections:
    with open(path, encoding="utf-8") as file:
        tree, said = parse(path, file.read())
    data = tree.data if tree is not None and not said else None
    if not isinstance(data, dict):
        raise CorrectionError(
            f"{path} is no YAML mapping of names, types and text" + (f": {said[0].message}" if said else "")
        )
    for key in data:
        if key not in ("names", "types", "text"):
            raise CorrectionError(f"{path} has the key '{key}'; there are names, types and text")
    columns = {key: _columns(f"{path}: {key}", value) for key, value in _mapping(path, data, "names").items()}
    types = {str(key): str(value) for key, value in _mapping(path, data, "types").items()}
    for key, value in types.items():
        if value not in BASIC_TYPES:
            raise CorrectionError(f"{path}: {key} cannot be '{value}'; the types are {', '.join(BASIC_TYPES)}")
    text = data.get("text") or []
    if not isinstance(text, list):
        raise CorrectionError(f"{path}: text is a list of keys")
    return Corrections(columns, types, frozenset(str(key) for key in text))


def _mapping(path: str, data: dict[str, object], key: str) -> dict[str, object]:
    value = data.get(key) or {}
    if not isinstance(value, dict):
        raise CorrectionError(f"{path}: {key} is a mapping of keys")
    return value


def _columns(where: str, value: object) -> list[str]:
    if not isinstance(value, list) or not all(isinstance(name, str) and _NAME.match(name) for name in value):
        raise CorrectionError(f"{where} needs a list of names, of letters, digits and underscores")
    if len(set(value)) < len(value):
        raise CorrectionError(f"{where} has a name twice")
    return [str(name) for name in value]
