"""A diagnostic: an error, warning or note with a code and a location, as facts. Its text is made when it is shown."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.diag.span import Span

ERROR, WARNING, NOTE = "error", "warning", "note"
SEVERITIES = (ERROR, WARNING, NOTE)

Fact = str | int | float | bool | None | tuple[str | int | float | bool | None, ...]
Facts = tuple[tuple[str, Fact], ...]
"""Facts by their names, sorted: they can be compared, hashed, and written as JSON."""


def as_facts(facts: Mapping[str, object]) -> Facts:
    """Facts of any values; a value that is neither text nor number is converted to text."""
    return tuple((name, _fact(facts[name])) for name in sorted(facts))


def _fact(value: object) -> Fact:
    if isinstance(value, (list, tuple, set, frozenset)):
        return tuple(_plain(each) for each in value)
    return _plain(value)


def _plain(value: object) -> str | int | float | bool | None:
    return value if type(value) in (str, int, float, bool, type(None)) else str(value)  # type: ignore[return-value]


class Related(msgspec.Struct, frozen=True):
    """A second location of a diagnostic, such as the first of two definitions."""

    message: str
    span: Span


class Diagnostic(msgspec.Struct, frozen=True):
    """`facts` describe what is wrong, `hint` suggests a fix, and `fixes` are edits.

    `more` are lines under the snippet in text output, for example a text to paste. `hidden` are the locations of
    secrets in the lines shown; None if the documents were not searched for secrets, so that the names in a line decide.
    """

    code: str
    severity: str
    span: Span
    facts: Facts = ()
    hint: str = ""
    related: tuple[Related, ...] = ()
    fixes: tuple[Fix, ...] = ()
    more: str = ""
    hidden: tuple[Span, ...] | None = None

    @property
    def message(self) -> str:
        """The message for users."""
        from robocomp_yaml.diag.codes import message_of

        return message_of(self.code).format_map(dict(self.facts))

    def __str__(self) -> str:
        """`file:line:column: severity[CODE]: message`, in one line."""
        return f"{self.span.file}:{self.span.line}:{self.span.column}: {self.severity}[{self.code}]: {self.message}"

    def fact(self, name: str) -> Fact:
        """The fact of this name; None if it is absent."""
        return dict(self.facts).get(name)

    def as_severity(self, severity: str) -> Diagnostic:
        return replace(self, severity=severity)

    @property
    def sort_key(self) -> tuple[object, ...]:
        return (self.span, self.code, self.message)


def in_order(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics sorted by location, each once."""
    return sorted(set(diagnostics), key=lambda d: d.sort_key)


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    return any(d.severity == ERROR for d in diagnostics)
