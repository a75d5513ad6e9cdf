"""The parsed content of a document decides its kind and its component, for all commands alike."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, write_tree

Run = Callable[..., Result]
CDSL = "component: SpeechComp\nlanguage: python\n"
PARAMETERS = "parameters: {device: {type: string, default: x}}\n"
DEPLOYMENT = "deployment: Head\ncomponents: {speech: {component: speech, set: {device: here}}}\n"
TREE = {"rcyaml.yaml": "", "speech/speech.cdsl.yaml": CDSL, "head.ddsl.yaml": DEPLOYMENT}
SPELLINGS = {
    "quoted key": f'"component": speech.cdsl.yaml\n{PARAMETERS}',
    "escape in the key": f'"compon\\u0065nt": "speech\\x2ecdsl.yaml"\n{PARAMETERS}',
    "space before the colon": f"component : speech.cdsl.yaml\n{PARAMETERS}",
    "explicit key": f"? component\n: speech.cdsl.yaml\n{PARAMETERS}",
    "flow mapping": "{component: speech.cdsl.yaml, " + PARAMETERS.strip() + "}\n",
    "folded text": f"{PARAMETERS}component: >-\n  speech.cdsl.yaml\n",
    "behind a start": f"# why\n%YAML 1.2\n---\ncomponent: speech.cdsl.yaml # it\n{PARAMETERS}...\n",
    "byte order mark": f"\ufeffcomponent: 'speech.cdsl.yaml'\r\n{PARAMETERS}",
    "anchor": f"x-c: &c speech.cdsl.yaml\ncomponent: *c\n{PARAMETERS}",
    "another way around": f"component: ../speech/./speech.cdsl.yaml\n{PARAMETERS}",
    "indented": f"  component: speech.cdsl.yaml\n  {PARAMETERS}",
}
FAULTS = {
    "SpeechComp": ("RC3204", "write `component: speech.cdsl.yaml`"),
    "speech": ("RC3204", "write `component: speech.cdsl.yaml`"),
    "SpechComp": ("RC3201", "write `component: speech.cdsl.yaml`"),
    "speech.cdsl": ("RC3201", "write `component: speech.cdsl.yaml`"),
    "speech.yaml": ("RC3201", "write `component: speech.cdsl.yaml`"),
    ".": ("RC3201", "that is a folder: write `component: speech.cdsl.yaml`"),
    "speech.pdsl.yaml": ("RC3201", "that is a document of parameters; write `component: speech.cdsl.yaml`"),
    "spech.cdsl.yaml": ("RC3201", "did you mean 'speech.cdsl.yaml'?"),
    "../speech.cdsl.yaml": ("RC3201", "write `component: speech.cdsl.yaml`"),
    "../../../away/speech.cdsl.yaml": ("RC3201", "write `component: speech.cdsl.yaml`"),
}


def _reported(run: Run, *args: str) -> list[tuple[str, str]]:
    found = json.loads(run(*args, "--format", "json").stdout)["diagnostics"]
    return sorted((each["code"], each["hint"]) for each in found if each["severity"] == "error")


@pytest.mark.parametrize("name", ["speech.pdsl.yaml", "other.pdsl.yaml", "pdsl.yaml"])
@pytest.mark.parametrize("text", SPELLINGS.values(), ids=SPELLINGS)
def test_parameters_belong_to_the_component_that_they_name(rcyaml: Run, tmp_path: Path, text: str, name: str) -> None:
    write_tree(tmp_path, {**TREE, f"speech/{name}": text})
    document = "speech/speech.cdsl.yaml"
    for args in (("check", "."), ("check", document), ("check", "head.ddsl.yaml"), ("compile", document)):
        assert _reported(rcyaml, *args) == []
    assert "device" in (tmp_path / "speech/generated/parameters.md").read_text()
    assert rcyaml("deploy", "plan", "head.ddsl.yaml").exit_code == 0  # `set:` knows the parameter
    assert rcyaml("graph", "head.ddsl.yaml").exit_code == 0
    assert rcyaml("config", "new", document).exit_code == 0
    assert "device = x " in rcyaml("config", "show", "speech/etc/config.yaml").stdout


@pytest.mark.parametrize(("given_name", "expected"), FAULTS.items())
def test_an_unknown_component_is_reported_by_all_commands(
    rcyaml: Run, tmp_path: Path, given_name: str, expected: tuple[str, str]
) -> None:
    write_tree(tmp_path, {**TREE, "speech/speech.pdsl.yaml": f"component: {given_name}\n{PARAMETERS}"})
    document = "speech/speech.cdsl.yaml"
    for args in (("check", "."), ("check", document), ("check", "head.ddsl.yaml"), ("compile", document)):
        assert _reported(rcyaml, *args) == [expected], args
    assert not (tmp_path / "speech/generated").exists(), "it is not compiled without its parameters"
    assert rcyaml("config", "new", document).exit_code == 1


@pytest.mark.parametrize(("given_name", "expected"), [
    ("SpeechComp", ("RC3204", "write `component: ../speech.cdsl.yaml`")),
    ("speech.cdsl.yaml", ("RC3201", "write `component: ../speech.cdsl.yaml`")),
    ("../speech.cdsl", ("RC3201", "write `component: ../speech.cdsl.yaml`")),
    ("..", ("RC3201", "that is a folder: write `component: ../speech.cdsl.yaml`")),
    ("../../head.ddsl.yaml", ("RC3201", "that is a document of a deployment")),
    ("../../other/other.cdsl.yaml", ("RC3207", "write `component: ../speech.cdsl.yaml`")),
])  # fmt: skip
def test_values_name_a_document_too(rcyaml: Run, tmp_path: Path, given_name: str, expected: tuple[str, str]) -> None:
    values = f"component: {given_name}\nparameters: {{}}\n"
    other = {"other/other.cdsl.yaml": "component: OtherComp\nlanguage: python\n"}
    write_tree(
        tmp_path,
        {
            **TREE,
            **other,
            "head.ddsl.yaml": DEPLOYMENT.replace(", set: {device: here}", ""),
            "speech/etc/config.yaml": values,
        },
    )
    for args in (("check", "."), ("check", "speech/speech.cdsl.yaml"), ("config", "check", "speech/etc/config.yaml")):
        assert expected in _reported(rcyaml, *args), args


def test_the_hint_can_be_typed(rcyaml: Run, tmp_path: Path) -> None:
    folder = "my head: speech"
    write_tree(
        tmp_path,
        {"rcyaml.yaml": "", f"{folder}/speech.cdsl.yaml": CDSL, "conf/x.config.yaml": "component: SpeechComp\n"},
    )
    [(_, hint)] = _reported(rcyaml, "check", "conf")
    (tmp_path / "conf/x.config.yaml").write_text(hint.removeprefix("write `").removesuffix("`") + "\n")
    assert _reported(rcyaml, "check", "conf") == []


def test_a_plain_name_is_that_of_a_component_without_document(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"rcyaml.yaml": "", "a/ArmComp.pdsl.yaml": f"component: ArmComp\n{PARAMETERS}"})
    assert _reported(rcyaml, "check", ".") == []
    write_tree(tmp_path, {"b/arm.cdsl.yaml": "component: ArmComp\nlanguage: cpp\n"})
    assert _reported(rcyaml, "check", ".") == []
    told = rcyaml("check", ".").stdout
    assert "warning[RC3204]" in told and "write `component: ../b/arm.cdsl.yaml`" in told
    write_tree(tmp_path, {"a/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\n"})
    assert [code for code, _ in _reported(rcyaml, "check", ".")] == ["RC3204"]


def test_values_of_a_component_need_not_name_it(rcyaml: Run, tmp_path: Path) -> None:
    values = "parameters: {device: mine}\n"
    write_tree(tmp_path, {**TREE, "speech/p.pdsl.yaml": f"component: speech.cdsl.yaml\n{PARAMETERS}",
                          "speech/etc/config.yaml": values})  # fmt: skip
    assert rcyaml("check", "speech").stdout.endswith("nothing wrong\n")
    assert "device = mine" in rcyaml("config", "show", "speech/etc/config.yaml").stdout
    assert rcyaml("compile", "speech/speech.cdsl.yaml").exit_code == 0
    assert "device=mine\n" in (tmp_path / "speech/etc/config").read_text()


def test_values_that_name_shared_parameters_belong_to_the_component_of_their_folder(
    rcyaml: Run, tmp_path: Path
) -> None:
    files = {"p.pdsl.yaml": PARAMETERS}
    for name in ("a", "b"):
        files[f"{name}/{name}.cdsl.yaml"] = f"component: {name.upper()}\nlanguage: python\nparameters: ../p.pdsl.yaml\n"
        files[f"{name}/etc/config.yaml"] = f"component: ../../p.pdsl.yaml\nparameters: {{device: {name}{name}}}\n"
    write_tree(tmp_path, files)
    assert rcyaml("compile").exit_code == 0
    for name in ("a", "b"):
        assert f"device={name}{name}\n" in (tmp_path / f"{name}/etc/config").read_text()


@pytest.mark.parametrize(("files", "code"), [
    ({"speech/speech.cdsl.yaml": CDSL + "parameters: speech.cdsl.yaml\n"}, "RC3202"),
    ({"speech/speech.cdsl.yaml": CDSL + "parameters: .\n"}, "RC3202"),
    ({"speech/speech.cdsl.yaml": CDSL + "parameters: p\n", "speech/p.pdsl.yaml": PARAMETERS}, "RC3202"),
    ({"speech/speech.cdsl.yaml": CDSL + "parameters: p.yaml\n", "speech/p.yaml": PARAMETERS}, "RC3202"),
    ({"p.pdsl.yaml": f"component: speech/speech.cdsl.yaml\n{PARAMETERS}"}, "RC3205"),
    ({"speech/p.pdsl.yaml": f"component: speech.cdsl.yaml\n{PARAMETERS}",
      "speech/q.pdsl.yaml": f"'component' : speech.cdsl.yaml\n{PARAMETERS}"}, "RC3203"),
])  # fmt: skip
def test_documents_that_do_not_belong_together(rcyaml: Run, tmp_path: Path, files: Tree, code: str) -> None:
    write_tree(tmp_path, {**TREE, "head.ddsl.yaml": "deployment: Head\ncomponents: {}\n", **files})
    assert [found for found, _ in _reported(rcyaml, "check", ".")] == [code]


def test_parameters_without_component_are_reported_beside_a_component_without_parameters(
    rcyaml: Run, tmp_path: Path
) -> None:
    write_tree(tmp_path, {"speech/speech.cdsl.yaml": CDSL, "speech/speech.pdsl.yaml": PARAMETERS})
    told = rcyaml("check", "speech/speech.cdsl.yaml")
    assert told.exit_code == 0
    assert "warning[RC3206]" in told.stdout
    assert "write `component: speech.cdsl.yaml`" in told.stdout


def test_compiling_one_file_keeps_the_other_generated_files(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "c.cdsl.yaml": CDSL, "p.pdsl.yaml": f"component: c.cdsl.yaml\n{PARAMETERS}",
        "etc/side.config.yaml": "component: ../c.cdsl.yaml\nparameters: {device: y}\nlegacy: {file: side}\n",
    })  # fmt: skip
    assert rcyaml("compile").exit_code == 0
    written = (tmp_path / "etc/side").read_text()
    assert rcyaml("compile", "c.cdsl.yaml").exit_code == 0
    assert (tmp_path / "etc/side").read_text() == written


@pytest.mark.parametrize("head", ["\ufeff", "# mine\n\n", "%YAML 1.2\n---\n", "\r\n"])
def test_the_modeline_of_a_config_may_be_at_any_line(rcyaml: Run, tmp_path: Path, head: str) -> None:
    modeline = "# yaml-language-server: $schema=../generated/config.schema.json"
    write_tree(tmp_path, {
        **TREE, "speech/p.pdsl.yaml": f"component: speech.cdsl.yaml\n{PARAMETERS}",
        "conf/config.yaml": f"{head}{modeline}\ncomponent: ../speech/speech.cdsl.yaml\nparameters: {{device: 3}}\n",
    })  # fmt: skip
    assert [code for code, _ in _reported(rcyaml, "check", "conf")] == ["RC3302"]
