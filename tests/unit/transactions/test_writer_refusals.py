"""What the writer refuses: paths out of the root, paths that are no files, and manifests that it cannot read."""

from __future__ import annotations

from pathlib import Path

import pytest

from disk import actions, always, carry_out, codes, once, plan, tree
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.transactions import manifest
from robocomp_yaml.transactions.plan import FilePlan


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/file").write_text("theirs\n")
    (tmp_path / "root").mkdir()
    return tmp_path / "root"


def refused(root: Path, *files: FilePlan) -> list[Diagnostic]:
    """The diagnostics of a transaction that changes nothing."""
    planned = plan(root, *files)
    before = tree(root.parent, state=True)
    _, said = carry_out(planned)
    assert tree(root.parent, state=True) == before
    return said


@pytest.mark.parametrize("path", ["../outside/new", "/tmp/rcyaml-new", "a/../../new", "a//b", "", ".", "a/\0b", "./a"])
@pytest.mark.parametrize("make", [always, once])
def test_a_path_out_of_the_root(root: Path, path: str, make) -> None:
    assert codes(refused(root, make(path, "x"))) == ["RC6002"]


@pytest.mark.parametrize("make", [always, once])
@pytest.mark.parametrize("target", ["../outside", "../outside/not/there"])
def test_a_folder_that_is_a_link_to_outside(root: Path, target: str, make) -> None:
    (root / "generated").symlink_to(target)
    said = refused(root, make("generated/deep/new", "x"), make("generated/other", "x"), always("fine", "x"))
    assert codes(said) == ["RC6002"]
    assert "generated/deep/new" in said[0].message and f"'generated' is a link to {target}" in said[0].message


def test_a_generated_file_that_is_a_link_to_outside(root: Path) -> None:
    (root / "a").symlink_to("../outside/file")
    assert codes(refused(root, always("a", "theirs\n"))) == ["RC6002"]


def test_the_state_folder_that_is_a_link_to_outside(root: Path) -> None:
    (root / ".rcyaml").symlink_to("../outside")
    assert codes(refused(root, always("a", "x"))) == ["RC6002"]


def test_a_link_within_the_root_is_followed(root: Path) -> None:
    (root / "code").mkdir()
    (root / "src").symlink_to("code")
    assert not carry_out(plan(root, once("src/a", "1\n"), always("src/b", "2\n")))[1]
    assert tree(root / "code") == {"a": "1\n", "b": "2\n"}
    assert (root / "src").is_symlink()


def test_a_generated_file_replaced_by_a_link_is_kept_as_that_link(root: Path) -> None:
    carry_out(plan(root, always("a", "1\n"), always("b", "2\n")))
    (root / "a").unlink()
    (root / "a").symlink_to("b")
    assert codes(carry_out(plan(root, always("a", "1\n"), always("b", "2\n")))[1]) == ["RC6004"]
    assert tree(root)["a.orig"] == "-> b"
    assert tree(root)["a"] == "1\n"


def test_paths_that_are_no_files(root: Path) -> None:
    (root / "a").mkdir()
    (root / "b").write_text("a file\n")
    said = refused(root, always("a", "x"), always("b/c", "x"), once("b/d", "x"), always("n" * 300, "x"))
    assert [(d.code, d.message.partition(": ")[2]) for d in said] == [
        ("RC6005", "it is a folder"),
        ("RC6005", "'b' is not a folder"),
        ("RC6005", "file name too long"),
    ], "one diagnostic for each cause"


def test_a_root_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file\n")
    from robocomp_yaml.transactions.plan import RootPlan

    _, said = carry_out(RootPlan(str(tmp_path / "out"), "../x.idsl.yaml", (always("a", "1\n"),)))
    assert codes(said) == ["RC6005"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "damaged"),
        ("{", "damaged"),
        ("[]", "damaged"),
        ('{"version": 1}', "damaged"),
        ('{"version": 1, "files": {"a": {"hash": 1, "owners": []}}}', "damaged"),
        ('{"version": 1, "files": {"a": {"hash": "1", "owners": [1]}}}', "damaged"),
        ("[" * 100_000, "damaged"),
        ('{"version": 2, "files": {}}', "later version"),
        ("\0\xff", "damaged"),
    ],
)
def test_a_manifest_that_cannot_be_used(root: Path, text: str, reason: str) -> None:
    (root / ".rcyaml").mkdir()
    (root / manifest.PATH).write_text(text)
    (root / "a").write_text("mine\n")
    said = refused(root, always("a", "x"), always("b", "x"))
    assert codes(said) == ["RC6006"] and reason in said[0].message


def test_a_manifest_cannot_delete_files_outside(root: Path) -> None:
    (root / ".rcyaml").mkdir()
    from robocomp_yaml.source.digest import digest

    entry = f'{{"hash": "{digest(b"theirs" + bytes([10]))}", "owners": []}}'
    (root / "link").symlink_to("../outside")
    (root / manifest.PATH).write_text(
        f'{{"version": 1, "files": {{"../outside/file": {entry}, "link/file": {entry}, "/x": {entry}}}}}'
    )
    carry_out(plan(root, always("a", "1\n")))
    assert tree(root.parent / "outside") == {"file": "theirs\n"}
    assert list(manifest.read((root / manifest.PATH).read_bytes()).files) == ["a"]


def test_the_other_roots_are_written(root: Path) -> None:
    (root / "a").mkdir()
    other = root.parent / "other"
    changes, said = carry_out(plan(root, always("a", "x"), always("b", "x")), plan(other, always("a", "x")))
    assert codes(said) == ["RC6005"]
    assert (other / "a").read_text() == "x"
    assert actions(changes, root.parent) == {"other/a": "create", "root/a": "refused", "root/b": "refused"}
