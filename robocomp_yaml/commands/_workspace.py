"""How `init` and `new` tell what they write, and that it cannot be."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import click

from robocomp_yaml.diag import terminal


@contextmanager
def writing() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        where = f" {error.filename}" if error.filename else ""
        raise click.ClickException(f"cannot write{where}: {error.strerror or error}") from error


def tell(done: str, what: str) -> None:
    """One file, or what there is to note."""
    if done == "note":
        terminal.say(f"note: {what}", err=True)
    elif click.get_current_context().obj.verbosity >= 0:
        terminal.say(f"{done:<5} {what}")
