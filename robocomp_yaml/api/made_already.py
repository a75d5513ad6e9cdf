"""The stamps that compiles leave: a run that was made already, of which nothing changed since, is not made again."""

from __future__ import annotations

import os
from collections.abc import Sequence

from robocomp_yaml.api.outcome import Outcome
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.transactions import stamp


def outcome(
    paths: Sequence[str], include: Sequence[str], output: str | None = None, targets: Sequence[str] = (), *,
    standalone: bool = False, planned: bool = False,
) -> Outcome | None:  # fmt: skip
    """What the same compile made again would come to; None where it is to be made."""
    made = stamp.load(*_place(paths, include, output, targets, standalone=standalone))
    if made is None or not stamp.is_current(made):
        return None
    if made.plugins:
        from robocomp_yaml.plugins import finding  # whose words are told again

        finding.load(made.plugins)
    return Outcome.of_data(made.replay, planned=planned)


def told_of_code(paths: Sequence[str], include: Sequence[str]) -> list[Diagnostic] | None:
    """What a compile of these said of the user's code; None where something that it read has changed since, or there
    was none. What became of the files that it wrote does not matter for that."""
    made = stamp.load(*_place(paths, include))
    if made is None or not stamp.reads_the_same(made):
        return None
    from robocomp_yaml.diag.code import Code
    from robocomp_yaml.diag.codes import specific

    of_code = {code.id for code in vars(specific).values() if isinstance(code, Code)}
    return [told for told in Outcome.of_data(made.replay).diagnostics if told.code in of_code]


def keep(
    taken: stamp.RunStamp, paths: Sequence[str], include: Sequence[str], output: str | None, targets: Sequence[str], *,
    standalone: bool = False,
) -> None:  # fmt: skip
    """Keeps the stamp of a compile with these arguments."""
    stamp.save(*_place(paths, include, output, targets, standalone=standalone), taken)


def _place(
    paths: Sequence[str], include: Sequence[str], output: str | None = None, targets: Sequence[str] = (), *,
    standalone: bool = False,
) -> tuple[str, str]:  # fmt: skip
    """The folder below which a compile with these arguments keeps its stamp, and the stamp's name."""
    name = stamp.key([*paths, "-o", output or "", "-I", *include, "-t", *targets, *(["alone"] if standalone else [])])
    return output or (paths[0] if os.path.isdir(paths[0]) else os.path.dirname(paths[0])) or ".", name
