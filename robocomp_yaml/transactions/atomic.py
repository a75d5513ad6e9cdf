"""A transaction: all changes happen or none, even if the disk is full or the process is killed."""

from __future__ import annotations

import contextlib
import errno
import itertools
import os
import time
from collections.abc import Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.transactions import whole_file
from robocomp_yaml.transactions.journal import JOURNAL, JOURNAL_DONE, PART, Journal, Mark, clean_up, load, put_back
from robocomp_yaml.transactions.output_root import STATE, Root, contents, folders_of
from robocomp_yaml.transactions.plan import ANYBODY

PATIENCE = 10.0
"""Seconds to wait for another rcyaml process that writes into the same root."""

_NO_LINKS = (errno.EPERM, errno.EMLINK, errno.ENOSYS, errno.EOPNOTSUPP)


class WriteFailed(Exception):
    """A transaction failed, and nothing was changed. `path` is relative to `root` ('' for the root itself)."""

    def __init__(self, root: str, path: str, reason: str) -> None:
        super().__init__(f"{root}/{path}: {reason}")
        self.root, self.path, self.reason = root, path, reason


class FileStep(msgspec.Struct, frozen=True):
    """The change of one file: from `before` (None: the file does not exist) to `after` (None: the file is deleted).

    `mode` are the permissions of an existing file, None for a new one; `rights` are the permissions that group and
    others may have at most. `orig` is a name under which the existing file is kept. `hash` is the digest of `after`, if
    it is known.
    """

    path: str
    before: bytes | None
    after: bytes | None
    executable: bool = False
    mode: int | None = None
    orig: str = ""
    rights: int = ANYBODY
    hash: str = ""


def carry_out(steps: Mapping[str, Sequence[FileStep]]) -> None:
    """Makes all changes: the steps of each root, which is a folder without symbolic links in its path. Raises
    WriteFailed if a change cannot be made; then nothing is changed."""
    running = [_Commit(root, steps[root]) for root in sorted(steps)]
    _make_room_for_locks(len(running))
    with contextlib.ExitStack() as locks:
        busy: _Commit | None = None
        try:
            for busy in running:
                busy.open(locks)
            for phase in (_Commit.verify, _Commit.stage, _Commit.apply, _Commit.finish):
                for busy in running:
                    phase(busy)
        except BaseException as error:
            for commit in reversed(running):
                commit.undo()
            if busy and isinstance(error, OSError):
                raise WriteFailed(busy.root, busy.at, reason_of(error)) from error
            raise
        for commit in running:
            # The transaction is complete. The next run removes what cannot be removed now.
            with contextlib.suppress(OSError):
                clean_up(commit.root, commit.journal)


def recover(root: str) -> bool:
    """Completes or rolls back an interrupted transaction of a root. Returns whether something was rolled back. Raises
    OSError, and WriteFailed if another process holds the lock."""
    if not any(os.path.lexists(os.path.join(root, name)) for name in (JOURNAL, JOURNAL_DONE)):
        return False
    if not stays_inside(root, STATE):
        return False
    with locked(root):
        journal, done = load(root)
        if journal is None:
            return False
        if done:
            clean_up(root, journal)
        else:
            put_back(root, journal)
        return not done


@contextlib.contextmanager
def locked(root: str) -> Iterator[None]:
    """Holds the lock of a root, which is on its `.rcyaml` folder and ends with the process. Raises WriteFailed if
    another process holds the lock for more than PATIENCE."""
    folder = os.path.join(root, STATE)
    until = time.monotonic() + PATIENCE
    while True:
        lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            if _acquire(lock) and os.path.exists(folder) and os.path.samestat(os.fstat(lock), os.stat(folder)):
                yield
                return
        finally:
            os.close(lock)
        if time.monotonic() > until:
            raise WriteFailed(root, "", "another rcyaml process is writing to it")
        time.sleep(0.02)
        # The process that held the lock may have removed the folder, which it had created.
        os.makedirs(folder, exist_ok=True)


def _acquire(lock: int) -> bool:
    with contextlib.suppress(OSError):  # the file system has no locks: `verify` still detects changes
        return whole_file.lock(lock)
    return True


def _make_room_for_locks(count: int) -> None:
    if count > 200:
        import resource

        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, min(hard, count + 200)), hard))


_numbers = itertools.count()  # shared by all commits: two roots may have a folder in common


