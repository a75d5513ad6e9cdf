"""The changes of a document that can be undone: a file in `.rcyaml/edits/`, beside the document, which every interface
to rcyaml reads and writes.

The history holds as long as nobody else changes the document: an undo restores a text only if the document has the text
that the change made.
"""

from __future__ import annotations

import os

import msgspec

from robocomp_yaml.api.refusals import cannot_write
from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions import whole_file

FOLDER = ".rcyaml/edits"
LONGEST = 100  # changes
LARGEST = 4 << 20  # bytes of texts


class PastChange(msgspec.Struct, frozen=True):
    """`what` is the change in words, `time` in seconds since the epoch. `before` and `after` are the document's
    contents, `created` the documents that were written with it, `renamed` what got another name, as in a Revision."""

    what: str
    time: float
    before: bytes
    after: bytes
    created: tuple[tuple[str, bytes], ...] = ()
    renamed: tuple[tuple[str, str, str], ...] = ()


class EditHistory(msgspec.Struct):
    """The changes of one document, the earliest first; `done` is how many of them are not undone."""

    past: list[PastChange] = []
    done: int = 0

    def add(self, change: PastChange) -> None:
        """Adds a change; what was undone before is forgotten."""
        if self.done and self.past[self.done - 1].after != change.before:
            self.past, self.done = [], 0  # somebody else changed the document in between
        self.past = [*self.past[: self.done], change][-LONGEST:]
        while len(self.past) > 1 and sum(len(one.before) + len(one.after) for one in self.past) > LARGEST:
            del self.past[0]
        self.done = len(self.past)

    def undoable(self, content: bytes) -> PastChange | None:
        """The change that led to this content."""
        found = self.past[self.done - 1] if self.done else None
        return found if found is not None and found.after == content else None

    def redoable(self, content: bytes) -> PastChange | None:
        """The undone change that can be made again, from this content."""
        found = self.past[self.done] if self.done < len(self.past) else None
        return found if found is not None and found.before == content else None


def read(document: str) -> EditHistory:
    """The history of a document; an empty one if there is none that can be read."""
    try:
        with open(_path(document), "rb") as file:
            return msgspec.msgpack.decode(file.read(), type=EditHistory)
    except (OSError, msgspec.MsgspecError):
        return EditHistory()


def write(document: str, history: EditHistory) -> None:
    """Keeps a history. Raises Refused if it cannot be written."""
    path = _path(document)
    folder = os.path.dirname(path)
    try:
        os.makedirs(folder, mode=0o700, exist_ok=True)
        whole_file.ignore_all(folder, "# The changes that `rcyaml edit undo` can undo.\n")
        whole_file.put(path, msgspec.msgpack.encode(history), 0o600)
    except OSError as error:
        raise cannot_write(path, error) from None


def _path(document: str) -> str:
    real = os.path.realpath(document)
    name = os.path.basename(real)
    short = name if len(name.encode()) < 200 else digest(name.encode())
    return os.path.join(os.path.dirname(real), FOLDER, short)
