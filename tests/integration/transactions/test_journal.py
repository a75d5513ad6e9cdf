"""A journal that rcyaml did not write, from a repository, moves and deletes nothing."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree

SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
MARK = {"path": "a.ice", "new": "", "old": "", "orig": "", "hash": "0", "created": False}
HOSTILE = {
    "removes what is ours no more": {"new": "../../mine.txt"},
    "removes by a full path": {"new": "FULL"},
    "removes a name that no commit gives": {"old": "keep.txt"},
    "removes through a link": {"new": "away/.rcyaml-1-0.new"},
    "moves out": {"path": "../../moved.txt", "old": ".rcyaml-1-0.old"},
    "moves out through a link": {"path": "away/moved.txt", "old": ".rcyaml-1-0.old"},
    "removes by another name": {"orig": "../../mine.txt", "old": ".rcyaml-1-0.old"},
    "is no text": {"path": 5, "new": ["x"]},
    "has no path": {"path": "", "old": ".rcyaml-1-0.old"},
}


@pytest.mark.parametrize("name", ["journal.json", "journal.done"])
@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_journal_changes_nothing(kind: str, name: str, rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    mark = {key: str(tmp_path / "mine.txt") if value == "FULL" else value for key, value in HOSTILE[kind].items()}
    write_tree(tmp_path, {
        "mine.txt": "mine", "home/.rcyaml-1-0.new": "mine", "robot/Speech.idsl.yaml": SPEECH,
        "robot/slice/.rcyaml-1-0.old": "theirs", "robot/slice/keep.txt": "mine", "robot/slice/away": "-> ../../home",
        f"robot/slice/.rcyaml/{name}": json.dumps({"marks": [{**MARK, **mark}], "folders": []}),
    })  # fmt: skip
    before = read_tree(tmp_path)
    result = rcyaml("compile", "robot")
    assert result.exit_code == 0
    after = read_tree(tmp_path)
    assert {path: after.get(path) for path in before if ".rcyaml/" not in path} == {
        path: text for path, text in before.items() if ".rcyaml/" not in path
    }
    assert set(after) - set(before) >= {"robot/slice/Speech.ice"}
    assert not (tmp_path / "moved.txt").exists() and not (tmp_path / "home/moved.txt").exists()


def test_folders_of_a_hostile_journal_are_kept(rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "empty": None, "robot/Speech.idsl.yaml": SPEECH,
        "robot/slice/.rcyaml/journal.json": json.dumps({"marks": [], "folders": ["../../empty"]}),
    })  # fmt: skip
    assert rcyaml("compile", "robot").exit_code == 0
    assert (tmp_path / "empty").is_dir()
