"""A compile that is up to date prints the same as a complete one, and does nothing else."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, write_tree
from robocomp_yaml.api.workspace import Workspace

Rcyaml = Callable[..., Result]

SPEECH = "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n"
COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
PARAMETERS = "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 3}}\n"
BESIDE = {"rcyaml.yaml": "interfaces: [idsl]\n", "idsl/Speech.idsl.yaml": SPEECH, "speech/speech.cdsl.yaml": COMPONENT}
FINE: dict[str, Tree] = {
    "interface": {"Speech.idsl.yaml": SPEECH},
    "component in the root": {"Speech.idsl.yaml": SPEECH, "speech.cdsl.yaml": COMPONENT},
    "component in a folder": BESIDE,
    "a warning": {
        "Speech.idsl.yaml": SPEECH,
        "speech.cdsl.yaml": COMPONENT.replace("[Speech]\nimpl", "[Speech, Speech]\nimpl"),
    },
    "code of the user": {
        **BESIDE,
        "speech/src/specificworker.py": "class SpecificWorker: pass\n",
        "speech/etc/config": "A=1\n",
    },
}
FAULTY: dict[str, Tree] = {
    "no YAML": {**BESIDE, "idsl/Bad.idsl.yaml": "module: [\n"},
    "not UTF-8": {**BESIDE, "idsl/Bad.idsl.yaml": b"module: \xff\n"},
    "no such type": {**BESIDE, "idsl/Bad.idsl.yaml": SPEECH.replace("string", "strin").replace("Speech", "Bad")},
    "no such import": {**BESIDE, "idsl/Bad.idsl.yaml": "module: RoboCompBad\nimports: [Speach]\n"},
    "no such interface": {
        **BESIDE,
        "bad/bad.cdsl.yaml": COMPONENT.replace("[Speech]\n", "[Speech]\nrequires: [Mouth]\n"),
    },
    "parameters": {**BESIDE, "speech/speech.pdsl.yaml": PARAMETERS.replace("int", "itn")},
}
OF_THE_DISK: dict[str, tuple[Tree, Tree]] = {
    "a machine that is missing": (
        {**BESIDE, "speech/speech.cdsl.yaml": COMPONENT + "statemachine: machine.scxml\n"},
        {"speech/machine.scxml": '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0"><state id="a"/></scxml>\n'},
    ),
    "parameters of no component": (
        {"speech/speech.pdsl.yaml": PARAMETERS}, {"speech/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\n"},
    ),
    "a component that is not there": (
        {"robot.ddsl.yaml": "deployment: Robot\ncomponents: {speech: {component: other/speech.cdsl.yaml}}\n"},
        {"other/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\n"},
    ),
    "an import": (
        {"a/Bad.idsl.yaml": "module: RoboCompBad\nimports: [Mouth]\n"}, {"a/Mouth.idsl.yaml": "module: RoboCompMouth\n"},
    ),
}  # fmt: skip


def run_anew(rcyaml: Rcyaml, folder: Path, *args: str) -> Result:
    shutil.rmtree(folder / ".rcyaml/stamps", ignore_errors=True)
    return rcyaml("compile", *args)


@pytest.fixture
def no_run(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    def refuse(*args: object, **more: object) -> None:
        raise AssertionError("this was made already")

    return lambda: monkeypatch.setattr(Workspace, "__init__", refuse)


@pytest.mark.parametrize("tree", [*FINE.values(), *FAULTY.values()], ids=[*FINE, *FAULTY])
def test_the_output_is_that_of_a_complete_compile(tree: Tree, rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, tree)
    first = rcyaml("compile")
    again = rcyaml("compile")
    made = run_anew(rcyaml, tmp_path)
    assert (again.output, again.exit_code) == (made.output, made.exit_code)
    assert first.exit_code == again.exit_code
    assert rcyaml("compile", "--format", "json").output == run_anew(rcyaml, tmp_path, "--format", "json").output


def test_removed_files_are_reported_once(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, FINE["component in the root"])
    rcyaml("compile")
    (tmp_path / "speech.cdsl.yaml").unlink()
    (tmp_path / "generated/runtime/settings.py").write_text("mine = 1\n", encoding="utf-8")
    assert "left     src/specificworker.py\n" in rcyaml("compile").output
    again = rcyaml("compile").output
    assert again == run_anew(rcyaml, tmp_path).output == "1 document compiled: 0 files written, 1 unchanged\n"


@pytest.mark.parametrize("tree", FAULTY.values(), ids=FAULTY)
def test_a_compile_with_errors_has_a_stamp_too(
    tree: Tree, rcyaml: Rcyaml, tmp_path: Path, no_run: Callable[[], None]
) -> None:  # fmt: skip
    write_tree(tmp_path, tree)
    first = rcyaml("compile")
    assert first.exit_code == 1 and "error[" in first.output
    no_run()
    assert rcyaml("compile").exit_code == 1


def test_a_component_with_parameters_is_up_to_date(rcyaml: Rcyaml, tmp_path: Path, no_run: Callable[[], None]) -> None:
    write_tree(tmp_path, {**BESIDE, "speech/speech.pdsl.yaml": PARAMETERS})
    rcyaml("compile")
    no_run()
    assert rcyaml("compile").exit_code == 0


@pytest.mark.parametrize(("tree", "mended"), OF_THE_DISK.values(), ids=OF_THE_DISK)
def test_a_corrected_error_makes_the_stamp_stale(tree: Tree, mended: Tree, rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, tree)
    for _ in range(2):
        result = rcyaml("compile")
        assert result.exit_code == 1 and "skipped: " in result.output
    write_tree(tmp_path, mended)
    assert rcyaml("compile").exit_code == 0


def test_a_new_file_with_a_missing_name_makes_the_stamp_stale(rcyaml: Rcyaml, tmp_path: Path) -> None:
    """Also in a folder that is not compiled."""
    write_tree(tmp_path, {"a/Bad.idsl.yaml": "module: RoboCompBad\nimports: [Mouth]\n", "more": None})
    for _ in range(2):
        assert "did you mean" not in rcyaml("compile", "a", "-I", "more").output
    write_tree(tmp_path, {"more/Mouht.idsl.yaml": "module: RoboCompMouht\n"})
    assert "did you mean 'Mouht'?" in rcyaml("compile", "a", "-I", "more").output


def test_a_component_in_the_root_has_each_file_once(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, FINE["component in the root"])
    lines = rcyaml("-v", "compile").output.splitlines()
    assert len(set(lines)) == len(lines)
    files = [line.split()[-1] for line in lines[:-1]]
    assert f" compiled: {len(files)} files written" in lines[-1] and all((tmp_path / file).is_file() for file in files)


def test_skipped_documents_are_listed(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {**BESIDE, "speech/speech.pdsl.yaml": PARAMETERS, "idsl/Speech.idsl.yaml": "module: [\n"})
    lines = rcyaml("compile").output.splitlines()
    assert "skipped: idsl/Speech.idsl.yaml (it has errors)" in lines
    assert "skipped: speech/speech.pdsl.yaml (a document that it depends on has errors)" in lines
    assert lines[-1].startswith("0 documents compiled, 3 skipped: ")
