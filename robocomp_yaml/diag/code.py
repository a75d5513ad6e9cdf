"""A code: one kind of diagnostic, which a page of `docs/diagnostics/` describes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic, Related, as_facts
from robocomp_yaml.diag.fix import Fix, Hint
from robocomp_yaml.diag.span import Span

if TYPE_CHECKING:
    from robocomp_yaml.diag.page import Files, Page, PageEntry


def _page(name: str) -> Page:
    from robocomp_yaml.diag.page import page  # most runs report nothing

    return page(name)


class _CapitalNames(dict[str, str]):
    def __missing__(self, key: str) -> str:
        return key.upper().replace("_", " ")


class Code(msgspec.Struct, frozen=True):
    """One kind of diagnostic. Ids are never reused. The page is read on first use."""

    id: str
    page: str

    @property
    def severity(self) -> str:
        return _page(self.page).severities[self.id]

    @property
    def message(self) -> str:
        """A format string for the facts that are passed to `at`."""
        return _page(self.page).messages[self.id]

    @property
    def entry(self) -> PageEntry:
        return _page(self.page).entry(self.id)

    @property
    def why(self) -> str:
        """The reason, in Markdown."""
        return self.entry.why

    @property
    def wrong(self) -> Files:
        """Files for which `rcyaml COMMAND` (a shell expands `*`) reports this code; for those of `right` it reports
        nothing. The tests run both."""
        return self.entry.wrong

    @property
    def right(self) -> Files:
        return self.entry.right

    @property
    def command(self) -> str:
        return self.entry.command

    @property
    def says(self) -> tuple[str, ...]:
        """If the message is only a fact: all possible messages, as format strings for readers."""
        return self.entry.says

    @property
    def messages(self) -> list[str]:
        """All possible messages, with the facts' names in capitals: `{name}` as `NAME`."""
        return [message.format_map(_CapitalNames()) for message in self.says or (self.message,)]

    def at(
        self, span: Span, *, hint: str | Hint = "", related: Iterable[Related] = (), more: str = "",
        fixes: Iterable[Fix] = (), **facts: object,
    ) -> Diagnostic:  # fmt: skip
        """The diagnostic of this code at a location; `facts` fill the message. If the hint has a `meant` word, the word
        becomes a fact and a fix, too."""
        fixes = tuple(fixes)
        if isinstance(hint, Hint):
            facts |= {"meant": hint.meant} if hint.meant else {}
            fixes += hint.fixes(span)
        return Diagnostic(self.id, self.severity, span, as_facts(facts), str(hint), tuple(related), fixes, more)


KNOWN: dict[str, Code] = {}
"""The codes of the families that are imported, by id."""


class Family(msgspec.Struct, frozen=True):
    """The codes of a page. `page` is its name, or the text of a plug-in's page."""

    page: str

    def code(self, id_: str) -> Code:
        made = Code(id_, self.page)
        KNOWN.setdefault(id_, made)
        return made
