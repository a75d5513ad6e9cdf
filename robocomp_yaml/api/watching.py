"""What has to be watched for changes after a run, and which changes need another one."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping

from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag.listing import some
from robocomp_yaml.source.discover import finds_again, is_skipped
from robocomp_yaml.source.disk import Disk, documents_in, names_in, state_of
from robocomp_yaml.source.real_paths import RealPaths
from robocomp_yaml.source.text import read_bytes

_SOURCES = "src"
Version = tuple[int, int]
"""What a file has another one of after it was written: when it was changed, and its inode."""


def folders(workspace: Workspace, paths: Iterable[str], home: str) -> list[str]:
    """The folders with everything that a run of these paths in the folder `home` depends on, none inside another
    one."""
    analysis, needed = workspace.analysis, set[str]()
    for path in paths:
        needed.add(os.path.dirname(path) if path.endswith(".yaml") else path)
    needed |= {os.path.dirname(document.path) for document in analysis.documents.values()}
    for settings in analysis.workspaces.declared:
        needed |= {settings.root, *settings.interfaces}
    needed |= {*analysis.search.extra}
    reals = RealPaths()
    real = sorted({reals.of(os.path.join(home, folder)) for folder in needed})
    outer: list[str] = []
    for folder in real:
        if not any(folder == other or folder.startswith(os.path.join(other, "")) for other in outer):
            outer.append(folder)
    return outer


class Concern:
    """Whether a run that used this workspace depends on a path below the watched `folders`. `written` are the files
    that the run itself wrote, with their versions then."""

    def __init__(self, workspace: Workspace, folders: Iterable[str], written: Mapping[str, Version]) -> None:
        self._disk, self._folders, self._written = workspace.analysis.disk, tuple(folders), written
        real = self._disk.real
        self._asked = set(map(real, (*self._disk.contents, *self._disk.states)))
        self._sources = tuple(
            os.path.join(real(os.path.dirname(linked.component.path)), _SOURCES, "")
            for linked in workspace.analysis.program.components.values()
        )

    def about(self, path: str) -> bool:
        """Whether a change of this file or folder may change the result."""
        real = os.path.join(os.path.realpath(os.path.dirname(path)), os.path.basename(path))
        if self.is_own(real):
            return False
        if real in self._asked or self.is_source(real):
            return True
        is_possible = real.endswith(".yaml") or not os.path.isfile(real)
        return is_possible and not is_skipped(
            next((real[len(one) :] for one in self._folders if real.startswith(one)), "")
        )

    def is_own(self, real: str) -> bool:
        """Whether it is as the run itself wrote it."""
        return real in self._written and self._written[real] == _version(real)

    def is_source(self, path: str) -> bool:
        """Whether it is the user's code, as it is saved: not a file that editors add for a moment."""
        name = os.path.basename(path)
        is_temporary = name.startswith((".", "#")) or name.endswith(("~", ".swp", ".tmp", ".pyc")) or name.isdigit()
        return path.startswith(self._sources) and "__pycache__" not in path and not is_temporary


def is_current(disk: Disk, concern: Concern) -> bool:
    """Whether a run would read the same from the disk again, apart from what the run itself wrote."""

    def is_own(path: str) -> bool:
        return concern.is_own(os.path.realpath(path))

    return (
        all(read_bytes(path)[0] == raw or is_own(path) for path, raw in disk.contents.items())
        and all(state_of(path) == state or is_own(path) for path, state in disk.states.items())
        and all(documents_in(names_in(folder)) == listed for folder, listed in disk.listed.items())
        and all(names_in(folder) == names for folder, names in disk.seen.items())
        and finds_again(disk.walked)
        and not disk.unreadable
    )


def shown(paths: Iterable[str]) -> str:
    """Some of the changed paths, for people: documents first."""
    names = sorted({_relative(path) for path in paths}, key=lambda name: (not name.endswith(".yaml"), name))
    return some(names)


def _relative(path: str) -> str:
    relative = os.path.relpath(path)
    return path if relative.startswith(os.pardir) else relative


def versions(paths: Iterable[str]) -> dict[str, Version]:
    """The versions of files that a run has written, by their real paths."""
    real = RealPaths()
    return {each: _version(each) for each in map(real.of, paths)}


def _version(path: str) -> Version:
    try:
        status = os.stat(path)
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_ino
