"""`rcyaml edit`: what it writes, prints and exits with."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from conftest import write_tree
from deployments import deployed
from robocomp_yaml.cli import group

DDSL = Path("robot.ddsl.yaml")
TEXT = "components:\n  speech: {component: speech} # talks\n  mouth: {component: mouth}\n"


@pytest.fixture(autouse=True)
def _in_a_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_tree(Path(), deployed(TEXT) | {"rcyaml.yaml": "{}\n"})


def edit(*words: str) -> Result:
    return CliRunner().invoke(group, ["edit", *words])


def test_every_change_of_the_library_has_a_command() -> None:
    for words in (
        ("connect", "speech", "Mouth", "mouth"), ("disconnect", "speech", "Mouth"),
        ("port", "mouth", "10001"), ("port", "mouth", "10002", "--interface", "CommonBehavior"),
        ("port", "mouth", "none", "--interface", "CommonBehavior"), ("instances", "mouth", "1"),
        ("rename", "mouth{i}", "lips{i}"), ("group", "face", "speech", "lips{i}"), ("ungroup", "face", "speech"),
        ("ungroup", "face"), ("after", "speech", "lips{i}"), ("not-after", "speech", "lips{i}"),
        ("add-host", "one", "10.0.0.2"), ("add-host", "two", "10.0.0.3", "--user", "robo"),
        ("move", "lips0", "two"), ("set", "speech", "period.compute", "50"), ("unset", "speech", "period.compute"),
        ("add", "wait", "--program", "--host", "one", "sleep", "9"), ("remove", "wait"),
        ("implement", "SpeechComp", "Mouth"), ("unimplement", "SpeechComp", "Mouth"),
        ("publish", "speech", "Heard"), ("subscribe", "mouth/mouth.cdsl.yaml", "Heard"), ("require", "mouth", "Speech"),
        ("unrequire", "mouth", "Speech"), ("unpublish", "speech", "Heard"), ("unsubscribe", "mouth", "Heard"),
        ("add", "nose", "NoseComp", "--new", "--implements", "Speech", "--host", "one"), ("remove", "nose"),
    ):  # fmt: skip
        result = edit(*words, "--force")
        assert result.exit_code in (0, 1), (words, result.output)
        assert result.stdout.startswith("wrote "), (words, result.output)
    assert "# talks" in DDSL.read_text()
    assert edit("topic", "speech", "Heard", "left/Heard", "--force").exit_code in (0, 1)
    assert "topics: {Heard: left/Heard}" in DDSL.read_text()


def test_an_error_prevents_the_change() -> None:
    before = DDSL.read_text()
    result = edit("set", "mouth", "period.compute", "often")
    assert (result.exit_code, DDSL.read_text()) == (1, before)
    assert "RC3302" in result.stderr
    assert "period.compute: often" in result.stderr  # the line that would be there
    assert edit("set", "mouth", "period.compute", "often", "--force").exit_code == 1
    assert "often" in DDSL.read_text()


def test_a_text_needs_no_quotes() -> None:
    write_tree(Path(), {"mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters: {name: {type: string}}\n"})
    assert edit("set", "mouth", "name", "12").exit_code == 0
    assert 'set: {name: "12"}' in DDSL.read_text()
    assert edit("set", "mouth", "name", "it is: so").exit_code == 0
    assert 'set: {name: "it is: so"}' in DDSL.read_text()
    assert edit("set", "mouth", "nmae", "x").exit_code == 2


def test_a_difference_writes_nothing() -> None:
    before = DDSL.read_text()
    result = edit("rename", "mouth", "lips", "--diff")
    assert result.exit_code == 0
    assert "+  lips: {component: mouth}" in result.stdout.splitlines()
    assert DDSL.read_text() == before


def test_json_has_what_a_program_needs() -> None:
    result = edit("connect", "speech", "Mouth", "speech", "--diff", "--format", "json")
    data = json.loads(result.stdout)
    assert (result.exit_code, data["document"], data["written"]) == (1, str(DDSL), False)
    assert [one["code"] for one in data["errors"]] == ["RC4204"]
    assert "+  speech: {component: speech, connect: {Mouth: speech}} # talks" in data["diff"].splitlines()
    data = json.loads(edit("port", "mouth", "10001", "--format", "json").stdout)
    assert (data["written"], data["errors"], data["change"]) == (True, [], "port mouth 10001")


def test_undo_in_another_run() -> None:
    before = DDSL.read_text()
    edit("port", "mouth", "10001")
    edit("rename", "mouth", "lips")
    after = DDSL.read_text()
    assert edit("undo").stdout == "wrote robot.ddsl.yaml: undo: rename mouth lips\n"
    edit("undo", str(DDSL))
    assert DDSL.read_text() == before
    assert edit("undo").exit_code == 2
    edit("redo")
    edit("redo")
    assert DDSL.read_text() == after
    with DDSL.open("a") as file:
        file.write("# mine\n")
    result = edit("undo")
    assert (result.exit_code, "changed by somebody else" in result.stderr) == (2, True)
    assert Path(".rcyaml/edits/.gitignore").read_text().endswith("*\n")
    assert Path(".rcyaml/edits/robot.ddsl.yaml").stat().st_mode & 0o777 == 0o600


def test_unknown_names_are_wrong_usage() -> None:
    result = edit("move", "speach", "here")
    assert result.exit_code == 2
    assert "did you mean 'speech'?" in result.stderr
    assert edit("connect", "speech").exit_code == 2
    assert edit("port", "mouth", "many").exit_code == 2


def test_a_new_component_is_added_as_rcyaml_new_writes_it() -> None:
    assert edit("add", "nose", "NoseComp", "--new", "--language", "cpp", "--implements", "Speech").exit_code == 0
    assert "language: cpp" in Path("components/nosecomp/nosecomp.cdsl.yaml").read_text()
    assert edit("undo").exit_code == 0
    assert not Path("components").exists() or not list(Path("components").iterdir())
    for words, text in (
        (("add", "nose", "mouth", "--implements", "Speech"), "add --new"),
        (("add", "nose", "x", "--new", "--program"), "exclude each other"),
        (("add", "nose", "NoseComp", "--new", "--language", "pascal"), "'pascal' is not one of"),
        (("add", "nose", "NoseComp", "--new", "--implements", "Speach"), "did you mean 'Speech'"),
    ):
        done = edit(*words)
        assert (done.exit_code, text in done.stderr) == (2, True), done.output
