"""`--fail-on`: what makes a run fail besides errors."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Rcyaml = Callable[..., Result]
UNUSED = {  # RC2103, a warning: Speech is imported twice
    "Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n",
    "Mouth.idsl.yaml": "module: RoboCompMouth\ninterfaces: {Mouth: {methods: {close: }}}\n",
    "speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech, Speech]\nimplements: [Speech]\n",
}


@pytest.fixture
def warned(tmp_path: Path) -> Path:
    return write_tree(tmp_path, UNUSED)


@pytest.mark.parametrize("command", ["check", "compile"])
@pytest.mark.parametrize(
    ("args", "code"),
    [
        ((), 0),
        (("--fail-on", "error"), 0),
        (("--fail-on", "warning"), 1),
        (("--fail-on", "Warning"), 1),
        (("--fail-on", "note"), 1),
        (("--fail-on", "RC2103"), 1),
        (("--fail-on", "rc2103"), 1),
        (("--fail-on", "RC2101"), 0),
        (("--fail-on", "RC2101, RC2103"), 1),
        (("--fail-on", "RC2101", "--fail-on", "RC2103"), 1),
        (("--fail-on", "RC2101", "--fail-on", "warning"), 1),
        (("--fail-on", "error,note"), 1),
    ],
)
def test_exit_codes(rcyaml: Rcyaml, warned: Path, command: str, args: tuple[str, ...], code: int) -> None:
    first = rcyaml(command, *args)
    assert first.exit_code == code, first.output
    assert ("exit code 1 because of RC2103" in first.stderr) == bool(code)
    assert rcyaml(command, *args).exit_code == code, "found to be made already"


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("warnings", "did you mean 'warning'?"), ("eror", "did you mean 'error'?"), ("RC207", "did you mean 'RC"),
        ("RC9999", "is neither error, warning or note nor the code"), ("", "'' is neither"), ("RC2103,", "'' is neither"),
        ("quatsch", "`rcyaml explain` lists the codes"),
    ],
)  # fmt: skip
def test_wrong_words(rcyaml: Rcyaml, warned: Path, word: str, message: str) -> None:
    for command in ("check", "compile"):
        result = rcyaml(command, "--fail-on", word)
        assert result.exit_code == 2 and message in result.stderr


def test_json_does_not_change(rcyaml: Rcyaml, warned: Path) -> None:
    for form in ("json", "sarif"):
        plain, failing = (rcyaml("check", "--format", form, *more) for more in ((), ("--fail-on", "warning")))
        assert (plain.exit_code, failing.exit_code) == (0, 1) and plain.output == failing.output
        json.loads(failing.output)


def test_files_are_written_all_the_same(rcyaml: Rcyaml, warned: Path) -> None:
    assert rcyaml("compile", "--fail-on", "warning").exit_code == 1
    assert (warned / "src/specificworker.py").is_file()
    assert rcyaml("compile", "--check").exit_code == 0
    assert rcyaml("compile", "--check", "--fail-on", "RC2103").exit_code == 1


def test_diagnostics_that_the_workspace_turns_off_do_not_count(rcyaml: Rcyaml, warned: Path) -> None:
    write_tree(warned, {"rcyaml.yaml": "lint: {RC2103: off}\n"})
    assert rcyaml("check", "--fail-on", "note").exit_code == 0
    write_tree(warned, {"rcyaml.yaml": "lint: {RC2103: note}\n"})
    assert rcyaml("check", "--fail-on", "warning").exit_code == 0
    assert rcyaml("check", "--fail-on", "note").exit_code == 1
