"""Unsaved texts count as files do, everywhere between paths and diagnostics."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Files, Repeated
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.disk import FILE, FOLDER, NOTHING, OTHER, Disk


def _checked(row: Code) -> list[str] | None:
    """The paths that an example's `rcyaml check PATH…` names; None where it is another command."""
    words = shlex.split(row.command)
    return words[1:] if words[0] == "check" and not any(word[0] in "-*" for word in words) else None


def _is_text(files: Files) -> bool:
    return all(isinstance(it, str | bytes | Repeated) and not str(it).startswith("-> ") for it in files.values())


ROWS = [row for row in table().values() if _checked(row) and _is_text(row.wrong)]


def _facts(analysis: Analysis) -> object:
    # Who may read a text that is not saved yet is not known.
    told = [one for one in analysis.diagnostics if one.code not in ("RC3311", "RC4310", "RC4311")]
    networks = [(network.name, sorted(network.processes)) for network in analysis.networks.values()]
    return told, analysis.discovered.documents, analysis.program.documents, networks


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_a_tree_that_is_nowhere_saved_says_the_same(row: Code, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The example on the disk, and in a folder where no file of it is, or where each holds something else."""
    paths = _checked(row)
    assert paths
    texts = {name: it if isinstance(it, bytes) else str(it).encode() for name, it in row.wrong.items()}
    saved = write_tree(tmp_path / "saved", texts)
    monkeypatch.chdir(saved)
    expected = _facts(analyse(paths))
    for before in ({}, dict.fromkeys(texts, b"\xff: [")):
        other = tmp_path / f"other{len(before)}"
        other.mkdir()
        monkeypatch.chdir(write_tree(other, before))
        assert _facts(analyse(paths, overlay=texts)) == expected


def test_hidden_files_are_no_documents(tmp_path: Path) -> None:
    """Emacs' lock is a link to nowhere, and macOS writes `._NAME` beside files on other systems' disks."""
    folder = write_tree(
        tmp_path, {"arm.cdsl.yaml": "component: Arm\nlanguage: python\n", "._arm.cdsl.yaml": b"\0\5\x16"}
    )
    (folder / ".#arm.cdsl.yaml").symlink_to("me@here.1:2")
    write_tree(tmp_path, {"robot.ddsl.yaml": f"deployment: D\ncomponents: {{arm: {{component: {tmp_path}}}}}\n"})
    analysis = analyse([str(folder)])
    assert [Path(path).name for path in analysis.discovered.documents] == ["arm.cdsl.yaml", "robot.ddsl.yaml"]
    assert not [one for one in analysis.diagnostics if one.severity == "error"]
    assert not analyse([str(folder / "arm.cdsl.yaml")]).diagnostics


def test_what_was_read_and_missed_is_remembered(tmp_path: Path) -> None:
    write_tree(tmp_path, {"a": "1", "b": "2"})
    disk = Disk({str(tmp_path / "b"): b"3", str(tmp_path / "new/c"): b"4"})
    a, b, c, d = (str(tmp_path / name) for name in ("a", "b", "new/c", "d"))
    assert [disk.read(path)[0] for path in (a, b, c)] == [b"1", b"3", b"4"]
    assert [disk.has_file(path) for path in (a, b, c, d, str(tmp_path))] == [True, True, True, False, False]
    assert disk.contents == {a: b"1", b: b"3", c: b"4"}
    assert disk.states == {a: FILE, b: FILE, c: FILE, d: NOTHING, str(tmp_path): FOLDER}
    write_tree(tmp_path, {"x.yaml": "", "e/y.YAML": ""})
    os.symlink("nowhere", tmp_path / "link")
    assert disk.names(str(tmp_path)) == ["a", "b", "e", "link", "new", "x.yaml"]
    assert [disk.documents(path) for path in (str(tmp_path), d, str(tmp_path / "e"))] == [["x.yaml"], [], ["y.YAML"]]
    assert disk.listed == {str(tmp_path): ["x.yaml"], d: [], str(tmp_path / "e"): ["y.YAML"]}
    assert disk.state(str(tmp_path / "link")) == OTHER and disk.state(str(tmp_path / "new")) == FOLDER
    assert disk.has_folder(str(tmp_path / "new")) and not disk.has_folder(str(tmp_path / "old"))


def test_the_way_up_from_a_folder_that_is_not_saved(tmp_path: Path) -> None:
    write_tree(tmp_path, {"a": "1", "x.yaml": ""})
    disk = Disk({str(tmp_path / "new/c"): b"4"})
    above = str(tmp_path / "new" / "..")
    assert disk.has_file(f"{above}/a") and disk.read(f"{above}/a")[0] == b"1" and disk.peek(f"{above}/a", 1) == b"1"
    assert disk.documents(above) == ["x.yaml"] and not disk.has_file(f"{above}/b")


def test_a_walk_is_sorted_and_can_be_cut(tmp_path: Path) -> None:
    write_tree(tmp_path, {"b/x": "", "b/c/y": "", "a": "", "d/z": ""})
    (tmp_path / "e").symlink_to("b")
    disk = Disk({str(tmp_path / "b/w"): b"", str(tmp_path / "c/v"): b""})
    seen = []
    for where, folders, names in disk.walk(str(tmp_path)):
        seen.append((os.path.relpath(where, tmp_path), list(folders), names))
        folders[:] = [name for name in folders if name != "d"]
    assert seen == [
        (".", ["b", "c", "d", "e"], ["a"]), ("b", ["c"], ["w", "x"]), ("b/c", [], ["y"]), ("c", [], ["v"]),
    ]  # fmt: skip


def test_a_pipe_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    disk = Disk()
    assert disk.peek(str(tmp_path / "pipe"), 10) == b"" and disk.read(str(tmp_path / "pipe"))[0] is None
