"""What an export's form cannot say: told at the entry that it belongs to.

What could become something else than a text of its own is refused (Unwritable is raised). A sign that a form merely
has no spelling for is replaced, which is noted.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, Process


class Unwritable(ValueError):
    """The text says why; `name` is whose it is, and `span` where that stands: those of the process that is being
    written, where they are not given."""

    def __init__(self, why: str, name: str = "", span: Span = Span("")) -> None:
        super().__init__(why)
        self.name, self.span = name, span


_NOTES: ContextVar[list[Unwritable]] = ContextVar("notes")


def note(why: str) -> None:
    """Something is written otherwise than it is."""
    _NOTES.get([]).append(Unwritable(why))


@contextmanager
def noted() -> Iterator[list[Unwritable]]:
    """What is noted inside."""
    notes: list[Unwritable] = []
    token = _NOTES.set(notes)
    try:
        yield notes
    finally:
        _NOTES.reset(token)


@contextmanager
def of(owner: Process | Network) -> Iterator[None]:
    """Whatever is refused or noted inside belongs to this process or, if to none, to the network."""
    try:
        yield
    except Unwritable as refused:
        _belongs(refused, owner)
        raise
    finally:
        for found in _NOTES.get([]):
            _belongs(found, owner)


def _belongs(found: Unwritable, owner: Process | Network) -> None:
    if not found.name:
        found.name = owner.name
        found.span = owner.span if isinstance(owner, Process) else Span(owner.path)
