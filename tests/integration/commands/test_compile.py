"""`rcyaml compile`, as its user sees it."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree
from robocomp_yaml.transactions import atomic

SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
TREE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": SPEECH,
    "speech/speech.cdsl.yaml": COMPONENT,
}

Run = Callable[..., Result]


@pytest.fixture
def compiled(rcyaml: Run, tmp_path: Path) -> Path:
    write_tree(tmp_path, TREE)
    assert rcyaml("compile").exit_code == 0
    return tmp_path


def generated(folder: Path) -> dict[str, str]:
    """All files but rcyaml's records."""
    return {path: text for path, text in read_tree(folder).items() if "/." not in f"/{path}"}


def test_the_files_of_a_first_compile(compiled: Path) -> None:
    assert {
        "slice/Speech.ice", "runtime/python/generated/slice/CommonBehavior.ice", "speech/etc/config",
        "speech/bin/SpeechComp", "speech/src/specificworker.py", "speech/generated/genericworker.py",
    } <= set(read_tree(compiled))  # fmt: skip
    assert os.access(compiled / "speech/bin/SpeechComp", os.X_OK)


def test_a_second_compile_writes_nothing(compiled: Path, rcyaml: Run) -> None:
    before = {path: path.stat().st_mtime_ns for path in compiled.rglob("*") if path.is_file()}
    result = rcyaml("compile")
    assert (result.exit_code, result.stdout.splitlines()[-1][:33]) == (0, "2 documents compiled: 0 files wri")
    assert {path: path.stat().st_mtime_ns for path in before} == before


@pytest.mark.parametrize("option", ["--dry-run", "--diff", "--check"])
def test_dry_runs_write_nothing(option: str, rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    result = rcyaml("compile", option)
    assert result.exit_code == (1 if option == "--check" else 0)
    assert read_tree(tmp_path) == TREE
    assert "slice/Speech.ice" in result.stdout


def test_all_documents_count(compiled: Path, rcyaml: Run) -> None:
    parameters = "component: speech.cdsl.yaml\nparameters: {rate: {type: int, default: 1}}\n"
    (compiled / "speech/speech.pdsl.yaml").write_text(parameters)
    (compiled / "robot.ddsl.yaml").write_text("deployment: Robot\ncomponents: {speech: {component: speech}}\n")
    assert rcyaml("compile").stdout.splitlines()[-1].startswith("4 documents compiled: ")
    (compiled / "speech/speech.pdsl.yaml").write_text(parameters.replace("1", "one"))
    assert rcyaml("compile").stdout.splitlines()[-1].startswith("2 documents compiled, 2 skipped: ")
    (compiled / "interfaces/Speech.idsl.yaml").write_text("- no mapping\n")
    assert rcyaml("compile", "speech").stdout.splitlines()[-1].startswith("0 documents compiled, 2 skipped: ")


def test_check_succeeds_if_all_files_are_up_to_date(compiled: Path, rcyaml: Run) -> None:
    assert rcyaml("compile", "--check").exit_code == 0
    (compiled / "interfaces/Speech.idsl.yaml").write_text(SPEECH.replace("say", "tell"))
    assert rcyaml("compile", "--check").exit_code == 1


def test_diff_shows_the_lines(compiled: Path, rcyaml: Run) -> None:
    (compiled / "interfaces/Speech.idsl.yaml").write_text(SPEECH.replace("say", "tell"))
    shown = rcyaml("compile", "--diff").stdout
    assert "-    void say(string text);\n+    void tell(string text);\n" in shown


def test_user_files_are_kept_when_the_interface_changes(compiled: Path, rcyaml: Run) -> None:
    mine = compiled / "speech/src/specificworker.py"
    mine.write_text("# mine\n")
    (compiled / "interfaces/Speech.idsl.yaml").write_text(SPEECH.replace("say", "tell"))
    assert rcyaml("compile").exit_code == 0
    assert mine.read_text() == "# mine\n"
    assert "void tell" in (compiled / "slice/Speech.ice").read_text()


def test_an_edited_generated_file_is_kept_as_orig(compiled: Path, rcyaml: Run) -> None:
    file = compiled / "speech/generated/genericworker.py"
    text = file.read_text()
    file.write_text(text + "# edited\n")
    result = rcyaml("compile")
    assert (result.exit_code, "RC6004" in result.stdout) == (0, True)
    assert (file.read_text(), file.with_name(file.name + ".orig").read_text()) == (text, text + "# edited\n")


def test_a_missing_file_is_written_again(compiled: Path, rcyaml: Run) -> None:
    before = generated(compiled)
    (compiled / "slice/Speech.ice").unlink()
    (compiled / "speech/src/specificworker.py").unlink()
    rcyaml("compile")
    assert generated(compiled) == before


def test_files_of_a_deleted_document_are_removed(compiled: Path, rcyaml: Run) -> None:
    write_tree(compiled, {"interfaces/Mouth.idsl.yaml": SPEECH.replace("Speech", "Mouth")})
    rcyaml("compile")
    assert (compiled / "slice/Mouth.ice").exists()
    (compiled / "interfaces/Mouth.idsl.yaml").unlink()
    rcyaml("compile")
    assert not (compiled / "slice/Mouth.ice").exists()
    assert (compiled / "slice/Speech.ice").exists()


def test_compiling_one_document_keeps_the_files_of_others(compiled: Path, rcyaml: Run) -> None:
    before = generated(compiled)
    rcyaml("compile", "speech/speech.cdsl.yaml")
    rcyaml("compile", "interfaces")
    assert generated(compiled) == before


def test_documents_with_errors_are_skipped_and_the_others_compiled(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, "interfaces/Mouth.idsl.yaml": "module: RoboCompMouth\ntypes: 5\n"})
    result = rcyaml("compile", "--format", "json")
    data = json.loads(result.stdout)
    assert (result.exit_code, [d["code"] for d in data["diagnostics"]]) == (1, ["RC0204"])
    assert "slice/Speech.ice" in [file["path"] for file in data["files"]]
    assert not (tmp_path / "slice/Mouth.ice").exists()


