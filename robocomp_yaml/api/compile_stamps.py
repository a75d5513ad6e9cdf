"""The stamps of compiles. A compile whose stamp holds is up to date, and is skipped."""

from __future__ import annotations

import os
from collections.abc import Sequence

import msgspec

from robocomp_yaml.api.outcome import Outcome
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.transactions import stamp


class CompileArguments(msgspec.Struct, frozen=True):
    """The arguments of a compile that decide what it writes: each combination has a stamp of its own."""

    paths: Sequence[str]
    include: Sequence[str]
    output: str | None = None
    targets: Sequence[str] = ()
    standalone: bool = False

    def location(self) -> tuple[str, str]:
        """The folder that has the stamp, and the stamp's name in it."""
        words = ["-o", self.output or "", "-I", *self.include, "-t", *self.targets]
        name = stamp.key([*self.paths, *words, *(["alone"] if self.standalone else [])])
        first = self.paths[0]
        return self.output or (first if os.path.isdir(first) else os.path.dirname(first)) or ".", name


def earlier_outcome(arguments: CompileArguments, *, planned: bool = False) -> Outcome | None:
    """What the same compile would report and do; None if the stamp is stale or missing."""
    kept = stamp.load(*arguments.location())
    if kept is None or not stamp.is_current(kept):
        return None
    if kept.plugins:
        from robocomp_yaml.plugins import loading  # the diagnostics in the stamp may use its codes

        loading.load(kept.plugins)
    return Outcome.of_data(kept.replay, planned=planned)


def diagnostics_of_code(
    paths: Sequence[str], include: Sequence[str]
) -> tuple[list[Diagnostic], set[str]] | None:  # fmt: skip
    """What the last compile of these paths reported about the user's code, and the files that have changed since; None
    if there is no stamp, or if other files than those may matter now. Whether its generated files were edited does not
    matter."""
    kept = stamp.load(*CompileArguments(paths, include).location())
    changed = stamp.changed_inputs(kept) if kept is not None else None
    if kept is None or changed is None:
        return None
    from robocomp_yaml.diag.code import Code
    from robocomp_yaml.diag.codes import specific, usage

    of_code = {code.id for family in (specific, usage) for code in vars(family).values() if isinstance(code, Code)}
    return [one for one in Outcome.of_data(kept.replay).diagnostics if one.code in of_code], changed


def keep(new_stamp: stamp.RunStamp, arguments: CompileArguments) -> None:
    """Writes the stamp of a compile with these arguments."""
    stamp.save(*arguments.location(), new_stamp)
