"""How something is mended: the words of a hint, and edits of the documents."""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.span import Span

WORD, VALUE, REMOVE, QUOTE, UNQUOTE, LIST, UNTAG = "word", "value", "remove", "quote", "unquote", "list", "untag"
IMPORT = "import"


class Edit(msgspec.Struct, frozen=True):
    """Another text at a place of a file; an empty place is where it is put in.

    Where `how` is given, the edit is meant, and not spelled yet: whoever knows the document's text does that
    (`source.spelled`). WORD: `word`, which stands at the place or in it, is to be `text`. VALUE: the value
    there is to be `text`, as YAML. REMOVE: the entry that begins
    there goes. QUOTE, UNQUOTE: the text that stands there gets quotes, or loses them. LIST: it becomes a list of one.
    UNTAG: it loses its tag, and a text gets quotes instead. IMPORT: the document imports `text`.
    """

    span: Span
    text: str = ""
    how: str = ""
    word: str = ""


class Fix(msgspec.Struct, frozen=True):
    """Edits that belong together. A `safe` one leaves only one possible meaning; others are a guess."""

    title: str
    edits: tuple[Edit, ...]
    safe: bool = False

    @property
    def is_spelled(self) -> bool:
        return not any(edit.how for edit in self.edits)


def removal(span: Span, *, safe: bool = True) -> Fix:
    """Without the entry of a list, or of a mapping, that begins there."""
    return Fix("remove it", (Edit(span, how=REMOVE),), safe)


def quoting(span: Span, *, safe: bool = True) -> Fix:
    return Fix("put it in quotes", (Edit(span, how=QUOTE),), safe)


def listing(span: Span) -> Fix:
    return Fix("make it a list", (Edit(span, how=LIST),), safe=True)


def unquoting(span: Span) -> Fix:
    return Fix("take the quotes away", (Edit(span, how=UNQUOTE),), safe=True)


def replacing(span: Span, word: str, meant: str, *, safe: bool) -> Fix:
    """`meant` instead of the `word` that stands at a place, or in it."""
    return Fix(f"write '{meant}'", (Edit(span, meant, WORD, word),), safe)


def changing(span: Span, value: str) -> Fix:
    """Another value, as YAML spells it, instead of the one at a place."""
    return Fix(f"write {value}", (Edit(span, value, VALUE),), safe=True)


class Hint(msgspec.Struct, frozen=True):
    """What may mend something, in words. Where these say which word should stand at the diagnostic's place, `meant` is
    that word, and `word` the one that stands there. `imports` is what the document has to import."""

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
