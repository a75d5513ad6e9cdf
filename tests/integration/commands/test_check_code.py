"""`check` reports the same about the user's code as `compile`, and reads it only if the skeleton has changed."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree

Rcyaml = Callable[..., Result]
SPEECH = "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}, stop: }}}\n"
TREE = {
    "Speech.idsl.yaml": SPEECH,
    "py/py.cdsl.yaml": "component: PyComp\nlanguage: python\nimports: [../Speech.idsl.yaml]\nimplements: [Speech]\n",
    "cpp/cpp.cdsl.yaml": "component: CppComp\nlanguage: cpp\nimports: [../Speech.idsl.yaml]\nimplements: [Speech]\n",
}


def diagnostics(result: Result) -> list[tuple[str, str, int]]:
    found = json.loads(result.stdout)["diagnostics"]
    return [(one["code"], one["file"], one["line"]) for one in found if one["code"].startswith("RC62")]


@pytest.fixture
def compiled(rcyaml: Rcyaml, tmp_path: Path) -> Path:
    write_tree(tmp_path, TREE)
    assert rcyaml("compile").exit_code == 0
    return tmp_path


@pytest.mark.parametrize(
    ("old", "new", "codes"),
    [
        ("stop: ", "stop: , pause: ", {"RC6201"}),
        ("text: string", "text: string, volume: int", {"RC6202"}),
        (", stop: ", "", {"RC6203"}),
        ("say: ", "speak: ", {"RC6201", "RC6203"}),
    ],
)
def test_check_and_compile_report_the_same(compiled: Path, rcyaml: Rcyaml, old: str, new: str, codes: set[str]) -> None:
    write_tree(compiled, {"Speech.idsl.yaml": SPEECH.replace(old, new)})
    before = read_tree(compiled)
    checked = diagnostics(rcyaml("check", "--format", "json"))
    assert read_tree(compiled) == before
    assert checked == diagnostics(rcyaml("compile", "--format", "json"))
    assert {code for code, _, _ in checked} == codes
    assert {file.partition("/")[0] for _, file, _ in checked} == {"py", "cpp"}
    assert checked == diagnostics(rcyaml("check", "--format", "json"))


def test_only_requested_components_are_reported(compiled: Path, rcyaml: Rcyaml) -> None:
    write_tree(compiled, {"Speech.idsl.yaml": SPEECH.replace("stop: ", "stop: , pause: ")})
    assert {file for _, file, _ in diagnostics(rcyaml("check", "--format", "json", "py"))} == {
        "py/src/specificworker.py"
    }
    assert diagnostics(rcyaml("check", "--format", "json", "Speech.idsl.yaml")) == []
    write_tree(compiled, {"rcyaml.yaml": "lint: {RC6201: off}\n"})
    assert diagnostics(rcyaml("check", "--format", "json")) == []


def test_code_is_read_only_if_the_skeleton_has_changed(compiled: Path, rcyaml: Rcyaml) -> None:
    for name in [name for name in sys.modules if name.startswith("robocomp_yaml.emit.specific.reporting")]:
        del sys.modules[name]
    assert rcyaml("check").stdout == "3 documents: nothing wrong\n"
    assert "robocomp_yaml.emit.specific.reporting" not in sys.modules


def test_nothing_is_reported_before_the_first_compile(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    assert rcyaml("check").stdout == "3 documents: nothing wrong\n"


def test_code_is_not_read_again_after_a_compile(
    compiled: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    looked: list[str] = []
    monkeypatch.setattr("robocomp_yaml.emit.specific.existing_code.check", lambda *_: looked.append("looked") or ())
    (
        compiled / "py/generated/component.py"
    ).unlink()  # generated files do not change the diagnostics of the user's code
    rcyaml("check")
    assert looked == []
    rcyaml("check", "py")  # this component was not compiled alone
    assert looked == ["looked"]
    worker = compiled / "py/src/specificworker.py"
    worker.write_text(worker.read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
    rcyaml("check")
    assert looked == ["looked"] * 2
    rcyaml("compile")
    rcyaml("check")
    assert looked == ["looked"] * 2


@pytest.mark.parametrize("command", ["check", "compile"])
def test_other_files_of_the_user_count_too(compiled: Path, rcyaml: Rcyaml, command: str) -> None:
    """A method may be in another file; when it is removed there, it is reported."""
    worker, more = compiled / "py/src/specificworker.py", compiled / "py/src/more.py"
    text = worker.read_text(encoding="utf-8")
    assert "(GenericWorker)" in text and "def Speech_stop(" in text
    worker.write_text(text.replace("(GenericWorker)", "(More, GenericWorker)").replace("Speech_stop", "other"), "utf-8")
    more.write_text("class More:\n    def Speech_stop(self):\n        pass\n", encoding="utf-8")
    assert diagnostics(rcyaml("compile", "--format", "json")) == []
    assert diagnostics(rcyaml(command, "--format", "json")) == []
    more.write_text("class More:\n    pass\n", encoding="utf-8")
    assert {code for code, _, _ in diagnostics(rcyaml(command, "--format", "json"))} == {"RC6201"}


@pytest.mark.parametrize(
    ("old", "new"),
    [("text: string", "text: int"), ("stop: ", "stop: {returns: float}"), ("text: string", "text: Texts")],
)
@pytest.mark.parametrize("keeps_base", [True, False])
def test_another_type_alone_is_reported(
    compiled: Path, rcyaml: Rcyaml, old: str, new: str, *, keeps_base: bool
) -> None:
    """Also in a clone without the skeletons that the files were written from, and after the user wrote to the file."""
    for folder in ("py", "cpp"):
        if not keeps_base:
            shutil.rmtree(compiled / folder / ".rcyaml")
        for path in (compiled / folder / "src").iterdir():
            path.write_text(path.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    changed = SPEECH.replace(old, new).replace("interfaces:", "types: {Texts: {sequence: string}}\ninterfaces:")
    write_tree(compiled, {"Speech.idsl.yaml": changed})
    result = rcyaml("check", "--format", "json")
    found = [one for one in json.loads(result.stdout)["diagnostics"] if one["code"] == "RC6202"]
    assert {one["file"] for one in found} >= {"py/src/specificworker.py", "cpp/src/specificworker.h"}
    shown = rcyaml("check").stdout
    now = {"text: int": "int", "text: Texts": "list[str]"}.get(new, "-> float")
    assert now in shown and "it must begin as follows" in shown


@pytest.mark.parametrize(("file", "old", "fault"), [
    ("py/src/specificworker.py", "    def Speech_say", "    if a > b then:\n        )\n\n    def Speech_say"),
    ("cpp/src/specificworker.cpp", "void SpecificWorker::Speech_say", "if a > b (a)'\n}}\n\nvoid SpecificWorker::Speech_say"),
])  # fmt: skip
def test_methods_behind_a_syntax_error_are_not_missing(
    compiled: Path, rcyaml: Rcyaml, file: str, old: str, fault: str
) -> None:
    """The compiler reports the error; the grammar sees no method behind it, and one that is there is not pasted."""
    text = (compiled / file).read_text()
    (compiled / file).write_text(text.replace(old, fault))
    assert (compiled / file).read_text() != text
    assert not diagnostics(rcyaml("check", "--format", "json"))
    write_tree(compiled, {"Speech.idsl.yaml": SPEECH.replace("stop: ", "stop: , pause: ")})
    said = [
        one["message"]
        for one in json.loads(rcyaml("check", "--format", "json", file.partition("/")[0]).stdout)["diagnostics"]
    ]
    assert "SpecificWorker lacks Speech_pause" in said, said


def test_a_signature_that_does_not_fit_is_reported_once(compiled: Path, rcyaml: Rcyaml) -> None:
    """A method without a result, of which its signature says the same."""
    write_tree(compiled, {"Speech.idsl.yaml": SPEECH.replace("stop: ", "stop: {returns: int}")})
    found = json.loads(rcyaml("check", "--format", "json", "cpp").stdout)["diagnostics"]
    assert {one["code"] for one in found} == {"RC6202"}, found
