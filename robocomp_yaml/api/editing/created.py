"""Documents that a change writes beside the one that it changes: such as that of a new component."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

from robocomp_yaml.api.refusals import cannot_write
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.transactions import whole_file

Created = tuple[tuple[str, bytes], ...]
"""Paths and contents."""


@contextlib.contextmanager
def written(documents: Created) -> Iterator[None]:
    """Writes documents, and removes them if what follows fails. Raises Refused if one cannot be written, or is there
    already."""
    done: list[tuple[str, bytes]] = []
    try:
        for path, content in documents:
            try:
                os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
                whole_file.create(path, content.decode())
            except FileExistsError:
                raise Refused(f"{path} exists already, and is kept as it is") from None
            except OSError as error:
                raise cannot_write(path, error) from None
            done.append((path, content))
        yield
    except BaseException:
        remove(tuple(done))
        raise


def remove(documents: Created) -> None:
    """Removes documents that nobody changed since, and their folders if they are empty."""
    for path, content in documents:
        with contextlib.suppress(OSError):
            with open(path, "rb") as file:
                if file.read() != content:
                    continue
            os.unlink(path)
            os.rmdir(os.path.dirname(path))
