"""Secrets in texts: detected by the names of what they are values of, and replaced.

Everything that shows a part of a document, a command or a state calls this module. A parameter can also be secret by
`secret: true`: its type says so. Components decide which names are secret by the same rule, `semantics.secrecy`.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import lru_cache

from robocomp_yaml.patterns import pattern
from robocomp_yaml.semantics import secrecy
from robocomp_yaml.semantics.secrecy import HIDDEN as HIDDEN
from robocomp_yaml.semantics.secrecy import USER_INFO
from robocomp_yaml.semantics.secrecy import url as url

KINDS = ("config", "ddsl", "pdsl")
"""The kinds of documents that may contain secrets outside of `x-` keys."""

_ASSIGNMENT = pattern(
    r"(?P<name>(?<![\w.])[^\x00-@\[-^`{-\x7f][\w.\-]{0,60})"
    r"(?P<sign>(?P<close>[\"']?)[ \t]*=[ \t]*|[\"']?[ \t]*:[ \t]+|[\"']:)"
    r"(?P<value>\"(?:[^\"\\]|\\.)*\"?|'[^']*'?|(?:(?:Bearer|Basic|Digest)[ \t]+)?[^\s\"'&;,)}\]]+)"
)
_OPTION = pattern(
    r"(?P<name>(?<![\w-])--?[A-Za-z][\w.\-]{0,60})(?P<sign>[ \t]+)"
    r"(?P<value>\"[^\"]*\"?|'[^']*'?|[^\s\"'&;-][^\s\"'&;]*)"
)
_IS_OPTION = pattern(r"--?[A-Za-z][\w.\-]*\Z")
_WHOLE = pattern(r"((?:--?)?[^\x00-@\[-^`{-\x7f][\w.\-]*)([=:])(?!//)(.+)\Z", re.DOTALL)
# A reference that can be resolved, as far as its text shows it. Any other text like one may be a secret.
_REFERENCE = pattern(
    r"\$\{?[A-Za-z_]|\{ *env *: *([\"']?)[A-Za-z_][A-Za-z0-9_]*\1 *(?:\}|\Z)|\{ *file *: *[^\s\[\]{},]"
)


@lru_cache(20_000)  # an editor asks again after each key, for all keys of a document
def is_secret(name: str) -> bool:
    """Whether a variable, an option, a parameter or a property of this name is secret."""
    return secrecy.is_secret(name)


def masked(text: str) -> str:
    """A text of any kind without the secrets that are visible in it: `user:password@` of URLs, `password=…`,
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
    """Whether a name, or a part of a dotted name, is that of a secret or one of `names`."""
    return is_secret(name) or (bool(names) and not {name, *name.lstrip("-").split(".")}.isdisjoint(names))


def value(name: str, text: str, names: Collection[str] = ()) -> str:
    """The value of a name as it may be shown: hidden if the name, or one of `names`, is that of a secret."""
    if text and is_one_of(name, names) and not _REFERENCE.match(text):
        return HIDDEN
    return masked(text)


def words(command: Iterable[str], names: Collection[str] = ()) -> Iterator[str]:
    """The words of a command without secrets. The value of an option may be the next word."""
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
    """A command on one line, without secrets."""
    return " ".join(words(words_, names))


_SUSPECTS = ("pass", "secret", "credential", "contrase", "key", "token", "pwd", "private", "bearer", "authorization")


def may_hold(text: str) -> bool:
    """Whether a text may contain a secret. False makes a search unnecessary."""
    lower = text.lower()
    return any(word in lower for word in _SUSPECTS) or ("://" in text and "@" in text)


Part = tuple[int, int]


def hidden_lines(text: str, names: Collection[str] = ()) -> list[str]:
    """The lines of a document or a property file, with their line ends and without secrets."""
    lines = text.splitlines(keepends=True)
    for number, parts in parts_of_lines([line.rstrip("\r\n") for line in lines], names).items():
        for start, end in sorted(parts, reverse=True):
            lines[number] = f"{lines[number][:start]}{HIDDEN}{lines[number][end:]}"
    return lines


_KEY = pattern(r"[\"']?(?P<name>(?<![\w.])[^\x00-@\[-^`{-\x7f][\w.\-\[\]]{0,60})[\"']?[ \t]*(?P<sign>[:=])")
_FLOW_VALUE = pattern(r"[ \t]*(?:\"(?:[^\"\\]|\\.)*\"?|'(?:[^']|'')*'?|[^,}\]]*)")
_LISTED = pattern(r"(?P<name>(?<![\w-])--?[A-Za-z][\w.\-]{0,60})[\"']?,[ \t]*(?P<value>\"[^\"]*\"?|'[^']*'?|[^\s,\]]+)")
_ANY_ITEM = pattern(r"[ \t]*-[ \t]+")
_ITEM = pattern(r"[ \t]*-[ \t]+[\"']?(?P<name>--?[A-Za-z][\w.\-]*)[\"']?[ \t]*\Z")
_INDENT = pattern(r"[ \t]*(?:-[ \t]+)*")


def parts_of_lines(lines: Sequence[str], names: Collection[str] = ()) -> dict[int, list[Part]]:
    """The parts of each line (from 0) to hide, in a text that cannot be parsed: everything after a name that is that of
    a secret, or one of `names`, and the lines below it."""
    hidden: dict[int, list[Part]] = {}
    below: int | None = None  # the indentation of the key whose value continues
    is_value = False  # this item is the value of the option before it
    for number, line in enumerate(lines):
        start = len(line) - len(line.lstrip())
        continues = below is not None and (start > below or (start == below and not _KEY.search(line)))
        if continues or (below is not None and (not line.strip() or line.lstrip().startswith("- "))):
            if line.strip():
                hidden[number] = [(start, len(line.rstrip()))]
            continue
        parts, below = _parts_of_line(line, names)
        option = _ITEM.match(line)
        if is_value and (item := _ANY_ITEM.match(line)) and not option:
            parts = [(item.end(), max(len(line.rstrip()), item.end()))]
        is_value = option is not None and is_one_of(option["name"], names)
        if parts:
            hidden[number] = parts
    return hidden


def _parts_of_line(line: str, names: Collection[str]) -> tuple[list[Part], int | None]:
    """Also the indentation of a key whose value continues in the next line."""
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
        value = _FLOW_VALUE.match(line, at)
        assert value is not None  # it may be empty
        end = len(line.rstrip()) if is_first else value.end()
        begin = at + len(line[at:end]) - len(line[at:end].lstrip())
        if is_first and (begin == end or line[begin] in "|>\"'&!"):
            return [*parts, (begin, end)] if begin < end else parts, key.start()
        if begin < end and not _REFERENCE.match(line[begin:]):
            parts.append((begin, end))
        at = max(at, end)
    return parts, None
