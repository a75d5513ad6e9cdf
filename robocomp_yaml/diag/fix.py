"""Hints, and fixes: edits of documents."""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.span import Span

WORD, VALUE, REMOVE, QUOTE, UNQUOTE, LIST, UNTAG = "word", "value", "remove", "quote", "unquote", "list", "untag"
IMPORT = "import"


class Edit(msgspec.Struct, frozen=True):
    """Replaces the text of a span by `text`; an empty span is an insertion.

    If `how` is set, the edit states only the intended meaning; `source.spelled` knows the document's text, and
    translates it. WORD: the `word` in the span becomes `text`. VALUE: the value in the span becomes `text`, as YAML.
    REMOVE: the entry that begins at the span is removed. QUOTE, UNQUOTE: quotes are added to the text, or removed.
    LIST: the value becomes a list of one element. UNTAG: the tag is removed, and a text gets quotes instead. IMPORT:
    the document imports `text`.
    """

    span: Span
    text: str = ""
    how: str = ""
    word: str = ""


class Fix(msgspec.Struct, frozen=True):
    """Edits that belong together. A `safe` fix leaves only one possible meaning; any other is a guess."""

    title: str
    edits: tuple[Edit, ...]
    safe: bool = False

    @property
    def is_spelled(self) -> bool:
        return not any(edit.how for edit in self.edits)


def removal(span: Span, *, safe: bool = True) -> Fix:
    """The fix that removes the entry of a list or mapping that begins at the span."""
    return Fix("remove it", (Edit(span, how=REMOVE),), safe)


def quoting(span: Span, *, safe: bool = True) -> Fix:
    return Fix("put it in quotes", (Edit(span, how=QUOTE),), safe)


def listing(span: Span) -> Fix:
    return Fix("make it a list", (Edit(span, how=LIST),), safe=True)


def unquoting(span: Span) -> Fix:
    return Fix("remove the quotes", (Edit(span, how=UNQUOTE),), safe=True)


def replacing(span: Span, word: str, meant: str, *, safe: bool) -> Fix:
    """The fix that replaces a `word` in the span by `meant`."""
    return Fix(f"write '{meant}'", (Edit(span, meant, WORD, word),), safe)


def changing(span: Span, value: str) -> Fix:
    """The fix that replaces the value in the span by another one, written as YAML."""
    return Fix(f"write {value}", (Edit(span, value, VALUE),), safe=True)


class Hint(msgspec.Struct, frozen=True):
    """A text that suggests a fix. If it suggests to replace a word at the diagnostic's location, `word` is this word,
    and `meant` the new one. `imports` is what the document must import."""

    text: str
    word: str = ""
    meant: str = ""
    safe: bool = False
    imports: str = ""

    def __bool__(self) -> bool:
        return bool(self.text)

    def __str__(self) -> str:
        return self.text

    def fixes(self, span: Span) -> tuple[Fix, ...]:
        named = replacing(span, self.word, self.meant, safe=self.safe) if self.meant else None
        if not self.imports:
            return (named,) if named else ()
        edits = (Edit(span, self.imports, IMPORT), *(named.edits if named else ()))
        return (Fix(f"import '{self.imports}'" + (f", and {named.title}" if named else ""), edits, self.safe),)


NO_HINT = Hint("")
