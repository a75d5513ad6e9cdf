"""A diagnostic: one thing that is wrong, or worth knowing, at one place."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.span import Span

ERROR, WARNING, NOTE = "error", "warning", "note"
SEVERITIES = (ERROR, WARNING, NOTE)


class Related(msgspec.Struct, frozen=True):
    """A second place that belongs to a diagnostic, such as the first of two definitions."""

    message: str
    span: Span


class Diagnostic(msgspec.Struct, frozen=True):
    """`message` says what is wrong in the user's words; `hint`, where there is one, says how to mend it.

    `more` are lines shown under the snippet in text output: a text to paste, for instance. `hidden` are places in the
    lines shown that hold secrets; None where nobody has looked, and the names in a line say what is hidden.
    """

    code: str
    severity: str
    message: str
    span: Span
    hint: str = ""
    related: tuple[Related, ...] = ()
    more: str = ""
    hidden: tuple[Span, ...] | None = None

    def as_severity(self, severity: str) -> Diagnostic:
        return replace(self, severity=severity)

    @property
    def sort_key(self) -> tuple[object, ...]:
        return (self.span, self.code, self.message)


def in_order(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Sorted by place, each once."""
    return sorted(set(diagnostics), key=lambda d: d.sort_key)


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    return any(d.severity == ERROR for d in diagnostics)
