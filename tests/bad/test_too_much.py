"""Broken input that no case file can hold: too large, too deep, too often, or refused by the system."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree
from robocomp_yaml.source import text
from robocomp_yaml.transactions import atomic

Run = Callable[..., Result]

SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"


def first_lines(result: Result) -> list[str]:
    return result.output.splitlines()[:2]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        pytest.param(
            "module: RoboCompSpeech\ndoc: '" + "a" * 10_000_000 + "'\n",
            ["error[RC0004]: this text is 9.5 MiB, more than the 1.0 MiB that a document may have",
             "  ┌─ Speech.idsl.yaml:2:6"],
            id="a scalar of 10 MB",
        ),
        pytest.param(
            "module: RoboCompSpeech\n" + "# a comment\n" * 1_500_000,
            ["error[RC0004]: the file is 17.2 MiB, more than the 16.0 MiB that a document may have",
             "  ┌─ Speech.idsl.yaml:1:1"],
            id="a document of 17 MB",
        ),
        pytest.param(
            "module: RoboCompSpeech\ntypes: " + "{a: " * 5000 + "}" * 5000 + "\n",
            ["error[RC0106]: this is nested more than 100 levels deep", "  ┌─ Speech.idsl.yaml:2:408"],
            id="nested 5,000 deep",
        ),
        pytest.param(
            "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
                f"{level}: &{level} [{', '.join(f'*{chr(ord(level) - 1)}' for _ in range(9))}]\n" for level in "bcdefgh"
            ),
            ["error[RC0105]: aliases of this anchor make the document too large: more than 100000 values are repeats",
             "  ┌─ Speech.idsl.yaml:5:4"],
            id="an alias bomb",
        ),
    ],
)  # fmt: skip
def test_too_much_of_a_document(content: str, expected: list[str], rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": content})
    result = rcyaml("check")
    assert (result.exit_code, first_lines(result)) == (1, expected)
    assert max(map(len, result.output.splitlines())) < 200, "a long line is cut"


def test_a_legacy_file_of_100_mb(rcyaml: Run, tmp_path: Path) -> None:
    with (tmp_path / "Speech.idsl").open("wb") as file:
        file.truncate(100 << 20)
    result = rcyaml("migrate", ".")
    assert result.exit_code == 1
    assert "100.0 MiB" in first_lines(result)[0]
    assert not list(tmp_path.glob("*.yaml"))


def test_many_errors_come_all_at_once_and_sorted(rcyaml: Run, tmp_path: Path) -> None:
    for name in "CAB":
        write_tree(tmp_path, {f"{name}.idsl.yaml": f"module: RoboComp{name}\ncolour: red\nsize: 5\n"})
    places = [line.split("─ ")[1] for line in rcyaml("check").output.splitlines() if "┌─" in line]
    assert places == [f"{name}.idsl.yaml:{line}:1" for name in "ABC" for line in (2, 3)]


def test_an_unreadable_file(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": SPEECH})
    (tmp_path / "Speech.idsl.yaml").chmod(0)
    if os.geteuid() == 0:  # root may read everything, so the system's answer to others is played

        def refuse(*args: object, **kwargs: object) -> None:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(text, "whole", refuse)
    assert first_lines(rcyaml("check"))[0] == "error[RC0001]: cannot read this file: permission denied"


@pytest.mark.parametrize(
    ("number", "words"),
    [(13, "Permission denied"), (28, "No space left on device"), (30, "Read-only file system")],
)
def test_an_output_folder_that_cannot_be_written(
    number: int, words: str, rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": SPEECH})
    before = read_tree(tmp_path)

    def refuse(*args: object, **kwargs: object) -> None:
        raise OSError(number, words)

    def refuse_to_write(path: str, flags: int, *args: int, opened: Callable[..., int] = os.open, **kwargs: int) -> int:
        if flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            refuse()
        return opened(path, flags, *args, **kwargs)

    monkeypatch.setattr(atomic.os, "open", refuse_to_write)
    monkeypatch.setattr(atomic.os, "makedirs", refuse)
    monkeypatch.setattr(atomic.os, "mkdir", refuse)
    result = rcyaml("compile")
    monkeypatch.undo()
    assert result.exit_code == 1
    assert first_lines(result)[0].startswith("error[RC6005]: cannot write '")
    assert first_lines(result)[0].endswith(words.lower())
    assert read_tree(tmp_path) == before
