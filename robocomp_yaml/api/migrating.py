"""Migrating legacy files, as data."""

from __future__ import annotations

from collections.abc import Sequence

from robocomp_yaml.api.outcome import File
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy import migration, outputs
from robocomp_yaml.legacy.migration import Progress
from robocomp_yaml.legacy.result import MigrationRun
from robocomp_yaml.legacy.settings.plan import Corrections
from robocomp_yaml.pipeline import search_folders

_ACTIONS = {
    outputs.CREATED: "create", outputs.CHANGED: "update", outputs.UPGRADED: "update", outputs.UNCHANGED: "unchanged",
    outputs.EDITED: "kept", outputs.TAKEN: "refused", outputs.FAILED: "refused",
}  # fmt: skip


class Migration:
    """A migration of legacy files. Nothing is written before `apply`, except that an interrupted earlier run is rolled
    back.

    `run` has all results, and is for the command line only.
    """

    def __init__(
        self, paths: Sequence[str], output: str | None, include: Sequence[str], *, force: bool = False,
        exact: bool = False, guesses: Corrections = Corrections(), progress: Progress = iter,
    ) -> None:  # fmt: skip
        self._include = tuple(include)
        self.run: MigrationRun = migration.migrate(
            paths, output, search_folders(self._include), force=force, progress=progress, guesses=guesses, exact=exact
        )

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All diagnostics of the legacy files; after `apply` also those of `check` on the documents."""
        return self.run.diagnostics

    @property
    def has_errors(self) -> bool:
        """Whether a file was rejected, or could not be written."""
        return self.run.failed

    @property
    def files(self) -> tuple[File, ...]:
        """The documents, each with its action and a unified diff."""
        return tuple(
            File(root.root.path, path, _ACTIONS[output.state], diff=output.diff(path))
            for root in self.run.roots.values()
            for output in root.outputs
            for path in [root.root.shown(output.path)]
        )

    @property
    def lost(self) -> int:
        """How many lines of the sources are in no document."""
        return sum(entry.lines()["lost"] for entry in self.run.entries)

    def apply(self) -> None:
        """Writes the documents, and checks what was written. A file that was edited since is kept. A file that could
        not be written is reported in `diagnostics`."""
        self.run.write()
        migration.check_written(self.run, self._include)
