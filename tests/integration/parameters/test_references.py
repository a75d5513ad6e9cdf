"""Values by reference: what may stand there, and the paths that are written for components."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

FILES = {
    "speech/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\n",
    "speech/speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters:\n  a: {type: string, optional: true}\n"
    "  b: {type: int, range: [0, 9], optional: true}\n  c: {type: bool, optional: true}\n"
    "  d: {list: float, optional: true}\n",
    "shared/robot.config.yaml": "parameters: {a: {file: keys/a}}\n",
    "speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nextends: [../../shared/robot.config.yaml]\n"
    "parameters: {b: {file: b.txt}, c: {file: /run/c}, d: [{file: ~/d}, 1]}\n",
    "robot.ddsl.yaml": "deployment: R\ncomponents:\n  speech: {component: speech, set: {b: {file: keys/b}}}\n",
}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for path, text in FILES.items():
        target = tmp_path / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    return tmp_path


def test_a_compiled_config_has_paths_from_its_own_folder(robot: Path, rcyaml: Callable[..., Any]) -> None:
    assert rcyaml("compile", "speech").exit_code == 0
    lines = (robot / "speech/etc/config").read_text().splitlines()
    assert {"a=${file:../../shared/keys/a}", "b=${file:b.txt}", "c=${file:/run/c}", "d.0=${file:~/d}"} <= set(lines)
    assert rcyaml("compile", "speech", "-o", "out").exit_code == 0
    assert "b=${file:b.txt}" in (robot / "out/etc/config").read_text(), "it goes with the folder"


@pytest.mark.parametrize("form", ["ice", "toml"])
def test_an_export_has_absolute_paths(robot: Path, rcyaml: Callable[..., Any], form: str) -> None:
    told = rcyaml("config", "export", "speech/etc/config.yaml", "--as", form).output
    for path in (f"{robot}/shared/keys/a", f"{robot}/speech/etc/b.txt", "/run/c", "~/d"):
        assert f"${{file:{path}}}" in told


def test_so_has_a_deployment(robot: Path, rcyaml: Callable[..., Any]) -> None:
    told = rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "systemd").output
    assert f"b=${{file:{robot}/keys/b}}" in told
    assert f"a=${{file:{robot}/shared/keys/a}}" in told


def test_they_are_shown_as_they_stand(robot: Path, rcyaml: Callable[..., Any]) -> None:
    told = rcyaml("config", "show", "speech/etc/config.yaml").output
    assert "a = {file: keys/a}" in told and 'd[0] = {file: "~/d"}' in told
    assert rcyaml("config", "set", "speech/etc/config.yaml", "b", "{file: ../x y/b}").exit_code == 0
    assert rcyaml("config", "get", "speech/etc/config.yaml", "b").output == "{file: ../x y/b}\n"
    assert "b: {file: ../x y/b}" in (robot / "speech/etc/config.yaml").read_text()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("b: {file: }", "b does not name a file"),
        ('b: {file: ""}', "b does not name a file"),
        ("b: {file: 7}", "b does not name a file"),
        ("b: {file: keys/}", "b does not name a file"),
        ('b: {file: "a\\nb"}', "b has a path that no file can have"),
        ("b: {file: x, mode: y}", "b cannot have 'mode' beside 'file'"),
        ("b: {env: X, file: y}", "b cannot have 'file' beside 'env'"),
        ("d: {file: x}", "d must be a list, and is a mapping"),
        ("a: '${file:x}'", "a cannot be a property of Ice: it would be read as a reference to a file"),
    ],
)
def test_what_is_no_reference(robot: Path, rcyaml: Callable[..., Any], text: str, said: str) -> None:
    document = robot / "speech/etc/config.yaml"
    document.write_text(f"component: ../speech.cdsl.yaml\nparameters:\n  {text}\n")
    result = rcyaml("config", "check", "speech/etc/config.yaml")
    assert result.exit_code == 1
    assert said in result.output
