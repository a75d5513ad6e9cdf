"""Two components of one name are reported at the copy, by `check` and `compile`."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import ROOT, Tree, write_tree

Run = Callable[..., Result]
CDSL = "component: SpeechComp\nlanguage: python\n"


def _reported(result: Result) -> list[tuple[str, str, str]]:
    found = json.loads(result.stdout)["diagnostics"]
    return sorted((each["code"], each["file"], each["hint"]) for each in found if each["code"] != "RC6008")


@pytest.mark.parametrize("copy", ["speech2", "speech (copy)", "a/speech", "copy of speech", "speech/old"])
@pytest.mark.parametrize("head", [{"rcyaml.yaml": ""}, {}])
def test_a_copied_folder(rcyaml: Run, tmp_path: Path, copy: str, head: Tree) -> None:
    write_tree(tmp_path, {**head, "speech/speech.cdsl.yaml": CDSL})
    assert rcyaml("compile").exit_code == 0
    shutil.copytree(tmp_path / "speech", tmp_path / "copied")
    (tmp_path / copy).parent.mkdir(exist_ok=True)
    (tmp_path / "copied").rename(tmp_path / copy)
    document = f"{copy}/speech.cdsl.yaml"
    expected = ("RC2011", document, "rename the copy: `component: SpeechComp2`")
    for command in ("check", "compile"):
        result = rcyaml(command, "--format", "json")
        assert result.exit_code == 1
        assert expected in _reported(result)
    [found] = [each for each in json.loads(result.stdout)["diagnostics"] if each["code"] == "RC2011"]
    assert found["related"][0]["file"] == "speech/speech.cdsl.yaml"
    (tmp_path / document).write_text(CDSL.replace("SpeechComp", "SpeechComp2"))
    assert rcyaml("compile").exit_code == 0
    assert (tmp_path / copy / "bin/SpeechComp2").is_file()


def test_each_copy_is_reported_with_another_name(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {f"s{n}/s.cdsl.yaml": CDSL for n in ("", "2", "3")})
    write_tree(tmp_path, {"t/t.cdsl.yaml": CDSL.replace("SpeechComp", "SpeechComp2")})
    hint = "rename the copy: `component: SpeechComp{}`"
    assert _reported(rcyaml("check", "--format", "json")) == [
        ("RC2011", "s2/s.cdsl.yaml", hint.format(3)), ("RC2011", "s3/s.cdsl.yaml", hint.format(4))
    ]  # fmt: skip
    for n in ("2", "3"):
        (tmp_path / f"s{n}/s.cdsl.yaml").write_text(CDSL.replace("SpeechComp", f"SpeechComp{int(n) + 1}"))
    assert rcyaml("check").exit_code == 0


@pytest.mark.parametrize("files", [
    {"py/s.cdsl.yaml": CDSL, "cpp/s.cdsl.yaml": CDSL.replace("python", "cpp")},
    {"a/rcyaml.yaml": "", "a/s.cdsl.yaml": CDSL, "b/rcyaml.yaml": "", "b/s.cdsl.yaml": CDSL},
    {"rcyaml.yaml": "", "s/s.cdsl.yaml": CDSL, "third/rcyaml.yaml": "", "third/s.cdsl.yaml": CDSL},
    {"rcyaml.yaml": "lint: {RC2011: off}\n", "a/s.cdsl.yaml": CDSL, "b/s.cdsl.yaml": CDSL},
    {"a/s.cdsl.yaml": CDSL, "b": "-> a"},
])  # fmt: skip
def test_components_that_are_no_copies(rcyaml: Run, tmp_path: Path, files: Tree) -> None:
    write_tree(tmp_path, files)
    told = rcyaml("check", ".", *(["b/s.cdsl.yaml"] if files.get("b") else []))
    assert told.exit_code == 0, told.output


def test_a_deployment_with_both_is_rejected(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "a/s.cdsl.yaml": CDSL, "b2/s.cdsl.yaml": CDSL,
        "d.ddsl.yaml": "deployment: D\ncomponents: {a: {component: a}, b: {component: b2}}\n",
    })  # fmt: skip
    told = _reported(rcyaml("check", "d.ddsl.yaml", "--format", "json"))
    assert ("RC2011", "b2/s.cdsl.yaml") in [each[:2] for each in told]


def test_migrated_components_of_one_name_are_a_warning(rcyaml: Run, tmp_path: Path) -> None:
    legacy = "Component Speech\n{\n\tCommunications\n\t{\n\t};\n\tlanguage Python;\n};\n"
    write_tree(tmp_path, {
        "a/speech.cdsl": legacy, "b/speech.cdsl": legacy, "c/speech.cdsl": legacy.replace("Python", "Cpp")
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    told = rcyaml("check")
    assert told.exit_code == 0, told.output
    assert told.stdout.count("warning[RC2011]") == 1
    (tmp_path / "b/speech.cdsl").unlink()
    (tmp_path / "b/speech.cdsl.yaml").unlink()
    assert "RC2011" not in rcyaml("check").stdout


def test_the_examples_are_all_right(rcyaml: Run, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "examples/jointmotor", tmp_path / "jointmotor")
    assert rcyaml("check", "jointmotor").exit_code == 0
