"""What an export's form cannot say: refused where it is written, and told at the entry that it belongs to."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, Process


class Unwritable(ValueError):
    """The text says why; `name` is whose it is, and `span` where that stands."""

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.name, self.span = "", Span("")


@contextmanager
def of(owner: Process | Network) -> Iterator[None]:
    """Whatever is refused inside belongs to this process or, if to none, to the network."""
    try:
        yield
    except Unwritable as refused:
        if not refused.name:
            refused.name = owner.name
            refused.span = owner.span if isinstance(owner, Process) else Span(owner.path)
        raise
