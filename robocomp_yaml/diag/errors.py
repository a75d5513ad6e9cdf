"""The exceptions that the library raises if there is no result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from robocomp_yaml.diag.diagnostic import Diagnostic


def reason_of(error: OSError) -> str:
    """The reason of an error of the operating system, for messages: it begins with a small letter, if not with PATH."""
    text = error.strerror or str(error)
    return text if text[:2].isupper() else text[:1].lower() + text[1:]


class Refused(Exception):
    """A request cannot be carried out, for example because a name is unknown, or because a file is the user's or cannot
    be written. The message is for users."""


class NotRenamed(Refused):
    """A name is not renamed, because something would be wrong, or would mean something else."""


class Faulty(Exception):
    """Documents have errors that leave no result. `diagnostics` are all diagnostics, `documents` is the number of
    documents that were read, None if the errors are not about documents. `texts` are those of locations that are in no
    file, such as arguments."""

    def __init__(
        self, diagnostics: Iterable[Diagnostic], documents: int | None = 0, texts: Mapping[str, str] | None = None
    ) -> None:
        self.diagnostics = tuple(diagnostics)
        self.documents = documents
        self.texts = dict(texts or {})
        super().__init__("; ".join(one.message for one in self.diagnostics) or "the documents have errors")


class Diagnosed(Exception):
    """What was begun has no result; the diagnostic says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class NoAnswer(Exception):
    """A program with which rcyaml talks does not answer, or not as its documents say. The message is for users; `hint`
    is what helps, or ''."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint
