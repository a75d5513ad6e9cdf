"""How something is mended: the words of a hint, and edits of the documents."""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.span import Span


class Edit(msgspec.Struct, frozen=True):
    """Another text at a place of a file; an empty place is where it is put in.

    Where `word` is given, `text` is what is to be meant instead of this word, which stands at the place, or in it.
    Whoever knows the document's text spells it (`source.spelled`).
    """

    span: Span
    text: str
    word: str = ""


class Fix(msgspec.Struct, frozen=True):
    """Edits that belong together. A `safe` one leaves only one possible meaning; others are a guess."""

    title: str
    edits: tuple[Edit, ...]
    safe: bool = False


class Hint(msgspec.Struct, frozen=True):
    """What may mend something, in words. Where these say which word should stand at the diagnostic's place, `meant` is
    that word, and `word` the one that stands there."""

    text: str
    word: str = ""
    meant: str = ""
    safe: bool = False

    def __bool__(self) -> bool:
        return bool(self.text)

    def __str__(self) -> str:
        return self.text

    def fixes(self, span: Span) -> tuple[Fix, ...]:
        if not self.meant:
            return ()
        return (Fix(f"write '{self.meant}'", (Edit(span, self.meant, self.word),), self.safe),)


NO_HINT = Hint("")
