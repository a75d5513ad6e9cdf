"""Atomic writing of one file."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from robocomp_yaml.transactions import whole_file


def without_unnamed_files(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(whole_file, "_create_unnamed", refuse)


@pytest.mark.parametrize("old", [False, True])
def test_create_replaces_nothing(old: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if old:
        without_unnamed_files(monkeypatch)
    whole_file.create(tmp_path / "a", "1\n")
    with pytest.raises(FileExistsError):
        whole_file.create(tmp_path / "a", "2\n")
    (tmp_path / "b").symlink_to("nowhere")
    with pytest.raises(FileExistsError):
        whole_file.create(tmp_path / "b", "2\n")
    assert (tmp_path / "a").read_text() == "1\n" and sorted(os.listdir(tmp_path)) == ["a", "b"]


def test_a_created_file_has_the_permissions_of_new_files(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        whole_file.create(tmp_path / "a", "")
    finally:
        os.umask(before)
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o640


def test_replace_keeps_permissions_and_links(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("1\n")
    (tmp_path / "a").chmod(0o600)
    (tmp_path / "link").symlink_to("a")
    whole_file.replace(tmp_path / "link", b"2\n")
    assert (tmp_path / "a").read_text() == "2\n" and (tmp_path / "link").is_symlink()
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o600


def test_temporary_files_of_killed_processes_are_removed(tmp_path: Path) -> None:
    (tmp_path / ".a.999999999.part").write_text("ha")
    (tmp_path / f".a.{os.getppid()}.part").write_text("of a process that runs")
    (tmp_path / ".a.mine.part").write_text("")
    whole_file.replace(tmp_path / "a", b"1\n")
    assert sorted(os.listdir(tmp_path)) == sorted(["a", f".a.{os.getppid()}.part", ".a.mine.part"])


def test_a_pipe_receives_the_content(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    got: list[str] = []
    reader = threading.Thread(target=lambda: got.append((tmp_path / "pipe").read_text()))
    reader.start()
    whole_file.replace(tmp_path / "pipe", b"hello")
    reader.join(5)
    assert got == ["hello"]


def test_put_replaces_a_link(tmp_path: Path) -> None:
    (tmp_path / "yours").write_text("1\n")
    (tmp_path / "a").symlink_to("yours")
    whole_file.put(tmp_path / "a", b"2\n", 0o600)
    assert (tmp_path / "yours").read_text() == "1\n" and not (tmp_path / "a").is_symlink()
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o600 and sorted(os.listdir(tmp_path)) == ["a", "yours"]
