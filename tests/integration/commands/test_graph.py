"""`rcyaml graph`: deployments, folders, problems, and output files."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
FILES = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech: {methods: {say: }}\n",
    "Mouth.idsl.yaml":
        "module: RoboCompMouth\ninterfaces:\n  Mouth: {methods: {open: }}\ntopics:\n  Lips: {methods: {moved: }}\n",
    "speech/speech.cdsl.yaml":
        "component: SpeechComp\nlanguage: python\nimports: [Speech, Mouth]\nimplements: [Speech]\nrequires: [Mouth]\n"
        "subscribes: [Lips]\n",
    "mouth/mouth.cdsl.yaml":
        "component: MouthComp\nlanguage: python\nimports: [Mouth]\nimplements: [Mouth]\npublishes: [Lips]\n",
}  # fmt: skip
HEAD = """deployment: Head
services:
  storm: {icestorm: {port: 9999}}
components:
  speech: {component: speech/speech.cdsl.yaml, port: 10001}
  mouth: {component: mouth/mouth.cdsl.yaml, port: 10002}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return write_tree(tmp_path, {**FILES, "head.ddsl.yaml": HEAD})


def edges(text: str) -> set[tuple[str, str, str]]:
    data = json.loads(text)
    titles = {node["name"]: node["title"] for node in data["nodes"]}
    return {(titles[edge["from"]], edge["kind"], titles[edge["to"]]) for edge in data["edges"]}


@pytest.mark.usefixtures("robot")
def test_a_deployment(rcyaml: Run) -> None:
    result = rcyaml("graph", "head.ddsl.yaml", "--as", "json")
    assert result.exit_code == 0, result.output
    assert edges(result.stdout) >= {
        ("speech", "uses", "mouth"), ("mouth", "publishes", "Lips"), ("speech", "subscribes", "Lips"),
    }  # fmt: skip
    assert rcyaml("graph", ".", "--as", "json").stdout == result.stdout


def test_components_without_a_deployment(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, FILES)
    result = rcyaml("graph", "--as", "json")
    assert result.exit_code == 0, result.output
    assert edges(result.stdout) == {
        ("SpeechComp", "uses", "MouthComp"), ("MouthComp", "publishes", "Lips"), ("SpeechComp", "subscribes", "Lips"),
    }  # fmt: skip


def test_interfaces_without_an_implementation_are_shown(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {name: text for name, text in FILES.items() if not name.startswith("mouth/")})
    assert "-> Mouth of Mouth (no component here implements it)" in rcyaml("graph").output


@pytest.mark.usefixtures("robot")
@pytest.mark.parametrize("form", ["text", "dot", "mermaid", "json", "svg"])
def test_output_to_a_file(rcyaml: Run, tmp_path: Path, form: str) -> None:
    result = rcyaml("graph", "head.ddsl.yaml", "--as", form, "-o", "picture")
    assert result.exit_code == 0 and result.output == ""
    text = (tmp_path / "picture").read_text(encoding="utf-8")
    assert "speech" in text and text.endswith("\n")
    assert rcyaml("graph", "head.ddsl.yaml", "--as", form).stdout == text


@pytest.mark.usefixtures("robot")
def test_a_file_that_cannot_be_written(rcyaml: Run) -> None:
    result = rcyaml("graph", "head.ddsl.yaml", "-o", "no/such/folder/picture")
    assert result.exit_code == 1 and "cannot write no/such/folder/picture: no such file or directory" in result.output


def test_problems_are_red(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**FILES, "head.ddsl.yaml": HEAD.replace("10002", "10001")})
    result = rcyaml("graph", "head.ddsl.yaml", "--as", "svg")
    assert result.exit_code == 1
    assert "same port" in result.stderr
    root = ElementTree.fromstring(result.stdout)
    red = [element for element in root.iter("{http://www.w3.org/2000/svg}rect") if "wrong" in element.get("class", "")]
    assert len(red) == 2


def test_a_broken_document_is_reported(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"head.ddsl.yaml": "deployment: [\n"})
    result = rcyaml("graph", "head.ddsl.yaml")
    assert result.exit_code == 1 and "error[RC0" in result.output


@pytest.mark.usefixtures("robot")
def test_wrong_arguments(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("graph", "nowhere.ddsl.yaml").exit_code == 2
    assert "is neither a deployment document" in rcyaml("graph", "speech/speech.cdsl.yaml").output
    write_tree(tmp_path, {"other.ddsl.yaml": HEAD.replace("Head", "Other")})
    result = rcyaml("graph")
    assert result.exit_code == 2 and "head.ddsl.yaml, other.ddsl.yaml" in result.output
