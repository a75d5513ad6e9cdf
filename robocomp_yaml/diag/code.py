"""The row of the table of codes: what a diagnostic says, why, and an example of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span


class Repeated(msgspec.Struct, frozen=True):
    """A text so long that it is made only when somebody asks for it."""

    before: str
    text: str
    times: int
    after: str

    def __str__(self) -> str:
        return self.before + self.text * self.times + self.after


class _Facts(dict[str, str]):
    def __missing__(self, key: str) -> str:
        return key.upper().replace("_", " ")


Files = Mapping[str, str | bytes | Repeated | None]


class Code(msgspec.Struct, frozen=True):
    """One kind of diagnostic. Ids are never reused.

    `message` is a format string for the facts given to `at`. `why` explains (Markdown). `wrong` and `right` are small
    trees of files, path to text (bytes for what is no text, None for an empty folder, "-> target" for a symlink), on
    which `rcyaml COMMAND` (a `*` is what a shell makes of it) gives this diagnostic, and gives none: the tests run
    both. `says` are, where the message leaves all to a fact, the messages that there are: format strings for readers.
    """

    id: str
    severity: str
    message: str
    why: str
    wrong: Files
    right: Files
    command: str = "check ."
    says: tuple[str, ...] = ()

    @property
    def messages(self) -> list[str]:
        """What it can say, with the facts as words: `{name}` as `NAME`."""
        return [message.format_map(_Facts()) for message in self.says or (self.message,)]

    def at(
        self, span: Span, *, hint: str = "", related: Iterable[Related] = (), more: str = "", **facts: object
    ) -> Diagnostic:
        """The diagnostic of this code at a place; `facts` fill the message."""
        return Diagnostic(self.id, self.severity, self.message.format(**facts), span, hint, tuple(related), more)
