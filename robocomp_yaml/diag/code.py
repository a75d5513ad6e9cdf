"""A code: one kind of diagnostic. What it says, and why, stands on a page of `docs/diagnostics/`."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic, Related, as_facts
from robocomp_yaml.diag.fix import Fix, Hint
from robocomp_yaml.diag.page import Entry, Files
from robocomp_yaml.diag.page import page as read_page
from robocomp_yaml.diag.span import Span


class _Words(dict[str, str]):
    def __missing__(self, key: str) -> str:
        return key.upper().replace("_", " ")


class Code(msgspec.Struct, frozen=True):
    """One kind of diagnostic. Ids are never reused. Its page is read when it is first asked for what stands there."""

    id: str
    page: str

    @property
    def severity(self) -> str:
        return read_page(self.page).severities[self.id]

    @property
    def message(self) -> str:
        """A format string for the facts given to `at`."""
        return read_page(self.page).messages[self.id]

    @property
    def entry(self) -> Entry:
        return read_page(self.page).entry(self.id)

    @property
    def why(self) -> str:
        """The explanation, in Markdown."""
        return self.entry.why

    @property
    def wrong(self) -> Files:
        """A small tree on which `rcyaml COMMAND` (a `*` is what a shell makes of it) gives this diagnostic, and, for
        `right`, gives none: the tests run both."""
        return self.entry.wrong

    @property
    def right(self) -> Files:
        return self.entry.right

    @property
    def command(self) -> str:
        return self.entry.command

    @property
    def says(self) -> tuple[str, ...]:
        """Where the message leaves all to a fact, the messages that there are: format strings for readers."""
        return self.entry.says

    @property
    def messages(self) -> list[str]:
        """What it can say, with the facts as words: `{name}` as `NAME`."""
        return [message.format_map(_Words()) for message in self.says or (self.message,)]

    def at(
        self, span: Span, *, hint: str | Hint = "", related: Iterable[Related] = (), more: str = "",
        fixes: Iterable[Fix] = (), **facts: object,
    ) -> Diagnostic:  # fmt: skip
        """The diagnostic of this code at a place; `facts` fill the message. What a hint says was `meant` is a fact and
        a fix, too."""
        fixes = tuple(fixes)
        if isinstance(hint, Hint):
            facts |= {"meant": hint.meant} if hint.meant else {}
            fixes += hint.fixes(span)
        return Diagnostic(self.id, self.severity, span, as_facts(facts), str(hint), tuple(related), fixes, more)


KNOWN: dict[str, Code] = {}
"""The codes of the families that are imported, by id."""


class Family(msgspec.Struct, frozen=True):
    """The codes of a page: its name, or a plug-in's page itself, as text."""

    page: str

    def code(self, id_: str) -> Code:
        made = Code(id_, self.page)
        KNOWN.setdefault(id_, made)
        return made
