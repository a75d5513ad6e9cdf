"""The stamps that compiles leave: where one is kept, and what it tells of a later run."""

from __future__ import annotations

import os
from collections.abc import Sequence

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import specific
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.transactions import stamp

_OF_CODE = {code.id for code in vars(specific).values() if isinstance(code, Code)}


def place(
    paths: Sequence[str], include: Sequence[str], output: str | None = None, targets: Sequence[str] = ()
) -> tuple[str, str]:
    """The folder below which a compile with these arguments keeps its stamp, and the stamp's name."""
    name = stamp.key([*paths, "-o", output or "", "-I", *include, "-t", *targets])
    return output or (paths[0] if os.path.isdir(paths[0]) else os.path.dirname(paths[0])) or ".", name


def told_of_code(paths: Sequence[str], include: Sequence[str]) -> list[Diagnostic] | None:
    """What a compile of these said of the user's code; None where something that it read has changed since, or there
    was none. What became of the files that it wrote does not matter for that."""
    made = stamp.load(*place(paths, include))
    if made is None or not stamp.reads_the_same(made):
        return None
    from robocomp_yaml.commands._outcome import Outcome

    return [told for told in Outcome.of_data(made.replay).diagnostics if told.code in _OF_CODE]
