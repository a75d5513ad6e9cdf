"""Removes the secrets of documents from diagnostics: from their facts and hints, and from the lines that they quote."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import message_of
from robocomp_yaml.diag.diagnostic import Diagnostic, Fact, Facts, Related
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.diag.span import Span
from robocomp_yaml.secrets import HIDDEN, Part, url

_LONG = 12  # characters that identify a secret in a message that shortens it


class Hidden(msgspec.Struct, frozen=True):
    """The locations and texts of secrets, by files. `files` are all files that were searched for secrets."""

    files: set[str] = set()
    places: dict[str, list[Span]] = {}
    texts: dict[str, set[str]] = {}

    def add(self, span: Span, text: str) -> None:
        self.places.setdefault(span.file, []).append(span)
        self.texts.setdefault(span.file, set()).add(text.strip())

    def veiled(self, diagnostic: Diagnostic) -> Diagnostic:
        """The diagnostic without the secrets of its files. A hint with a secret is dropped, because the rest of it may
        describe the secret."""
        spans = [diagnostic.span, *(related.span for related in diagnostic.related)]
        texts = {text for span in spans for text in self.texts.get(span.file, ())}
        shown = {(span.file, span.line) for span in spans}
        hidden = tuple(
            place for file in dict.fromkeys(span.file for span in spans) for place in self.places.get(file, ())
            if any((file, line) in shown for line in range(place.line, place.end_line + 1))
        )  # fmt: skip
        is_known = hidden or all(span.file in self.files for span in spans)
        related = tuple(Related(without(one.message, texts), one.span) for one in diagnostic.related)
        hint = without(diagnostic.hint, texts)
        return replace(
            diagnostic, facts=_facts(diagnostic, texts), hint=hint if hint == url(diagnostic.hint) else "",
            fixes=tuple(fix for fix in diagnostic.fixes if not _contains_secret(fix, texts)),
            more=without(diagnostic.more, texts), related=related, hidden=hidden if is_known else None,
        )  # fmt: skip

    def without(self, text: str) -> str:
        """A text without any of the secrets."""
        return without(text, {secret for texts in self.texts.values() for secret in texts})


def _contains_secret(fix: Fix, secrets: set[str]) -> bool:
    texts = [fix.title, *(text for edit in fix.edits for text in (edit.text, edit.word))]
    return any(text in secrets or without(text, secrets) != text for text in texts if text)


def _facts(diagnostic: Diagnostic, secrets: set[str]) -> Facts:
    """The facts without the secrets, so that the message does not contain them, either."""
    facts = tuple((name, _fact(diagnostic.code, name, fact, secrets)) for name, fact in diagnostic.facts)
    message = message_of(diagnostic.code).format_map(dict(facts))
    if message == without(message, secrets):
        return facts
    # Several facts together make a secret: none of its parts is shown.
    parts = {name for name, fact in facts if fact and any(str(fact) in secret for secret in secrets)}
    return tuple((name, HIDDEN if name in parts else fact) for name, fact in facts)


def _fact(code: str, name: str, fact: Fact, secrets: set[str]) -> Fact:
    if isinstance(fact, tuple):
        return tuple(_fact(code, name, each, secrets) for each in fact)  # type: ignore[misc]
    if fact is None or isinstance(fact, bool):
        return fact
    text = str(fact)
    is_value = isinstance(fact, str) or len(text) > 3 or f"'{{{name}}}'" in message_of(code)
    veiled = HIDDEN if is_value and text in secrets else without(text, secrets)
    return fact if veiled == text else veiled


def without(text: str, secrets: Iterable[str]) -> str:
    """A text in which these secrets are hidden, also if they are escaped or shortened."""
    text = url(text)
    for secret in sorted((secret for secret in secrets if secret), key=len, reverse=True):
        for spelled in dict.fromkeys((secret, repr(secret)[1:-1], json.dumps(secret)[1:-1], secret.partition("\n")[0])):
            text = _without_one(text, spelled)
    return text


def _without_one(text: str, secret: str) -> str:
    if len(secret) > _LONG and secret[:_LONG] in text:
        return re.sub(f"{re.escape(secret[:_LONG])}{_rest(secret[_LONG:])}(?:…|\\.\\.\\.)?", HIDDEN, text)
    if secret not in text:
        return text
    if len(secret) > 3:
        return re.sub(rf"(?<!\w){re.escape(secret)}(?!\w)", HIDDEN, text)
    # A short text occurs in many words: it is hidden only where a message quotes a value.
    return re.sub(rf"(?<=')({re.escape(secret)})(?=')|(?<=a number, ){re.escape(secret)}\b", HIDDEN, text)


def _rest(text: str) -> str:
    """A pattern that matches the longest possible beginning of a text."""
    made = ""
    for char in reversed(text[:200]):
        made = f"(?:{re.escape(char)}{made})?"
    return made


def parts(span_line: int, width: int, places: Iterable[Span]) -> list[Part]:
    """The hidden parts, as (start, end), of line `span_line`, which has `width` characters."""
    hidden = []
    for place in places:
        if place.line <= span_line <= place.end_line:
            start = place.column - 1 if place.line == span_line else 0
            end = place.end_column - 1 if place.end_line == span_line else width
            if start < min(end, width):
                hidden.append((start, min(end, width)))
    return hidden


def hide(text: str, hidden: Iterable[Part], start: int, end: int) -> tuple[str, int, int]:
    """A line with its hidden parts replaced, and the new start and end of one part of the line."""
    made, at, first, last = "", 0, start, end
    for begin, finish in sorted(hidden):
        if finish <= at:
            continue
        begin = max(begin, at)
        made += text[at:begin] + HIDDEN
        shift = len(made) - finish  # of the text after it
        if start >= finish:
            first = start + shift
        elif start >= begin:
            first = len(made) - len(HIDDEN)
        if end >= finish:
            last = end + shift
        elif end > begin:
            last = len(made)
        at = finish
    return made + text[at:], first, max(first, last)
