"""A missing blank after the colon of a key in a block. YAML reads `speed:2` as text, and reports what follows from it,
often in another line."""

from __future__ import annotations

from collections.abc import Sequence

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit, Fix
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern

# The blanks before a key, the key, and its value, which is no part of an address (`http://`) or of a path (`C:\\x`).
_ENTRY = pattern(r"([ ]*(?:- +)*)([A-Za-z_][\w.-]*):([^\s:/\\][^#]*)")
_PORT = pattern(r"\s*- .*:[0-9]+\s*")
_LONGEST = 40


def in_lines(path: str, lines: Sequence[str], at: int) -> Diagnostic | None:
    """The fault, if it is in the line with the index `at`, or in the one above, to which YAML adds this line's text."""
    for index in (at, _above(lines, at)):
        if 0 <= index < len(lines) and not _continues(lines, index):
            found = in_line(path, lines[index], index + 1)
            if found is not None:
                return found
    return None


def in_line(path: str, line: str, number: int) -> Diagnostic | None:
    """The fault, if the line of this number begins with a key without a blank after its colon."""
    entry = _ENTRY.match(line)
    if entry is None or _PORT.fullmatch(line):
        return None
    before, key, value = entry.groups()
    start, value = len(before) + 1, value.rstrip()
    end = start + len(key) + 1 + len(value)
    after = Span(path, number, start + len(key) + 1, number, start + len(key) + 1)
    return codes.KEY_COLON.at(
        Span(path, number, start, number, end),
        key=_short(f"{key}:{value}"),
        hint=f"write '{_short(f'{key}: {value}')}'",
        fixes=[Fix("insert a blank after the colon", (Edit(after, " "),), True)],
    )


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _is_content(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _above(lines: Sequence[str], at: int) -> int:
    """The index of the nearest line above with content; -1 if there is none."""
    return next((index for index in range(min(at, len(lines)) - 1, -1, -1) if _is_content(lines[index])), -1)


def _continues(lines: Sequence[str], at: int) -> bool:
    """Whether a line continues the text of a line above, which is less indented."""
    above = _above(lines, at)
    if above < 0 or _indentation(lines[above]) >= _indentation(lines[at]):
        return False
    return not lines[above].split(" #")[0].rstrip().endswith((":", "-"))


def _indentation(line: str) -> int:
    return len(line) - len(line.lstrip(" "))
