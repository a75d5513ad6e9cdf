"""Parses the pages of diagnostics, `docs/diagnostics/NAME.md`: messages, reasons and examples of all codes.

A page is read when the first of its diagnostics is made. The heading of a code is followed by these parts, in this
order:

    ## RC0102                          its id
    *error*                            its severity
    ```message                         the message: a format string for the facts
    ```says                            if the message is only a fact: all possible messages, one on each line
    Some prose.                        the reason
    Wrong, for `rcyaml check *`:       files for which that command (by default `check .`) reports the code
    Right:                             files for which it does not
    Both beside:                       files that are added to both examples

A file is a fence with its path in the first line: ```` ```yaml Speech.idsl.yaml ````, in quotes if it has blanks. After
the path there may be `-> TARGET` (a link), `absent` (this file of "Beside the examples" is not added), `escaped`
(`\\xNN` is a byte), `unended` (the last line has no end) and `×N` (the text between « and » is repeated N times). A
path that ends in a slash is an empty folder. Files under "Beside the examples" are added to all examples of a page.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.patterns import pattern

COMMAND = "check ."
_ENTRY = pattern(r"^## ([A-Z]{2,}\d{3,4})\n\n\*(\w+)\*\n", re.MULTILINE)
_SHARED = pattern(r"^## Beside the examples\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
_FENCE = pattern(r'^```(\w+)(?: ("[^"]+"|\S+)(?: ([^\n]+))?)?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
_SECTION = pattern(r"^(Wrong|Right|Both beside)(?:, for `rcyaml ([^`]+)`)?:$", re.MULTILINE)
_ESCAPE = pattern(rb"\\(x[0-9a-f]{2}|\\)")


class Repeated(msgspec.Struct, frozen=True):
    """A long text that is made only when it is used."""

    before: str
    text: str
    times: int
    after: str

    def __str__(self) -> str:
        return self.before + self.text * self.times + self.after


Files = Mapping[str, str | bytes | Repeated | None]
"""Contents by paths: text, bytes if it is not text, None for an empty folder, "-> target" for a link."""


class PageEntry(msgspec.Struct, frozen=True):
    """The section of a page about one code."""

    says: tuple[str, ...]
    why: str
    wrong: Files
    right: Files
    command: str


class Page(msgspec.Struct, frozen=True):
    """A page whose severities and messages are parsed; entries are parsed on demand."""

    severities: Mapping[str, str]
    messages: Mapping[str, str]
    _texts: Mapping[str, str]
    _shared: str

    def entry(self, id_: str) -> PageEntry:
        """The entry of a code. Raises KeyError if the code is unknown, and ValueError if the page is malformed."""
        prose, *parts = _SECTION.split(self._texts[id_])
        sections = {name: _files(text) for name, text in zip(parts[::3], parts[2::3], strict=True)}
        if [*sections] not in (["Wrong", "Right"], ["Wrong", "Right", "Both beside"]):
            raise ValueError(f"{id_}: its examples are not 'Wrong', 'Right' and perhaps 'Both beside'")
        fences = {kind: body for kind, _, _, body in _FENCE.findall(prose)}
        beside = {**_files(self._shared), **sections.get("Both beside", {})}
        return PageEntry(
            tuple(fences.get("says", "").splitlines()),
            "\n\n".join(" ".join(each.split("\n")) for each in _FENCE.sub("", prose).strip().split("\n\n")),
            _tree(sections["Wrong"], beside), _tree(sections["Right"], beside), parts[1] or COMMAND,
        )  # fmt: skip


@cache
def page(name: str) -> Page:
    """The page of this name, or the page with this text, of a plug-in. Raises ValueError if it is malformed."""
    text = name if "\n" in name else resources.text(f"diagnostics/{name}.md")
    matches = list(_ENTRY.finditer(text))
    ends = [*(match.start() for match in matches[1:]), len(text)]
    texts = {match[1]: text[match.end() : end] for match, end in zip(matches, ends, strict=True)}
    shared = _SHARED.search(text, 0, matches[0].start()) if matches else None
    return Page(
        {match[1]: match[2] for match in matches}, {id_: _message(id_, part) for id_, part in texts.items()}, texts,
        shared[1] if shared else "",
    )  # fmt: skip


def _message(id_: str, text: str) -> str:
    head, fence, rest = text.partition("```message\n")
    if not fence or head.strip():
        raise ValueError(f"{id_}: the message is missing after the severity")
    return rest.partition("\n```")[0]


class _Absent:
    """Marks a file that is not added to an example."""


def _files(text: str) -> dict[str, str | bytes | Repeated | _Absent | None]:
    return {
        path.strip('"').rstrip("/"): _content(path, rest, body) for _, path, rest, body in _FENCE.findall(text) if path
    }


def _content(path: str, rest: str, body: str) -> str | bytes | Repeated | _Absent | None:
    if path.endswith("/"):
        return None
    if rest.startswith("-> "):
        return rest
    words = rest.split()
    if "absent" in words:
        return _Absent()
    if "unended" in words:
        body = body.removesuffix("\n")
    for word in words:
        if word.startswith("×"):
            before, text, after = re.split("[«»]", body)
            return Repeated(before, text, int(word[1:]), after)
    if "escaped" not in words:
        return body
    raw = _ESCAPE.sub(lambda match: bytes.fromhex(match[1][1:].decode()) or b"\\", body.encode())
    try:
        return raw.decode()
    except UnicodeDecodeError:
        return raw


def _tree(
    own: dict[str, str | bytes | Repeated | _Absent | None], beside: dict[str, str | bytes | Repeated | _Absent | None]
) -> Files:
    """The files of an example: its own, and those beside it."""
    files = {**own, **{path: content for path, content in beside.items() if path not in own}}
    return {path: content for path, content in files.items() if not isinstance(content, _Absent)}
