"""Shared by tests of the writer: trees on the disk, and calls of `os` that fail during a commit."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import pytest

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.transactions import atomic, journal, whole_file, writer
from robocomp_yaml.transactions.changes import Changes
from robocomp_yaml.transactions.plan import ALWAYS, ONCE, FilePlan, RootPlan

OWNER = "speech.cdsl.yaml"


def always(path: str, text: str, *, executable: bool = False) -> FilePlan:
    return FilePlan(path, text, ALWAYS, executable)


def once(path: str, text: str) -> FilePlan:
    return FilePlan(path, text, ONCE)


def plan(root: Path, *files: FilePlan, owner: str = OWNER, partial: bool = False) -> RootPlan:
    """A plan of an owner that exists."""
    document = root / owner
    document.parent.mkdir(parents=True, exist_ok=True)
    document.touch()
    return RootPlan(str(root), owner, files, partial)


def carry_out(*plans: RootPlan, adopt: bool = False) -> tuple[Changes, list[Diagnostic]]:
    """As `rcyaml compile` does it."""
    diagnostics = writer.recover(plans)
    changes = writer.commit(writer.prepare(plans, adopt=adopt))
    return changes, [*diagnostics, *changes.diagnostics]


def commit(prepared: Changes) -> list[Diagnostic]:
    """The diagnostics of the commit itself."""
    return list(writer.commit(prepared).diagnostics[len(prepared.diagnostics) :])


def actions(changes: Changes, root: Path) -> dict[str, str]:
    return {os.path.relpath(change.path, root): change.action for change in changes}


def codes(diagnostics: Iterable[Diagnostic]) -> list[str]:
    return [diagnostic.code for diagnostic in diagnostics]


def tree(root: Path, *, state: bool = False) -> dict[str, str | None]:
    """Every file below a folder with its text (links as `-> target`, folders as None), without the state of rcyaml."""
    found: dict[str, str | None] = {}
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root).as_posix()
        if not state and name.split("/")[0] == ".rcyaml":
            continue
        if path.is_symlink():
            found[name] = f"-> {os.readlink(path)}"
        else:
            found[name] = None if path.is_dir() else path.read_text()
    return found


def files(root: Path) -> dict[str, str]:
    return {name: text for name, text in tree(root).items() if text is not None and name != OWNER}


class Disk:
    """The `os` module of a commit. Calls that change something are counted; the one with number `fail_at` raises or
    calls `error`."""

    CHANGING = ("open", "write", "replace", "rename", "link", "unlink", "mkdir", "makedirs", "fchmod")

    def __init__(self, fail_at: int = 0, error: BaseException | Callable[[], None] | None = None) -> None:
        self.calls: list[str] = []
        self.fail_at = fail_at
        self.error = error

    def __getattr__(self, name: str) -> object:
        real = getattr(os, name)
        if name not in self.CHANGING:
            return real

        def counted(*args: object, **kwargs: object) -> object:
            self.calls.append(name)
            if len(self.calls) == self.fail_at and self.error is not None:
                if isinstance(self.error, BaseException):
                    raise self.error
                self.error()
            return real(*args, **kwargs)

        return counted

    @contextlib.contextmanager
    def seen_by_commits(self) -> Iterator[Disk]:
        with pytest.MonkeyPatch.context() as patch:
            for module in (atomic, journal, whole_file):
                patch.setattr(module, "os", self)
            yield self


class Killed(BaseException):
    """Simulates the end of the process: with `killed_in`, the rest of a commit does not run."""


@contextlib.contextmanager
def killed_in(number: int) -> Iterator[None]:
    """A commit in this block ends at its n-th changing call without any cleanup, as by SIGKILL."""
    with pytest.MonkeyPatch.context() as patch, Disk(number, Killed()).seen_by_commits(), contextlib.suppress(Killed):
        patch.setattr(atomic._Commit, "undo", lambda commit: None)
        yield
