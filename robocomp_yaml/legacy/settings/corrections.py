"""The user's corrections of guesses: `--names KEY=a,b,c`, and `--rules FILE` for a whole repository."""

from __future__ import annotations

import re
from collections.abc import Sequence

from robocomp_yaml.legacy.settings.plan import Corrections
from robocomp_yaml.parameters.types import BASIC_TYPES
from robocomp_yaml.source.tree import parse

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


class CorrectionError(ValueError):
    """The user's corrections are not valid. The text is the message for the user."""


def read_corrections(names: Sequence[str], rules: str | None) -> Corrections:
    """Return the corrections of `--names` and of the file `rules`; `--names` has priority.

    Raises CorrectionError if one is not valid, OSError or UnicodeDecodeError if the file cannot be read.
    """
    from_file = _file(rules) if rules is not None else Corrections()
    columns = dict(from_file.names)
    for text in names:
        key, separator, listed = text.partition("=")
        if not separator or not key.strip():
            raise CorrectionError(f"--names requires KEY=a,b,c, not '{text}'")
        columns[key.strip()] = _columns(f"--names {key}", [part.strip() for part in listed.split(",")])
    return Corrections(columns, from_file.types, from_file.text)


def _file(path: str) -> Corrections:
    with open(path, encoding="utf-8") as file:
        tree, diagnostics = parse(path, file.read())
    data = tree.data if tree is not None and not diagnostics else None
    if not isinstance(data, dict):
        reason = f": {diagnostics[0].message}" if diagnostics else ""
        raise CorrectionError(f"{path} is not a YAML mapping with the keys names, types and text{reason}")
    for key in data:
        if key not in ("names", "types", "text"):
            raise CorrectionError(f"{path} has the unknown key '{key}'; the keys are names, types and text")
    columns = {key: _columns(f"{path}: {key}", value) for key, value in _mapping(path, data, "names").items()}
    types = {str(key): str(value) for key, value in _mapping(path, data, "types").items()}
    for key, value in types.items():
        if value not in BASIC_TYPES:
            raise CorrectionError(
                f"{path}: {key} cannot have the type '{value}'; the types are {', '.join(BASIC_TYPES)}"
            )
    text = data.get("text") or []
    if not isinstance(text, list):
        raise CorrectionError(f"{path}: text must be a list of keys")
    return Corrections(columns, types, frozenset(str(key) for key in text))


def _mapping(path: str, data: dict[str, object], key: str) -> dict[str, object]:
    value = data.get(key) or {}
    if not isinstance(value, dict):
        raise CorrectionError(f"{path}: {key} must be a mapping of keys")
    return value


def _columns(location: str, value: object) -> list[str]:
    if not isinstance(value, list) or not all(isinstance(name, str) and _NAME.match(name) for name in value):
        raise CorrectionError(f"{location} must be a list of names, which consist of letters, digits and underscores")
    if len(set(value)) < len(value):
        raise CorrectionError(f"{location} has the same name twice")
    return [str(name) for name in value]
