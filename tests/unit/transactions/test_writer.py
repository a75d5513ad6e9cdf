"""The writer: what happens to each file, for its content, the manifest and the plan."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from disk import actions, always, carry_out, codes, files, once, plan, tree
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.transactions import writer
from robocomp_yaml.transactions.plan import FilePlan, Merge, Merges

CONFIG = "etc/config"


def stated(text: str, *users: str, base: str = "") -> FilePlan:
    """A generated property file, with the document that it is generated from, and the user's properties."""
    return FilePlan(CONFIG, text, stated_in=f"{CONFIG}.yaml", users=users, base=base)


def test_the_first_compile_writes_everything(tmp_path: Path) -> None:
    changes, said = carry_out(
        plan(
            tmp_path,
            always("generated/main.py", "1\n"),
            once("src/specific.py", "2\n"),
            always("bin/Speech", "#!\n", executable=True),
        )
    )
    assert not said
    assert changes.dirty
    assert files(tmp_path) == {"generated/main.py": "1\n", "src/specific.py": "2\n", "bin/Speech": "#!\n"}
    assert (tmp_path / ".rcyaml/base/src/specific.py").read_text() == "2\n"
    assert not (tmp_path / ".rcyaml/base/generated").exists()
    assert os.access(tmp_path / "bin/Speech", os.X_OK)
    assert not (tmp_path / "src/specific.py").stat().st_mode & 0o111


def test_the_second_compile_changes_nothing(tmp_path: Path) -> None:
    planned = plan(tmp_path, always("generated/main.py", "1\n"), once("src/specific.py", "2\n"))
    carry_out(planned)
    before = {path: path.stat() for path in tmp_path.rglob("*")}
    changes, said = carry_out(planned)
    assert not said and not changes.dirty
    assert actions(changes, tmp_path) == {"generated/main.py": "unchanged", "src/specific.py": "kept"}
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == {
        path: status.st_mtime_ns for path, status in before.items()
    }


def test_only_what_changed_is_written(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("generated/a", "1\n"), always("generated/b", "1\n")))
    old = (tmp_path / "generated/a").stat()
    changes, _ = carry_out(plan(tmp_path, always("generated/a", "1\n"), always("generated/b", "2\n")))
    assert actions(changes, tmp_path) == {"generated/a": "unchanged", "generated/b": "update"}
    assert (tmp_path / "generated/a").stat() == old
    assert (tmp_path / "generated/b").read_text() == "2\n"


def test_an_edited_generated_file_is_kept_as_orig(tmp_path: Path) -> None:
    planned = plan(tmp_path, always("generated/a", "1\n"))
    carry_out(planned)
    for number, name in enumerate(("a.orig", "a.orig.1", "a.orig.2")):
        (tmp_path / "generated/a").write_text(f"mine {number}\n")
        changes, said = carry_out(planned)
        assert codes(said) == ["RC6004"]
        assert [change.orig for change in changes] == [str(tmp_path / "generated" / name)]
    assert files(tmp_path) == {
        "generated/a": "1\n",
        "generated/a.orig": "mine 0\n",
        "generated/a.orig.1": "mine 1\n",
        "generated/a.orig.2": "mine 2\n",
    }


def test_a_missing_file_is_written_again(tmp_path: Path) -> None:
    planned = plan(tmp_path, always("generated/a", "1\n"), once("src/b", "2\n"))
    carry_out(planned)
    (tmp_path / "generated/a").unlink()
    (tmp_path / "src/b").unlink()
    carry_out(planned)
    assert files(tmp_path) == {"generated/a": "1\n", "src/b": "2\n"}


def test_a_once_file_is_never_changed(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src/mine").write_text("mine\n")
    (tmp_path / "src/dangling").symlink_to("/nowhere/at/all")
    (tmp_path / "src/away").symlink_to("/etc/hostname")
    changes, said = carry_out(plan(tmp_path, *(once(f"src/{name}", "2\n") for name in ("mine", "dangling", "away"))))
    assert not said
    assert set(actions(changes, tmp_path).values()) == {"kept"}
    assert tree(tmp_path / "src") == {"mine": "mine\n", "dangling": "-> /nowhere/at/all", "away": "-> /etc/hostname"}


def test_a_users_file_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "CMakeLists.txt").write_text("mine\n")
    planned = plan(tmp_path, always("CMakeLists.txt", "ours\n"), always("generated/a", "1\n"))
    changes, said = carry_out(planned)
    assert codes(said) == ["RC6001"] and "--adopt" in said[0].hint
    assert files(tmp_path) == {"CMakeLists.txt": "mine\n"}, "nor is anything else of that root written"
    assert not (tmp_path / ".rcyaml").exists()
    assert changes.dirty
    _, said = carry_out(planned, adopt=True)
    assert not said
    assert files(tmp_path) == {"CMakeLists.txt": "ours\n", "CMakeLists.txt.orig": "mine\n", "generated/a": "1\n"}


