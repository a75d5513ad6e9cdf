"""What property files say, to compare the user's with a planned one: in the format of Ice, or TOML."""

from __future__ import annotations

from collections.abc import Mapping

from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import properties

_SEPARATOR = pattern(r"\s*([,;])\s*")
_NUMBER = pattern(r"(?<![\w.])[-+]?(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")


def are_alike(path: str, yours: bytes, new: bytes, beside: bytes = b"", *, exactly: bool = False) -> bool:
    """Whether two property files have the same properties. `beside` is the text of a file that programs read before the
    user's. `exactly`: also blanks and the notation of numbers are the same."""
    first, mine, then = (_read(path, data) for data in (beside, yours, new))
    if exactly and any(then[key] != value for key, value in mine.items() if key in then):
        return False
    mine = {**first, **mine}
    return not unlike(mine, then) and not unlike(then, mine)


def unlike(mine: Mapping[str, str], *known: Mapping[str, str]) -> list[str]:
    """The keys of the properties that have another value in each of the known files. For Ice a property without a value
    is not set. Blanks around the separators of rows and lists mean nothing to the programs that read them, nor does the
    notation of a number."""
    return [key for key, value in mine.items() if _meaning(value) not in [_meaning(one.get(key, "")) for one in known]]


def _read(path: str, data: bytes) -> dict[str, str]:
    return read(path, data.decode("utf-8", "replace"))


def read(path: str, text: str) -> dict[str, str]:
    """The properties of a file with this path."""
    from robocomp_yaml.semantics import toml_lines  # its patterns take 2 ms, and most runs read no file

    return toml_lines.properties(text) if path.endswith(toml_lines.SUFFIX) else properties.read(text).values


def _meaning(value: str) -> str:
    return _NUMBER.sub(lambda match: repr(float(match[0])), _SEPARATOR.sub(r"\1", value))
