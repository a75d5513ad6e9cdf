"""What is secret: names that say so, and texts with what nobody should read taken out.

Whatever is shown of a document, a command or a state asks here. Parameters may also say it themselves (`secret: true`):
then their types know it. Which names say it, components decide by the same rule (`semantics.secrecy`).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

from robocomp_yaml.semantics.secrecy import HIDDEN as HIDDEN
from robocomp_yaml.semantics.secrecy import USER_INFO
from robocomp_yaml.semantics.secrecy import is_secret as is_secret
from robocomp_yaml.semantics.secrecy import url as url


class _Pattern:
    """A pattern that is compiled when it is asked for something: most runs meet no secret."""

    def __init__(self, text: str, flags: int = 0) -> None:
        self._given = text, flags

    def __getattr__(self, name: str) -> Any:
        found = getattr(re.compile(*self._given), name)
        setattr(self, name, found)
        return found


_ASSIGNMENT = _Pattern(
    r"(?P<name>(?<![\w.])[^\x00-@\[-^`{-\x7f][\w.\-]{0,60})"
    r"(?P<sign>(?P<close>[\"']?)[ \t]*=[ \t]*|[\"']?[ \t]*:[ \t]+|[\"']:)"
    r"(?P<value>\"(?:[^\"\\]|\\.)*\"?|'[^']*'?|(?:(?:Bearer|Basic|Digest)[ \t]+)?[^\s\"'&;,)}\]]+)"
)
_OPTION = _Pattern(
    r"(?P<name>(?<![\w-])--?[A-Za-z][\w.\-]{0,60})(?P<sign>[ \t]+)"
    r"(?P<value>\"[^\"]*\"?|'[^']*'?|[^\s\"'&;-][^\s\"'&;]*)"
)
_IS_OPTION = _Pattern(r"--?[A-Za-z][\w.\-]*\Z")
_WHOLE = _Pattern(r"((?:--?)?[^\x00-@\[-^`{-\x7f][\w.\-]*)([=:])(?!//)(.+)\Z", re.DOTALL)
# One that can be followed, as far as that is seen: others are what somebody meant to be a secret.
_REFERENCE = _Pattern(
    r"\$\{?[A-Za-z_]|\{ *env *: *([\"']?)[A-Za-z_][A-Za-z0-9_]*\1 *(?:\}|\Z)|\{ *file *: *[^\s\[\]{},]"
)


def masked(text: str) -> str:
    """A text of any kind without the secrets that its own words tell: `user:password@` of URLs, `password=…`,
    `"token": "…"`, `--api-key …`. References to the environment and to files are no secrets."""
    text = url(text)
    if "=" in text or ":" in text:
        text = _ASSIGNMENT.sub(_without_value, text)
    return _OPTION.sub(_without_value, text) if "-" in text else text


def _without_value(found: re.Match[str]) -> str:
    value = found["value"]
    if not is_secret(found["name"]) or _REFERENCE.match(value.strip("\"'")):
        return found[0]
    quote = value[0] if value[0] in "\"'" else ""
    return f"{found['name']}{found['sign']}{quote}{HIDDEN}{quote}"


def is_one_of(name: str, names: Collection[str]) -> bool:
    """Whether a name, or a part of a dotted one, says that it is secret or is one of these."""
    return is_secret(name) or (bool(names) and not {name, *name.lstrip("-").split(".")}.isdisjoint(names))


def value(name: str, text: str, names: Collection[str] = ()) -> str:
    """The value of something by its name."""
    if text and is_one_of(name, names) and not _REFERENCE.match(text):
        return HIDDEN
    return masked(text)


def words(command: Iterable[str], names: Collection[str] = ()) -> Iterator[str]:
    """The words of a command: the value of an option may be the next word."""
    is_value = False
    for word in command:
        option = _IS_OPTION.match(word)
        if is_value and not option:
            yield word if _REFERENCE.match(word) else HIDDEN
            is_value = False
            continue
        is_value = option is not None and is_one_of(word, names)
        found = _WHOLE.match(word)
        if found and is_one_of(found[1], names) and not _REFERENCE.match(found[3]):
            yield f"{found[1]}{found[2]}{HIDDEN}"
        else:
            yield masked(word)


def command(words_: Iterable[str], names: Collection[str] = ()) -> str:
    """A command on one line, for people."""
    return " ".join(words(words_, names))


_SUSPECT = re.compile(
    r"pass|secret|credential|contrase|key|token|pwd|private|bearer|authorization|://[^\s/]*@", re.IGNORECASE
)


def may_hold(text: str) -> bool:
    """Whether a look for secrets is worth its time."""
    return _SUSPECT.search(text) is not None


Part = tuple[int, int]


def hidden_lines(text: str, names: Collection[str] = ()) -> list[str]:
    """The lines of a document or a property file, with their ends, as they may be shown."""
    lines = text.splitlines(keepends=True)
    for number, parts in parts_of_lines([line.rstrip("\r\n") for line in lines], names).items():
        for start, end in sorted(parts, reverse=True):
            lines[number] = f"{lines[number][:start]}{HIDDEN}{lines[number][end:]}"
    return lines


_KEY = _Pattern(r"[\"']?(?P<name>(?<![\w.])[^\x00-@\[-^`{-\x7f][\w.\-\[\]]{0,60})[\"']?[ \t]*(?P<sign>[:=])")
_FLOW_VALUE = _Pattern(r"[ \t]*(?:\"(?:[^\"\\]|\\.)*\"?|'(?:[^']|'')*'?|[^,}\]]*)")
_LISTED = _Pattern(
    r"(?P<name>(?<![\w-])--?[A-Za-z][\w.\-]{0,60})[\"']?,[ \t]*(?P<value>\"[^\"]*\"?|'[^']*'?|[^\s,\]]+)"
)
_ANY_ITEM = _Pattern(r"[ \t]*-[ \t]+")
_ITEM = _Pattern(r"[ \t]*-[ \t]+[\"']?(?P<name>--?[A-Za-z][\w.\-]*)[\"']?[ \t]*\Z")
_INDENT = _Pattern(r"[ \t]*(?:-[ \t]+)*")


def parts_of_lines(lines: Sequence[str], names: Collection[str] = ()) -> dict[int, list[Part]]:
    """What is hidden of each line (from 0) of a text that nobody could read as what it is to be: whatever stands behind
    a name that says so, or is one of `names`, and below it."""
    found: dict[int, list[Part]] = {}
    below: int | None = None  # the indentation of the key whose value goes on
    is_value = False  # of an option, which the item before is
    for number, line in enumerate(lines):
        start = len(line) - len(line.lstrip())
        goes_on = below is not None and (start > below or (start == below and not _KEY.search(line)))
        if goes_on or (below is not None and (not line.strip() or line.lstrip().startswith("- "))):
            if line.strip():
                found[number] = [(start, len(line.rstrip()))]
            continue
        parts, below = _parts_of_line(line, names)
        option = _ITEM.match(line)
        if is_value and (item := _ANY_ITEM.match(line)) and not option:
            parts = [(item.end(), max(len(line.rstrip()), item.end()))]
        is_value = option is not None and is_one_of(option["name"], names)
        if parts:
            found[number] = parts
    return found


def _parts_of_line(line: str, names: Collection[str]) -> tuple[list[Part], int | None]:
    """Also the indentation of a key whose value goes on in the next line."""
    parts = [found.span(2) for found in re.finditer(USER_INFO, line)]
    for options in (_OPTION, _LISTED):
        parts += [found.span("value") for found in options.finditer(line) if is_secret(found["name"])]
    first, at = _INDENT.match(line), 0
    while key := _KEY.search(line, at):
        at = key.end()
        last = re.split(r"[.\[\]]", key["name"].rstrip("]."))[-1]
        if not is_secret(key["name"]) and last not in names and key["name"] not in names:
            continue
        is_first = first is not None and key.start() == first.end()
        end = len(line.rstrip()) if is_first else _FLOW_VALUE.match(line, at).end()
        begin = at + len(line[at:end]) - len(line[at:end].lstrip())
        if is_first and (begin == end or line[begin] in "|>\"'&!"):
            return [*parts, (begin, end)] if begin < end else parts, key.start()
        if begin < end and not _REFERENCE.match(line[begin:]):
            parts.append((begin, end))
        at = max(at, end)
    return parts, None
