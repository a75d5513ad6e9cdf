"""The exceptions that the library raises if there is no result."""

from __future__ import annotations

from collections.abc import Iterable

from robocomp_yaml.diag.diagnostic import Diagnostic


class Refused(Exception):
    """A request cannot be carried out, for example because a name is unknown, or because a file is the user's or cannot
    be written. The message is for users."""


class Faulty(Exception):
    """Documents have errors that leave no result. `diagnostics` are all diagnostics, `documents` is the number of
    documents that were read."""

    def __init__(self, diagnostics: Iterable[Diagnostic], documents: int = 0) -> None:
        self.diagnostics = tuple(diagnostics)
        self.documents = documents
        super().__init__("; ".join(one.message for one in self.diagnostics) or "the documents have errors")
