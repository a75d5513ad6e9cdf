"""A key that was being made when its process was killed does not stay."""

from __future__ import annotations

import os
from pathlib import Path

from robocomp_yaml.deploy import openssl
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles

NOBODY = 1 << 30  # no process can have this pid


def unfinished(folder: Path, pid: int) -> Path:
    work = folder / f"making-{pid}-abc"
    work.mkdir(parents=True)
    (work / "key").write_text("secret")
    return work


def test_only_those_of_killed_processes_are_removed(tmp_path: Path) -> None:
    dead, alive, other = unfinished(tmp_path, NOBODY), unfinished(tmp_path, os.getpid()), tmp_path / "hosts"
    other.mkdir()
    openssl.remove_unfinished(str(tmp_path))
    assert [path.exists() for path in (dead, alive, other)] == [False, True, True]
    openssl.remove_unfinished(str(tmp_path / "nothing"))


def test_down_removes_them(tmp_path: Path) -> None:
    files = GridFiles(str(tmp_path))
    dead = unfinished(Path(files.root), NOBODY)
    files.drop_configurations(with_key=True)
    assert not dead.exists()
