"""A commit that fails changes nothing, and a commit that is killed is rolled back: for each of its calls."""

from __future__ import annotations

import errno
import fcntl
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from disk import OWNER, Disk, always, carry_out, codes, commit, killed_in, once, plan, tree
from robocomp_yaml.transactions import atomic, writer
from robocomp_yaml.transactions.plan import RootPlan


def before(tmp_path: Path) -> None:
    """Two compiled roots, with an edited file."""
    for name in ("one", "two"):
        carry_out(
            plan(
                tmp_path / name,
                always("generated/a", "1\n"),
                always("generated/gone/b", "1\n"),
                once("src/c", "1\n"),
                always("generated/same", "1\n"),
            )
        )
        (tmp_path / name / "generated/a").write_text("mine\n")


def plans(tmp_path: Path) -> list[RootPlan]:
    """All kinds of changes: an edited file, a deletion with its folder, new files in new folders, a new root."""
    changing = (
        always("generated/a", "2\n"),
        always("generated/same", "1\n"),
        once("src/c", "2\n"),
        once("new/deep/d", "2\n"),
        always("bin/e", "2\n", executable=True),
    )
    return [
        plan(tmp_path / "one", *changing),
        plan(tmp_path / "two", *changing),
        RootPlan(str(tmp_path / "three/deep"), "../../one/" + OWNER, (always("x/y", "2\n"),)),
    ]


def stamps(root: Path) -> dict[Path, int]:
    return {path: path.lstat().st_mtime_ns for path in root.rglob("*") if path.is_file()}


def calls_of_a_commit(tmp_path: Path) -> list[str]:
    before(tmp_path)
    changes = writer.prepare(plans(tmp_path))
    with Disk().seen_by_commits() as disk:
        assert not commit(changes)
    return disk.calls


def test_a_failure_at_any_call_changes_nothing(tmp_path: Path) -> None:
    count = len(calls_of_a_commit(tmp_path / "counted"))
    assert count > 50
    root = tmp_path / "root"
    before(root)
    planned = plans(root)
    was, when = tree(root, state=True), stamps(root)
    counted = 0
    for number in range(1, count + 1):
        error = OSError((errno.ENOSPC, errno.EACCES, errno.EIO)[number % 3], "the disk says no")
        changes = writer.prepare(planned)
        with Disk(number, error).seen_by_commits() as disk:
            said = commit(changes)
        if disk.calls[number - 1] == "unlink" and not said:
            break  # the commit was complete, and only temporary files remained
        counted += 1
        assert codes(said) == ["RC6005"] and "the disk says no" in said[0].message
        assert (tree(root, state=True), stamps(root)) == (was, when), f"call {number}, {disk.calls[number - 1]}"
    assert counted > count / 2


