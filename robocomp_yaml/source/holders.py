"""Where an unknown key belongs: below a known key whose value is a mapping of free names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

_ALTERNATIVES = ("anyOf", "oneOf", "allOf", "then", "else")


def holder_of(whole: Mapping[str, Any], around: Mapping[str, Any], value: object) -> str:
    """The known key of a mapping below which an entry with this value belongs; '' if none, or several alike. `around`
    is the mapping's part of the schema `whole`. An entry belongs where most of its own keys are known."""
    if not isinstance(value, Mapping):
        return ""
    scores = {
        key: len(value.keys() & _keys_of_entries(whole, part)) for key, part in around.get("properties", {}).items()
        if any(True for _ in _entries(whole, part))
    }  # fmt: skip
    best = [key for key, score in scores.items() if score == max(scores.values()) and (score or len(scores) == 1)]
    return best[0] if len(best) == 1 else ""


def _keys_of_entries(whole: Mapping[str, Any], part: Any) -> set[str]:
    return {
        key for entry in _entries(whole, part) for one in _alternatives(whole, entry)
        for key in one.get("properties", {})
    }  # fmt: skip


def _entries(whole: Mapping[str, Any], part: Any) -> Iterator[Any]:
    """The schemas of the entries with free names."""
    for one in _alternatives(whole, part):
        if isinstance(one.get("additionalProperties"), Mapping):
            yield one["additionalProperties"]
        yield from (entry for name, entry in one.get("patternProperties", {}).items() if not name.startswith("^x-"))


def _alternatives(whole: Mapping[str, Any], part: Any) -> Iterator[Mapping[str, Any]]:
    if not isinstance(part, Mapping):
        return
    if "$ref" in part:
        yield from _alternatives(whole, whole["definitions"][part["$ref"].rpartition("/")[2]])
    yield part
    for keyword in _ALTERNATIVES:
        parts = part.get(keyword, ())
        for one in parts if isinstance(parts, list) else (parts,):
            yield from _alternatives(whole, one)