def test_a_file_with_the_same_text_is_adopted(tmp_path: Path) -> None:
    """A fresh clone has the generated files, but maybe not the manifest."""
    planned = plan(tmp_path, always("generated/a", "1\n"), once("src/b", "2\n"))
    carry_out(planned)
    state = tree(tmp_path / ".rcyaml")
    for path in sorted((tmp_path / ".rcyaml").rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    changes, said = carry_out(planned)
    assert not said and not changes.dirty
    assert tree(tmp_path / ".rcyaml") == state


@pytest.mark.parametrize("users", [(), ("b",)])
def test_a_config_with_nothing_of_the_user_is_adopted(tmp_path: Path, users: tuple[str, ...]) -> None:
    (tmp_path / "etc").mkdir()
    (tmp_path / CONFIG).write_text("b=3\n")
    _, said = carry_out(plan(tmp_path, stated("a=1\n", *users)))
    assert codes(said) == ["RC6010" for _ in users]
    assert (tmp_path / CONFIG).read_text() == ("b=3\n" if users else "a=1\n")
    assert (tmp_path / "etc/config.orig").exists() != bool(users)


@pytest.mark.parametrize(("mine", "planned", "is_same"), [
    ("b = 2\na=1 # mine\n", "a=1\nb=2\n", True), ("a=1\nb=3\n", "a=1\nb=2\n", False), (b"\xff", "a=1\n", False),
    ("Row=up,  1 ;2\n", "Row=up,1;2\n", True), ("Row=up,1,2\n", "Row=up,1;2\n", False),
    ("g=1e-4\nv=[0,.5]\n", "g=0.0001\nv=[0.0,0.50]\n", True), ("id=0123\nh=10.0.0.1\n", "id=123\nh=10.0.0.1\n", False),
    ("b=\na=1\n", "a=1\n", True), ("a=1\n", "a=1\nb=2\n", False),
])  # fmt: skip
def test_a_config_with_the_same_properties_stays(
    tmp_path: Path, mine: str | bytes, planned: str, *, is_same: bool
) -> None:
    """Its document is the source all the same: the next change of that is written, and the user's text is kept."""
    (tmp_path / "etc").mkdir()
    mine = mine.encode() if isinstance(mine, str) else mine
    (tmp_path / CONFIG).write_bytes(mine)
    for _ in range(2):
        changes, said = carry_out(plan(tmp_path, stated(planned, *(() if is_same else ("b",)))))
        assert codes(said) == ([] if is_same else ["RC6010"])
        assert (tmp_path / CONFIG).read_bytes() == mine and not list(tmp_path.rglob("*.orig"))
    assert not changes.dirty
    if is_same:
        _, said = carry_out(plan(tmp_path, stated(f"{planned}new=1\n")))
        assert not said and (tmp_path / CONFIG).read_text() == f"{planned}new=1\n"
        assert (tmp_path / "etc/config.orig").read_bytes() == mine


def test_an_edit_of_a_config_that_stayed_is_reported(tmp_path: Path) -> None:
    (tmp_path / "etc").mkdir()
    (tmp_path / CONFIG).write_text("a=1 # mine\nrow=1, 2\n")
    assert not carry_out(plan(tmp_path, stated("a=1\nrow=1,2\n")))[1]
    (tmp_path / CONFIG).write_text("a=5\nrow=1, 2\n")
    _, said = carry_out(plan(tmp_path, stated("a=1\nrow=1,2\n", "a")))
    assert "etc/config (a)" in said[0].message
    _, said = carry_out(plan(tmp_path, stated("a=5\nrow=1,2\n")))
    assert not said


def test_a_blank_in_a_text_is_written_when_its_document_changes(tmp_path: Path) -> None:
    (tmp_path / "etc").mkdir()
    (tmp_path / CONFIG).write_text("a=1 # mine\nsay=Hello,World\n")
    assert not carry_out(plan(tmp_path, stated("a=1\nsay=Hello,World\n")))[1]
    assert not carry_out(plan(tmp_path, stated("a=1\nsay=Hello, World\n")))[1]
    assert (tmp_path / CONFIG).read_text() == "a=1\nsay=Hello, World\n"


def test_adopt_overwrites_a_config_with_the_same_properties(tmp_path: Path) -> None:
    (tmp_path / "etc").mkdir()
    (tmp_path / CONFIG).write_text("a=1 # mine\n")
    assert not carry_out(plan(tmp_path, stated("a=1\n")))[1]
    writer.commit(writer.prepare([plan(tmp_path, stated("a=1\n"))], adopt=True))
    assert (tmp_path / CONFIG).read_text() == "a=1\n"
    assert (tmp_path / "etc/config.orig").read_text() == "a=1 # mine\n"


def test_a_once_file_becomes_a_generated_one(tmp_path: Path) -> None:
    """As `etc/config` when a values document appears: it is rewritten unless the user edited it."""
    carry_out(plan(tmp_path, once(CONFIG, "a=1\n")))
    _, said = carry_out(plan(tmp_path, stated("a=2\n")))
    assert not said and (tmp_path / CONFIG).read_text() == "a=2\n"
    carry_out(plan(tmp_path, once(CONFIG, "a=3\n")))
    (tmp_path / CONFIG).write_text("a=4\n")
    _, said = carry_out(plan(tmp_path, stated("a=5\n", "a")))
    assert codes(said) == ["RC6010"] and (tmp_path / CONFIG).read_text() == "a=4\n"
    assert f"set them in {tmp_path / 'etc/config.yaml'} as well;" in said[0].hint
    assert "etc/config (a)" in said[0].message


def merge(root: Path, text: str, skeleton: str) -> list[Diagnostic]:
    """As `rcyaml compile --merge` does with one file."""
    merges = Merges({(str(root), CONFIG): Merge((root / CONFIG).read_bytes(), text.encode(), skeleton.encode())})
    prepared = writer.prepare([plan(root, once(CONFIG, skeleton))], merges=merges)
    return list(writer.commit(prepared).diagnostics)


def test_a_merged_file_without_edits_is_generated(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, once(CONFIG, "a=1\n")))
    assert not merge(tmp_path, "a=1\n\nb=1\n", "a=9\nb=1\n")
    assert not merge(tmp_path, "a=1\n\nb=1\n\nc=1\n", "a=9\nb=1\nc=1\n")
    _, said = carry_out(plan(tmp_path, stated("z=0\n")))
    assert not said and (tmp_path / CONFIG).read_text() == "z=0\n"
    assert not list(tmp_path.rglob("*.orig"))