def test_ctrl_c_at_any_call_changes_nothing(tmp_path: Path) -> None:
    count = len(calls_of_a_commit(tmp_path / "counted"))
    root = tmp_path / "root"
    before(root)
    planned = plans(root)
    was = tree(root, state=True)
    for number in range(1, count // 2):
        changes = writer.prepare(planned)
        with Disk(number, KeyboardInterrupt()).seen_by_commits(), pytest.raises(KeyboardInterrupt):
            writer.commit(changes)
        assert tree(root, state=True) == was, number


def test_the_next_run_recovers_from_a_kill_at_any_call(tmp_path: Path) -> None:
    count = len(calls_of_a_commit(tmp_path / "counted"))
    after = tree(tmp_path / "counted", state=True)
    for number in range(1, count + 1):
        root = tmp_path / str(number)
        before(root)
        planned = plans(root)
        was = {name: tree(root / name, state=True) for name in ("one", "two")}
        changes = writer.prepare(planned)
        with killed_in(number):
            writer.commit(changes)
        said = writer.recover(planned)
        assert set(codes(said)) <= {"RC6007"}
        for name in ("one", "two"):
            held = tree(root / name, state=True)
            assert held == was[name] or held == {
                path.removeprefix(f"{name}/"): text for path, text in after.items() if path.startswith(f"{name}/")
            }, number
            assert not [path for path in held if ".rcyaml-" in path or "journal" in path]
        assert set(codes(carry_out(*planned)[1])) <= {"RC6004"}
        assert tree(root, state=True) == after, number


def test_edits_after_a_kill_are_kept(tmp_path: Path) -> None:
    """The file was replaced; then the user edited it, before rcyaml ran again."""
    root = tmp_path
    carry_out(plan(root, always("a", "1\n"), always("b", "1\n")))
    planned = plan(root, always("a", "2\n"), always("b", "2\n"), always("new", "2\n"))
    changes = writer.prepare([planned])
    with Disk().seen_by_commits() as disk:
        writer.commit(changes)
    last_move = len(disk.calls) - disk.calls[::-1].index("replace")
    carry_out(plan(root, always("a", "1\n"), always("b", "1\n")))

    changes = writer.prepare([planned])
    with killed_in(last_move):
        writer.commit(changes)
    assert (root / "a").read_text() == "2\n"
    (root / "a").write_text("mine a\n")
    (root / "new").write_text("mine new\n")
    assert codes(writer.recover([planned])) == ["RC6007"]
    held = tree(root)
    assert held["a"] == "mine a\n" and held["new"] == "mine new\n" and held["b"] == "1\n"


def test_a_dry_run_reports_an_interrupted_one_and_changes_nothing(tmp_path: Path) -> None:
    planned = plan(tmp_path, always("a", "1\n"))
    changes = writer.prepare([planned])
    with killed_in(8):
        writer.commit(changes)
    was = tree(tmp_path, state=True)
    assert any("journal" in path for path in was)
    assert codes(writer.prepare([planned]).diagnostics) == ["RC6007"]
    assert tree(tmp_path, state=True) == was


def test_a_disk_without_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A FAT file system has no hard links: copies are used."""
    before(tmp_path)

    def no_links(*_: object, **__: object) -> None:
        raise PermissionError(errno.EPERM, "no links here")

    monkeypatch.setattr(os, "link", no_links)
    was, when = tree(tmp_path, state=True), stamps(tmp_path)
    changes = writer.prepare(plans(tmp_path))
    was, when = tree(tmp_path, state=True), stamps(tmp_path)
    with Disk().seen_by_commits() as disk:
        monkeypatch.setattr(atomic._Commit, "finish", no_links)
        assert codes(commit(changes)) == ["RC6005"]
    assert "replace" in disk.calls
    assert (tree(tmp_path, state=True), stamps(tmp_path)) == (was, when)


def test_a_file_that_changes_before_it_is_written(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("a", "1\n")))
    changes = writer.prepare([plan(tmp_path, always("a", "2\n"), always("b", "2\n"))])
    (tmp_path / "a").write_text("mine\n")
    done = writer.commit(changes)
    assert codes(done.diagnostics) == ["RC6005"] and "run the command again" in done.diagnostics[0].message
    assert [change.action for change in done] == ["refused", "refused"]
    assert tree(tmp_path) == {OWNER: "", "a": "mine\n"}


def test_a_folder_that_becomes_a_link_before_it_is_written(tmp_path: Path) -> None:
    root, outside = tmp_path / "root", tmp_path / "outside"
    outside.mkdir()
    changes = writer.prepare([plan(root, always("generated/a", "2\n"))])
    (root / "generated").symlink_to(outside)
    assert codes(commit(changes)) == ["RC6005"]
    assert not list(outside.iterdir())


def test_two_processes_at_the_same_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    planned = plan(tmp_path, always("a", "1\n"))
    monkeypatch.setattr(atomic, "PATIENCE", 0.1)
    (tmp_path / ".rcyaml").mkdir()
    other = os.open(tmp_path / ".rcyaml", os.O_RDONLY)
    fcntl.flock(other, fcntl.LOCK_EX)
    said = carry_out(planned)[1]
    assert codes(said) == ["RC6005"] and "another rcyaml" in said[0].message
    os.close(other)
    assert not carry_out(planned)[1]


_COMPILE = """
import sys
from robocomp_yaml.transactions import writer
from robocomp_yaml.transactions.plan import FilePlan, RootPlan
root, text = sys.argv[1:]
plans = [RootPlan(root, "o", tuple(FilePlan(f"generated/{n}", text) for n in range(200)))]
print(flush=True)
for _ in range(50):
    writer.recover(plans)
    writer.commit(writer.prepare(plans))
"""


def test_a_real_kill(tmp_path: Path) -> None:
    """Two processes with different plans, one of them killed: the root then has the files of one plan."""
    (tmp_path / "o").touch()
    command = [sys.executable, "-c", _COMPILE, str(tmp_path)]
    one = subprocess.Popen([*command, "one\n"], stdout=subprocess.PIPE)
    two = subprocess.Popen([*command, "two\n"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for process in (one, two):
        assert process.stdout
        process.stdout.readline()
    time.sleep(0.2)
    one.send_signal(signal.SIGKILL)
    one.communicate()
    said = two.communicate()[1]
    assert two.returncode == 0, said
    planned = RootPlan(str(tmp_path), "o", tuple(always(f"generated/{n}", "end\n") for n in range(200)))
    assert not carry_out(planned)[1]
    texts = tree(tmp_path / "generated")
    assert {text for name, text in texts.items() if not name.endswith(".orig")} == {"end\n"}
    assert len(texts) == 200