class _Commit(msgspec.Struct):
    """The commit of one root, phase by phase. `at` is the path of the current step, for errors; `made` are the folders
    created for the journal; `under_way`: the journal exists."""

    root: str
    steps: Sequence[FileStep]
    journal: Journal = Journal(())
    at: str = ""
    made: list[str] = []
    under_way: bool = False

    def open(self, locks: contextlib.ExitStack) -> None:
        if not stays_inside(self.root, STATE):
            raise WriteFailed(self.root, STATE, "it is a link to a folder outside")
        for folder in _missing_folders("/", os.path.join(self.root, STATE, "x").lstrip("/")):
            os.makedirs("/" + folder, exist_ok=True)
            self.made.append("/" + folder)
        locks.enter_context(locked(self.root))

    def verify(self) -> None:
        """Raises WriteFailed if the disk changed since the plan, or a folder became a link to outside."""
        if load(self.root)[0] is not None:
            raise WriteFailed(self.root, "", "another run was interrupted in the meantime: run the command again")
        root = Root(self.root)
        for step in self.steps:
            self.at = step.path
            status = root.status(step.path)
            if status.problem:
                raise WriteFailed(self.root, step.path, status.problem)
            if (status.data if status.exists else None) != step.before or (
                step.orig and os.path.lexists(os.path.join(self.root, step.orig))
            ):
                raise WriteFailed(
                    self.root, step.path, "it was changed while rcyaml was running: run the command again"
                )

    def stage(self) -> None:
        self.at = JOURNAL
        above = dict.fromkeys(os.path.dirname(step.path) for step in self.steps if step.after is not None)
        folders = dict.fromkeys(missing for folder in above for missing in _missing_folders(self.root, f"{folder}/x"))
        marks = tuple(_mark(step, next(_numbers)) for step in self.steps)
        self.journal = Journal(marks, tuple(folders))
        self.under_way = True
        self.journal.save(self.root)
        for folder in folders:
            self.at = folder
            os.mkdir(os.path.join(self.root, folder))
        for step, mark in zip(self.steps, marks, strict=True):
            self.at = step.path
            if step.after is not None:
                default = limited(0o777 if step.executable else 0o666, step.rights)
                mode = None if step.mode is None else limited(step.mode, step.rights)
                whole_file.stage(os.path.join(self.root, mark.new), step.after, mode, default)
            if mark.old:
                _second_name(os.path.join(self.root, step.path), os.path.join(self.root, mark.old))

    def apply(self) -> None:
        for step, mark in zip(self.steps, self.journal.marks, strict=True):
            self.at = mark.path
            target = os.path.join(self.root, mark.path)
            if mark.orig:
                orig = os.path.join(self.root, mark.orig)
                _second_name(target, orig)
                if step.rights != ANYBODY and not os.path.islink(orig):
                    os.chmod(orig, limited(os.stat(orig).st_mode & 0o7777, step.rights))
            if mark.new:
                os.replace(os.path.join(self.root, mark.new), target)
            elif mark.old:
                os.unlink(target)

    def finish(self) -> None:
        self.at = JOURNAL
        os.replace(os.path.join(self.root, JOURNAL), os.path.join(self.root, JOURNAL_DONE))

    def undo(self) -> None:
        """Rolls the commit back. If that fails, the journal stays, and the next run tries again."""
        with contextlib.suppress(OSError):
            if self.under_way:
                put_back(self.root, self.journal)
            for folder in reversed(self.made):
                os.rmdir(folder)


def _missing_folders(root: str, path: str) -> list[str]:
    """The folders of a path that do not exist, the outermost first."""
    return [folder for folder in folders_of(path) if not os.path.isdir(os.path.join(root, folder))]


def _mark(step: FileStep, number: int) -> Mark:
    name = os.path.join(os.path.dirname(step.path), f".rcyaml-{os.getpid()}-{number}")
    return Mark(
        step.path,
        new=f"{name}.new" if step.after is not None else "",
        old=f"{name}.old" if step.before is not None else "",
        orig=step.orig,
        hash=step.hash or (digest(step.after) if step.after is not None else ""),
        created=step.before is None,
    )


def limited(mode: int, rights: int) -> int:
    """Permissions with at most `rights` for group and others, who may execute only what they may read."""
    return mode & (0o7700 | rights | (rights & 0o044) >> 2)


def _second_name(path: str, name: str) -> None:
    """Gives a file a second name: a hard link, or a copy if the file system has no hard links."""
    try:
        os.link(path, name, follow_symlinks=False)
    except OSError as error:
        if error.errno not in _NO_LINKS:
            raise
        if os.path.islink(path):
            os.symlink(os.readlink(path), name)
            return
        status = os.stat(path)
        whole_file.stage(name + PART, contents(path), status.st_mode & 0o7777)
        os.utime(name + PART, ns=(status.st_atime_ns, status.st_mtime_ns))
        # A rollback uses this name, so that it must never name an incomplete copy.
        os.rename(name + PART, name)
