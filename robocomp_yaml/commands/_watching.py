"""`--watch`: a run after each change, until Ctrl-C.

The folders are watched in a thread, so that signals reach the main thread. A pause of a tenth of a second ends a change
of many files. Folders that are deleted and made again, as by `git checkout`, are watched again.
"""

from __future__ import annotations

import gc
import os
import threading
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from queue import Empty, Queue
from types import ModuleType
from typing import NoReturn

import click

from robocomp_yaml.api.living import LivingWorkspace
from robocomp_yaml.api.watching import Concern, Version, folders, is_current, shown, versions
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag import extras, terminal
from robocomp_yaml.diag.errors import Faulty, Refused, reason_of
from robocomp_yaml.diag.render import tell
from robocomp_yaml.garbage import settle

PAUSE, LONGEST = 100, 3000  # milliseconds
_LOOK = 1.0  # seconds after which the watched folders are looked at


class _Watcher:
    """Puts the paths of changes into a queue; an empty set if the watched folders are no longer the same."""

    def __init__(self, watchfiles: ModuleType, paths: Sequence[str], changes: Queue[set[str]]) -> None:
        self._watchfiles, self._changes, self._stop = watchfiles, changes, threading.Event()
        self.paths = [path for path in paths if os.path.isdir(path)]
        self.asked, self._identities = tuple(paths), _identities(paths)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        if not self.paths:
            return
        try:
            for changes in self._watchfiles.watch(
                *self.paths, watch_filter=None, debounce=LONGEST, step=PAUSE, stop_event=self._stop, rust_timeout=500,
                ignore_permission_denied=True,
            ):  # fmt: skip
                self._changes.put({path for _, path in changes})
        except OSError:  # a folder has gone meanwhile
            self._changes.put(set())

    @property
    def is_valid(self) -> bool:
        return _identities(self.asked) == self._identities

    def stop(self) -> None:
        self._stop.set()


def _identities(paths: Iterable[str]) -> list[tuple[int, int] | None]:
    found: list[tuple[int, int] | None] = []
    for path in paths:
        try:
            status = os.stat(path)
            found.append((status.st_dev, status.st_ino))
        except OSError:
            found.append(None)
    return found


def watch(
    ctx: click.Context, paths: Sequence[str], include: Sequence[str], run: Callable[[Workspace], Sequence[str]]
) -> NoReturn:  # fmt: skip
    """Runs, and runs again after each change. `run` prints its block, and returns the files that it wrote."""
    try:
        import watchfiles
    except ImportError:
        raise click.UsageError(f"--watch needs watchfiles: {extras.command('watch')}", ctx) from None
    loop = _Loop(paths, LivingWorkspace(paths, include), run, Queue(), watchfiles, os.getcwd())
    loop.run_once()
    settle()
    loop.watch()
    if ctx.obj.verbosity >= 0:
        terminal.say(f"watching {shown(loop.watcher.paths) or 'nothing'}; Ctrl-C ends it", err=True)
    while True:
        if changed := loop.next_change():
            if ctx.obj.verbosity >= 0:
                terminal.say("", f"{shown(changed)} changed")
            loop.run_once()
            gc.collect()


class _Loop:
    """The state between two runs. `workspace` is that of the last run, `written` has its files with their versions."""

    watcher: _Watcher
    workspace: Workspace

    def __init__(
        self, paths: Sequence[str], living: LivingWorkspace, run: Callable[[Workspace], Sequence[str]],
        changes: Queue[set[str]], watchfiles: ModuleType, home: str,
    ) -> None:  # fmt: skip
        self.paths, self.living, self.run, self.changes = paths, living, run, changes
        self.watchfiles, self.home = watchfiles, home
        self.written: dict[str, Version] = {}
        self.concern: Concern | None = None  # of the last run, and the watched folders
        self.folders: list[str] = []  # that the last run depends on
        self.is_sure = False  # that nothing changed before the folders were watched
        self.failed = False  # the folder had gone at the last run

    def run_once(self) -> None:
        self.written, self.concern, self.failed = {}, None, False
        try:
            os.chdir(self.home)  # if it was deleted and made again, it is another folder
            self.workspace = self.living.load()
            self.folders = folders(self.workspace, self.paths, self.home)
            self.written = versions(self.run(self.workspace))
        except Faulty as faulty:
            tell("text", faulty.diagnostics, faulty.documents)
        except Refused as refused:
            terminal.say(f"Error: {refused}", err=True)
        except OSError as error:  # a folder has gone while it was read or written
            self.failed = True
            terminal.say(f"Error: {error.filename or self.home}: {reason_of(error)}", err=True)

    def watch(self) -> None:
        self.watcher = _Watcher(self.watchfiles, self.folders, self.changes)
        self.concern, self.is_sure = None, False

    def next_change(self) -> set[str]:
        """The next changed paths on which the result may depend; none if it turns out not to."""
        changed = self._changed()
        if not self.watcher.is_valid or self.folders != list(self.watcher.asked):
            self.watcher.stop()
            self.watch()
        if self.concern is None:
            self.concern = Concern(self.workspace, self.watcher.asked, self.written)
        concern, disk = self.concern, self.workspace.analysis.disk
        concerning = {path for path in changed if concern.about(path)}
        if changed and not concerning:
            return set()
        if any(map(concern.is_source, concerning)):
            return concerning
        if self.failed and not os.path.isdir(self.home):
            return set()
        with suppress(OSError):
            os.chdir(self.home)
            if not self.failed and (is_current(disk, concern) or (disk.unreadable and not concerning)):
                return set()
        return concerning or {*self.watcher.asked}

    def _changed(self) -> set[str]:
        """The changed paths; none if the folders have to be looked at."""
        while True:
            try:
                found = self.changes.get(timeout=_LOOK)
            except Empty:
                if self.watcher.is_valid and self.is_sure:
                    continue
                self.is_sure = True
                return set()
            while not self.changes.empty():
                found |= self.changes.get_nowait()
            return found
