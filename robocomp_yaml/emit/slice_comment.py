"""Doc comments of Slice: `/** … */`, as slice2cpp, slice2py and doxygen read them.

The text goes through a preprocessor whose line buffer is fixed (it dies of a longer line), and ends up in Python
docstrings and C++ comments; what would harm there is written so that it reads the same and harms nobody.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable

WIDTH = 110
LONGEST_WORD = 8_000  # characters; the preprocessor's buffer has 65,536 bytes

_HANG = re.compile(r" *(?:[-*+] +|[0-9]+[.)] +)?")  # below what the lines of a paragraph or list item start
_HARMFUL = re.compile('[\x00-\x09\x0b-\x1f\x7f-\x9f\ud800-\udfff]|\\*/|/\\*|\\\\|"""')
_CONTROL = "[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]"


def comment(doc: str, indent: str = "", *, unit: str = "", tags: Iterable[tuple[str, str]] = ()) -> list[str]:
    """The lines of a doc comment; none when there is nothing to say. `tags` are such as ('@param speed', 'How fast.');
    a tag without text is left out."""
    tags = [tag for tag in tags if tag[1]]
    if not (doc or unit or tags):
        return []
    lines = _body(_with_unit(doc, unit), WIDTH - len(indent) - 3)
    tagged = [line for tag, text in tags for line in _tag(tag, text, WIDTH - len(indent) - 3)]
    if not lines and not tagged:
        return []
    if len(lines) == 1 and not tagged and len(indent) + len(lines[0]) + 7 <= WIDTH:
        return [f"{indent}/** {lines[0]} */"]
    between = [""] if lines and tagged else []
    return [f"{indent}/**", *(f"{indent} * {line}".rstrip() for line in (*lines, *between, *tagged)), f"{indent} */"]


def described(doc: str, unit: str) -> str:
    """A doc with its unit, as one paragraph."""
    if not (doc or unit):
        return ""
    return " ".join(_with_unit(doc, unit).split())


def _with_unit(doc: str, unit: str) -> str:
    if not unit:
        return doc
    said = doc.rstrip()
    if said and said[-1].isalnum():
        said += "."
    return f"{said} Unit: {unit}.".strip()


def _body(doc: str, width: int) -> list[str]:
    lines: list[str] = []
    for line in _harmless(doc).strip("\n").split("\n"):
        lines += _wrapped(line.rstrip(), width, " " * len(_HANG.match(line)[0]))  # type: ignore[index]
    return lines if any(lines) else []


def _tag(tag: str, text: str, width: int) -> list[str]:
    return _wrapped(f"{tag} {_harmless(' '.join(text.split()))}", width, "  ")


def _wrapped(line: str, width: int, indent: str) -> list[str]:
    if len(line) <= width:
        return [_closed(line)]
    cut = re.sub(rf"\S{{{LONGEST_WORD}}}(?=\S)", r"\g<0> ", line)
    wrapped = textwrap.wrap(
        cut, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False, drop_whitespace=True
    )
    return [_closed(piece) for piece in wrapped]


def _closed(line: str) -> str:
    """A backslash at a line's end would join it to the next one."""
    return f"{line}." if line.endswith("\\") else line


def _harmless(doc: str) -> str:
    if not _HARMFUL.search(doc):
        return doc
    plain = re.sub(_CONTROL, "", doc.replace("\r\n", "\n").replace("\t", "    "))
    plain = plain.replace("*/", "* /").replace("/*", "/ *").replace('"""', "'''")
    return plain.replace("\\", "\\\\")