def test_a_document_with_new_errors_keeps_its_files(compiled: Path, rcyaml: Run) -> None:
    before = generated(compiled)
    (compiled / "interfaces/Speech.idsl.yaml").write_text("module: RoboCompSpeech\ntypes: 5\n")
    assert rcyaml("compile").exit_code == 1
    after = generated(compiled)
    assert {k: v for k, v in after.items() if not k.endswith(".yaml")} == {
        k: v for k, v in before.items() if not k.endswith(".yaml")
    }


def test_a_failed_write_leaves_everything_as_it_was(
    rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_tree(tmp_path, TREE)
    real, calls = os.rename, []

    def full(source: object, target: object) -> None:
        calls.append(target)
        if len(calls) == 9:
            raise OSError(28, "No space left on device")
        real(source, target)  # type: ignore[arg-type]

    monkeypatch.setattr(atomic.os, "rename", full)
    monkeypatch.setattr(atomic.os, "replace", full)
    result = rcyaml("compile")
    assert calls, "the commit moves files into place"
    assert (result.exit_code, "RC6005" in result.stdout, "no space left" in result.stdout.lower()) == (1, True, True)
    assert generated(tmp_path) == TREE


def test_adopt_overwrites_and_keeps_a_backup(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, "slice/Speech.ice": "// by hand\n"})
    assert rcyaml("compile").exit_code == 1
    assert (tmp_path / "slice/Speech.ice").read_text() == "// by hand\n"
    assert rcyaml("compile", "--adopt").exit_code == 0
    assert (tmp_path / "slice/Speech.ice.orig").read_text() == "// by hand\n"
    assert "module RoboCompSpeech" in (tmp_path / "slice/Speech.ice").read_text()


