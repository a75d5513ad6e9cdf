"""Files have owners: what is deleted when a document is deleted, renamed, or not requested."""

from __future__ import annotations

from pathlib import Path

from disk import OWNER, actions, always, carry_out, codes, files, once, plan, tree
from robocomp_yaml.transactions import manifest, writer


def test_a_file_no_longer_planned_is_removed_with_its_folder(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("generated/deep/er/a", "1\n"), always("generated/b", "1\n")))
    changes, _ = carry_out(plan(tmp_path, always("generated/b", "1\n")))
    assert actions(changes, tmp_path) == {"generated/b": "unchanged", "generated/deep/er/a": "remove"}
    assert tree(tmp_path) == {OWNER: "", "generated": None, "generated/b": "1\n"}


def test_an_edited_file_no_longer_planned_is_kept_as_orig(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("generated/a", "1\n"), always("generated/b", "1\n")))
    (tmp_path / "generated/a").write_text("mine\n")
    _, said = carry_out(plan(tmp_path, always("generated/b", "1\n")))
    assert codes(said) == ["RC6004"]
    assert files(tmp_path) == {"generated/a.orig": "mine\n", "generated/b": "1\n"}


def test_a_renamed_component_keeps_its_once_files(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, once("bin/OLD", "o\n"), always("generated/a", "1\n")))
    changes, said = carry_out(plan(tmp_path, once("bin/NEW", "n\n"), always("generated/a", "1\n")))
    assert actions(changes, tmp_path) == {"bin/NEW": "create", "bin/OLD": "left", "generated/a": "unchanged"}
    assert files(tmp_path) == {"bin/OLD": "o\n", "bin/NEW": "n\n", "generated/a": "1\n"}
    assert not said


def test_a_renamed_document_becomes_the_owner(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("generated/a", "1\n"), always("generated/b", "1\n"), once("src/c", "1\n")))
    (tmp_path / OWNER).unlink()
    carry_out(plan(tmp_path, always("generated/a", "1\n"), once("src/c", "1\n"), owner="talk.cdsl.yaml"))
    assert tree(tmp_path) == {
        "talk.cdsl.yaml": "",
        "generated": None,
        "generated/a": "1\n",
        "src": None,
        "src/c": "1\n",
    }
    held = manifest.read((tmp_path / manifest.PATH).read_bytes()).files
    assert {path: entry.owners for path, entry in held.items()} == {
        "generated/a": ("talk.cdsl.yaml",),
        "src/c": ("talk.cdsl.yaml",),
    }


def test_a_file_is_deleted_with_its_last_owner(tmp_path: Path) -> None:
    shared = always("Common.ice", "1\n")
    carry_out(plan(tmp_path, shared, owner="a.idsl.yaml"), plan(tmp_path, shared, owner="b.idsl.yaml"))
    (tmp_path / "a.idsl.yaml").unlink()
    carry_out(plan(tmp_path, shared, owner="b.idsl.yaml"))
    assert (tmp_path / "Common.ice").exists()
    carry_out(plan(tmp_path, owner="b.idsl.yaml"))
    assert tree(tmp_path, state=True) == {"b.idsl.yaml": ""}


def test_files_of_documents_that_are_not_requested_are_kept(tmp_path: Path) -> None:
    carry_out(
        plan(tmp_path, always("A.ice", "1\n"), owner="a.idsl.yaml"),
        plan(tmp_path, always("B.ice", "1\n"), owner="b.idsl.yaml"),
    )
    changes, _ = carry_out(plan(tmp_path, always("A.ice", "2\n"), owner="a.idsl.yaml"))
    assert actions(changes, tmp_path) == {"A.ice": "update"}
    assert (tmp_path / "B.ice").exists()


def test_a_partial_plan_removes_nothing_of_its_owner(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("slice/A.ice", "1\n"), always("generated/a", "1\n")))
    carry_out(plan(tmp_path, always("slice/A.ice", "2\n"), partial=True))
    assert files(tmp_path) == {"slice/A.ice": "2\n", "generated/a": "1\n"}


