"""Doc comments of Slice: `/** … */`, as slice2cpp, slice2py and doxygen read them.

A preprocessor with a fixed line buffer reads the text, and aborts at a longer line. The text is copied to Python
docstrings and C++ comments. Character sequences with a meaning there are written in a harmless way.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable

from robocomp_yaml.patterns import pattern

WIDTH = 110
LONGEST_WORD = 8_000  # characters; the preprocessor's buffer has 65,536 bytes

_HANG = pattern(r" *(?:[-*+] +|[0-9]+[.)] +)?")  # the hanging indent of a paragraph or list item
_HARMFUL = pattern('[\x00-\x09\x0b-\x1f\x7f-\x9f\ud800-\udfff]|\\*/|/\\*|\\\\|"""')
_CONTROL = "[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]"


def comment(doc: str, indent: str = "", *, unit: str = "", tags: Iterable[tuple[str, str]] = ()) -> list[str]:
    """The lines of a doc comment; empty if there is no text. `tags` are pairs such as ('@param speed', 'How fast.'); a
    tag without text is omitted."""
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
    """Documentation with a unit, as one paragraph."""
    if not (doc or unit):
        return ""
    return " ".join(_with_unit(doc, unit).split())


def _with_unit(doc: str, unit: str) -> str:
    if not unit:
        return doc
    text = doc.rstrip()
    if text and text[-1].isalnum():
        text += "."
    return f"{text} Unit: {unit}.".strip()


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
    """A line that does not end with a backslash, which would continue it."""
    return f"{line}." if line.endswith("\\") else line


def _harmless(doc: str) -> str:
    if not _HARMFUL.search(doc):
        return doc
    plain = re.sub(_CONTROL, "", doc.replace("\r\n", "\n").replace("\t", "    "))
    plain = plain.replace("*/", "* /").replace("/*", "/ *").replace('"""', "'''")
    return plain.replace("\\", "\\\\")