def test_output_elsewhere_mirrors_the_folder(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    assert rcyaml("compile", ".", "-o", "out").exit_code == 0
    assert {"out/Speech.ice", "out/speech/src/specificworker.py"} <= set(read_tree(tmp_path))
    assert not (tmp_path / "slice").exists() and not (tmp_path / "speech/src").exists()


def test_the_order_of_arguments_changes_nothing(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    rcyaml("compile", "speech", "interfaces", "-o", "one")
    rcyaml("compile", "interfaces", "speech", "-o", "two")
    assert generated(tmp_path / "one") == generated(tmp_path / "two")


def test_a_target_alone(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    rcyaml("compile", "--target", "slice")
    assert (tmp_path / "slice/Speech.ice").exists() and not (tmp_path / "speech/generated").exists()


def test_imports_are_searched_in_included_folders(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {"far/Speech.idsl.yaml": SPEECH, "speech/speech.cdsl.yaml": COMPONENT})
    assert rcyaml("check", "speech").exit_code == 1
    assert rcyaml("check", "speech", "-I", "far").exit_code == 0
    monkeypatch.setenv("RCYAML_PATH", "nowhere:far")
    assert rcyaml("check", "speech").exit_code == 0


def test_a_nearer_import_wins_even_after_a_compile(compiled: Path, rcyaml: Run) -> None:
    write_tree(compiled, {"speech/Speech.idsl.yaml": SPEECH.replace("say", "tell")})
    rcyaml("compile", "speech")
    assert "void tell" in (compiled / "speech/slice/Speech.ice").read_text()


def test_sarif(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"speech.cdsl.yaml": COMPONENT})
    run = json.loads(rcyaml("check", "--format", "sarif").stdout)["runs"][0]
    (result,) = run["results"]
    assert (result["ruleId"], result["level"]) == ("RC2101", "error")
    place = result["locations"][0]["physicalLocation"]
    assert (place["artifactLocation"]["uri"], place["region"]["startLine"], place["region"]["startColumn"]) == (
        "speech.cdsl.yaml", 3, 11,
    )  # fmt: skip


def test_lint_changes_severities(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"rcyaml.yaml": "lint: {RC2101: warning}\n", "speech.cdsl.yaml": COMPONENT})
    assert rcyaml("check").exit_code == 0
    assert "error[RC6101]: SpeechComp is not compiled" in rcyaml("compile").stdout


def test_bom_and_crlf_are_accepted(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": b"\xef\xbb\xbf" + SPEECH.replace("\n", "\r\n").encode()})
    result = rcyaml("check")
    assert result.exit_code == 0, result.stdout


def test_names_with_blanks_and_accents(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"una cabeza señal/Speech.idsl.yaml": SPEECH, "una cabeza señal/speech.cdsl.yaml": COMPONENT})
    assert rcyaml("compile").exit_code == 0
    assert (tmp_path / "una cabeza señal/generated/genericworker.py").exists()


def test_a_folder_that_cannot_be_read_is_reported_and_not_treated_as_deleted(
    compiled: Path, rcyaml: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The files of its documents are kept."""

    def closed(call: Callable[..., object]) -> Callable[..., object]:
        def refuse(path: str, *args: object, **options: object) -> object:
            if "interfaces" in str(path):
                raise PermissionError(errno.EACCES, "Permission denied", path)
            return call(path, *args, **options)

        return refuse

    for name in ("scandir", "lstat", "stat"):
        monkeypatch.setattr(os, name, closed(getattr(os, name)))
    for command in ("check", "compile"):
        result = rcyaml(command)
        assert result.exit_code == 1
        assert "error[RC0001]: cannot read this file: permission denied\n  ┌─ interfaces\n" in result.output
    monkeypatch.undo()
    assert (compiled / "slice/Speech.ice").is_file()


def test_a_document_whose_name_is_no_utf8_compiles(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {os.fsdecode(b"c\xe9.cdsl.yaml"): "component: C\nlanguage: python\n"})
    assert rcyaml("compile").exit_code == 0
    assert "0 files written" in rcyaml("compile").stdout
    assert rcyaml("compile", "--check").exit_code == 0
