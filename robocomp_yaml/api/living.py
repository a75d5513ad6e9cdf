"""A living analysis: documents that are analysed again after each change, with the results that the change does not
concern kept.

Documents are kept by their content, parameters with their compiled gates, linked documents, effective values and
configurations of processes by what they depend on. `memory` explains how. The result is always that of a fresh
analysis.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from robocomp_yaml.api.refusals import require_paths
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.garbage import uncollected
from robocomp_yaml.memory import Memory
from robocomp_yaml.pipeline import alone
from robocomp_yaml.source.disk import Disk, KeptFiles
from robocomp_yaml.source.text import encoded


class LivingWorkspace:
    """The documents at some paths, on the disk or unsaved in an editor. Not for several threads at once; the working
    folder stays the same."""

    def __init__(self, paths: Sequence[str] = (".",), include: Iterable[str] = ()) -> None:
        require_paths(*paths)
        self.paths, self.include = tuple(paths), tuple(include)
        self._unsaved: dict[str, tuple[str, bytes]] = {}
        self._memory, self._files = Memory(), KeptFiles()

    @property
    def unsaved(self) -> dict[str, bytes]:
        """The texts of unsaved documents, by path."""
        return dict(self._unsaved.values())

    def edit(self, path: str, text: str | bytes | None) -> None:
        """Replaces the text of a document, whether or not the file exists. None: the file counts again."""
        require_paths(path)
        real = Disk().real(path)
        if text is None:
            self._unsaved.pop(real, None)
        else:
            self._unsaved[real] = path, encoded(text) if isinstance(text, str) else text

    def refresh(self) -> None:
        """Files may have changed on the disk: they are read again, and `look` notices what has changed."""
        self._files.renew()

    def look(self, *paths: str, on_read: Callable[[str], None] | None = None) -> Workspace:
        """The documents at these paths, which may be others than those of this workspace, and all that they refer to.
        Does not notice changes on the disk since the last `refresh` or `load`."""
        require_paths(*paths)
        with uncollected():
            return Workspace(paths, self.include, self.unsaved, on_read, self._memory, self._files)

    def glance(self, path: str) -> list[Diagnostic]:
        """The diagnostics of a document by itself, of its syntax and shape. Nothing else is read."""
        require_paths(path)
        with uncollected():
            return alone(path, self.unsaved, self._memory, self._files)

    def load(
        self, on_read: Callable[[str], None] | None = None, on_make: Callable[[], None] | None = None
    ) -> Workspace:
        """All documents, as `api.load` reads them. `on_make` is called again and again, and may raise an exception to
        give up."""
        self._memory.on_make = on_make or self._memory.on_make
        try:
            self.refresh()
            workspace = self.look(*self.paths, on_read=on_read)
        finally:
            self._memory.on_make = lambda: None
        self._memory.forget_unused()
        return workspace