def test_other_roots_are_cleaned_up(tmp_path: Path) -> None:
    carry_out(plan(tmp_path, always("generated/a", "1\n"), once("src/b", "2\n")))
    changes = writer.prepare([], others=[str(tmp_path)])
    assert not changes.dirty, "its document is still there"
    (tmp_path / OWNER).unlink()
    changes = writer.prepare([], others=[str(tmp_path)])
    assert actions(changes, tmp_path) == {"generated/a": "remove", "src/b": "left"}
    assert not writer.commit(changes).diagnostics
    assert files(tmp_path) == {"src/b": "2\n"}
    assert (tmp_path / ".rcyaml/base/src/b").exists(), "a merge may still need it"


def test_two_documents_cannot_own_one_file(tmp_path: Path) -> None:
    changes, said = carry_out(
        plan(tmp_path, always("A.ice", "1\n"), once("b", "1\n"), always("c", "1\n"), owner="x/A.idsl.yaml"),
        plan(tmp_path, always("A.ice", "2\n"), once("b", "2\n"), always("c", "1\n"), owner="y/A.idsl.yaml"),
    )
    assert codes(said) == ["RC6003"], "one for both files"
    assert "A.ice' and 1 more" in said[0].message
    assert "x/A.idsl.yaml" in said[0].message and "y/A.idsl.yaml" in said[0].message
    assert not (tmp_path / "A.ice").exists() and changes.roots[0].refused


def test_many_documents_of_one_folder_are_told_once(tmp_path: Path) -> None:
    """The third one also contests a file that only the second one has."""
    _, said = carry_out(*(
        plan(tmp_path, always("a", f"{n}\n"), *([once("b", f"{n}\n")] if n in (1, 2) else []), owner=f"{n}.cdsl.yaml")
        for n in range(6)
    ))  # fmt: skip
    assert codes(said) == ["RC6003"]
    message = said[0].message.replace(said[0].span.file.removesuffix("1.cdsl.yaml"), "")
    assert message.startswith("0.cdsl.yaml and 1.cdsl.yaml, 2.cdsl.yaml, 3.cdsl.yaml and 2 more generate different")
    assert message.endswith("a' and 1 more"), message


def test_an_owner_outside_a_linked_root_exists(tmp_path: Path) -> None:
    """`out` is a link: its `..` is another folder for the system than in the path. Neither meaning deletes a file."""
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/A.idsl.yaml").touch()
    (tmp_path / "far/away").mkdir(parents=True)
    (tmp_path / "out").symlink_to("far/away")
    carry_out(plan(tmp_path / "out", always("A.ice", "1\n"), owner="../docs/A.idsl.yaml"))
    changes, _ = carry_out(plan(tmp_path / "out", always("B.ice", "1\n"), owner="B.idsl.yaml"))
    assert actions(changes, tmp_path / "out") == {"B.ice": "create"}


def test_roots_in_each_other_share_a_file(tmp_path: Path) -> None:
    """As a component in the folder of its workspace: both have the same `slice/`."""

    def compiled(text: str, *, inner: bool = True, outer: bool = True) -> list[str]:
        plans = [plan(tmp_path / "slice", always("A.ice", text), owner="../a.idsl.yaml")] if inner else []
        if outer:
            plans.append(plan(tmp_path, always("slice/A.ice", text)))
        _, said = carry_out(*plans)
        return codes(said)

    assert compiled("1\n") == []
    for _ in range(2):  # one of them cannot be written at first
        assert compiled("2\n", outer=False) == compiled("3\n") == []
        assert compiled("4\n", inner=False) == compiled("5\n") == []
    _, said = carry_out(plan(tmp_path / "slice", always("A.ice", "5\n"), owner="../a.idsl.yaml"), plan(tmp_path))
    assert not said
    assert (tmp_path / "slice" / "A.ice").read_text() == "5\n"
    assert compiled("5\n") == []
    (tmp_path / "slice" / "A.ice").write_text("mine\n")
    assert set(compiled("6\n")) == {"RC6004"}
    assert [path.read_text() for path in (tmp_path / "slice").glob("*.orig")] == ["mine\n"]
