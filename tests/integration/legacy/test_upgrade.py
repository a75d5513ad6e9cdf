"""Documents of earlier versions are upgraded in place, and nothing else in them changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree
from robocomp_yaml.legacy.upgrade import KeyRename, key_renames, upgraded

Run = Callable[..., Result]

OLDER = (
    "# mine\ncomponent: SpeechComp # subscribesTo\nlanguage:   python\nimports: [Speech]\n"
    "'subscribesTo':   [Speech]  # all\nx-note: subscribesTo\n"
)
NEWER = OLDER.replace("'subscribesTo'", "'subscribes'")
SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"


def test_a_document_is_upgraded(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"speech.cdsl.yaml": OLDER, "Speech.idsl.yaml": SPEECH})
    assert rcyaml("check", ".").exit_code == 1
    looked = rcyaml("migrate", ".", "--dry-run", "--diff")
    assert looked.exit_code == 0 and "-'subscribesTo':   [Speech]  # all\n+'subscribes':" in looked.output
    assert (tmp_path / "speech.cdsl.yaml").read_text() == OLDER
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "RC5031" in result.output, result.output
    assert (tmp_path / "speech.cdsl.yaml").read_text() == NEWER
    assert rcyaml("check", ".").exit_code == 0
    before = read_tree(tmp_path)
    assert rcyaml("migrate", ".").exit_code == 0
    assert read_tree(tmp_path) == before


def test_one_document_alone_with_its_byte_order_mark_and_line_ends(rcyaml: Run, tmp_path: Path) -> None:
    older = b"\xef\xbb\xbf" + OLDER.replace("\n", "\r\n").encode()
    write_tree(tmp_path, {"speech.cdsl.yaml": older, "other.cdsl.yaml": OLDER})
    assert rcyaml("migrate", "speech.cdsl.yaml").exit_code == 0
    assert (tmp_path / "speech.cdsl.yaml").read_bytes() == older.replace(b"'subscribesTo'", b"'subscribes'")
    assert (tmp_path / "other.cdsl.yaml").read_text() == OLDER


def test_the_old_and_the_new_key_are_a_conflict(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"speech.cdsl.yaml": OLDER + "subscribes: []\n"})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 1 and "RC5032" in result.output
    assert (tmp_path / "speech.cdsl.yaml").read_text() == OLDER + "subscribes: []\n"


@pytest.mark.parametrize("text", ["subscribesTo: [\n", "- subscribesTo\n", "subscribesTo", "", "a: &x {b: *x}\n"])
def test_what_is_not_a_document_is_skipped(rcyaml: Run, tmp_path: Path, text: str) -> None:
    write_tree(tmp_path, {"speech.cdsl.yaml": text})
    rcyaml("migrate", ".")
    assert (tmp_path / "speech.cdsl.yaml").read_text() == text


def test_keys_at_any_depth() -> None:
    change = KeyRename("pdsl", ("parameters", "*"), "least", "from", "it says more")
    text = "parameters:\n  a: {least: 1}  # least\n  b:\n    least: 2\nleast: 3\n"
    made = upgraded("x.pdsl.yaml", "pdsl", text, [change])
    assert made.text == "parameters:\n  a: {from: 1}  # least\n  b:\n    from: 2\nleast: 3\n"
    assert [d.code for d in made.diagnostics] == ["RC5031", "RC5031"]
    assert upgraded("x.cdsl.yaml", "cdsl", text, [change]).text == text


def test_the_renames_are_those_of_the_file() -> None:
    assert ("cdsl", "subscribesTo", "subscribes") in {(change.kind, change.old, change.new) for change in key_renames()}
