"""What the form of an export cannot express, reported at the entry that has it.

A text that could change the structure of the output is rejected: Unwritable is raised. A character that a form cannot
write is replaced, which is noted.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, Process


class Unwritable(ValueError):
    """The text is the reason. `name` and `span` are those of the process or network that has the text; if they are not
    set, those of the process that is being written."""

    def __init__(self, why: str, name: str = "", span: Span = Span("")) -> None:
        super().__init__(why)
        self.name, self.span = name, span


_NOTES: ContextVar[list[Unwritable]] = ContextVar("notes")


def note(why: str) -> None:
    """Notes that something is written in another way."""
    _NOTES.get([]).append(Unwritable(why))


@contextmanager
def noted() -> Iterator[list[Unwritable]]:
    """The notes of the block."""
    notes: list[Unwritable] = []
    token = _NOTES.set(notes)
    try:
        yield notes
    finally:
        _NOTES.reset(token)


@contextmanager
def of(owner: Process | Network) -> Iterator[None]:
    """What is rejected or noted in the block, and has no owner yet, belongs to this process or network."""
    try:
        yield
    except Unwritable as error:
        _set_owner(error, owner)
        raise
    finally:
        for each in _NOTES.get([]):
            _set_owner(each, owner)


def _set_owner(problem: Unwritable, owner: Process | Network) -> None:
    if not problem.name:
        problem.name = owner.name
        problem.span = owner.span if isinstance(owner, Process) else Span(owner.path)
