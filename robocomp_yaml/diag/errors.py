"""How the parts that a program calls say that there is no result."""

from __future__ import annotations

from collections.abc import Iterable

from robocomp_yaml.diag.diagnostic import Diagnostic


class Refused(Exception):
    """What was asked for cannot be done as it was asked: a name that is unknown, a file that is none of ours or cannot
    be written. The message is for users."""


class Faulty(Exception):
    """Documents have errors that leave no result. `diagnostics` are all that was found, `documents` is how many were
    read."""

    def __init__(self, diagnostics: Iterable[Diagnostic], documents: int = 0) -> None:
        self.diagnostics = tuple(diagnostics)
        self.documents = documents
        super().__init__("; ".join(one.message for one in self.diagnostics) or "the documents have errors")