@pytest.mark.parametrize("first", ["a=1\nmine=1\n", "a=1\n# mine\nmine=1\n"])
def test_a_merge_keeps_the_users_lines_the_users(tmp_path: Path, first: str) -> None:
    carry_out(plan(tmp_path, once(CONFIG, "a=1\n")))
    (tmp_path / CONFIG).write_text(first)
    assert not merge(tmp_path, f"{first}\nb=1\n", "a=1\nb=1\n")
    assert not merge(tmp_path, f"{first}\nb=1\n\nc=1\n", "a=1\nb=1\nc=1\n")
    _, said = carry_out(plan(tmp_path, stated("a=1\nb=1\n", "mine")))
    assert codes(said) == ["RC6010"] and "mine=1" in (tmp_path / CONFIG).read_text()
    assert "etc/config (mine)" in said[0].message
    _, said = carry_out(plan(tmp_path, stated("mine=1\nz=0\n")))
    assert not said and "mine=1" in (tmp_path / "etc/config.orig").read_text()


def test_a_lost_executable_bit_is_restored(tmp_path: Path) -> None:
    planned = plan(tmp_path, always("bin/run", "#!\n", executable=True))
    carry_out(planned)
    (tmp_path / "bin/run").chmod(0o640)
    carry_out(planned)
    assert stat.S_IMODE((tmp_path / "bin/run").stat().st_mode) == 0o750


def test_permissions_survive_an_update(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("a", "1\n")))
    (tmp_path / "a").chmod(0o600)
    carry_out(plan(tmp_path, always("a", "2\n")))
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o600


def test_dry_run_changes_nothing_and_shows_a_diff(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("a", "one\ntwo\n"), always("gone", "x")))
    before = tree(tmp_path, state=True)
    changes = writer.prepare([plan(tmp_path, always("a", "one\n2\n"), always("new", "n\n"))])
    assert actions(changes, tmp_path) == {"a": "update", "gone": "remove", "new": "create"}
    diffs = {os.path.basename(change.path): "".join(change.diff()) for change in changes}
    assert diffs["a"].endswith("@@ -1,2 +1,2 @@\n one\n-two\n+2\n")
    assert diffs["new"].startswith("--- /dev/null\n+++ b/") and diffs["new"].endswith("+n\n")
    assert diffs["gone"].endswith("-x\n\\ No newline at end of file\n")
    assert tree(tmp_path, state=True) == before


def test_a_diff_of_properties_shows_no_secret(tmp_path: Path) -> None:
    """For all spellings of the key, and in comments."""
    old = "mail.password = hunter2 # old\n-- db.password=hunter3\nkeys=a\n"
    new = "#mail.password=hunter4\nmy\\=password=hunter5#6\nkeys=b # plain\nmine=hunter7\n"
    (tmp_path / CONFIG).parent.mkdir()
    (tmp_path / CONFIG).write_text(old)
    planned = FilePlan(CONFIG, new, secrets=("mine",))
    (change,) = writer.prepare([plan(tmp_path, planned)], adopt=True)
    diff = change.diff(properties=True)
    assert "hunter" not in diff
    assert {"-mail.password =***", "-keys=a", "+keys=b # plain", "+mine=***"} <= set(diff.splitlines())
    assert "hunter2 # old" in change.diff()


def test_the_bytes_do_not_depend_on_the_folder(tmp_path: Path) -> None:
    for name in ("one", "two"):
        carry_out(plan(tmp_path / name, always("b", "1\n"), once("a", "é\n")))
    assert tree(tmp_path / "one", state=True) == tree(tmp_path / "two", state=True)


def test_a_relative_root_is_shown_as_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    changes, _ = carry_out(plan(Path("out"), always("a/b", "1\n")))
    assert [change.path for change in changes] == ["out/a/b"]
    assert (tmp_path / "out/a/b").read_text() == "1\n"
