"""The files of a workspace that editors read."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path

import pytest

from robocomp_yaml.link import workspace_files

KINDS = ("idsl", "cdsl", "pdsl", "ddsl", "config", "workspace", "mock")
EVERYTHING = {*(f".rcyaml/schemas/{kind}.schema.json" for kind in KINDS), ".vscode/settings.json"}


def relative(paths: Sequence[str], folder: Path) -> set[str]:
    return {os.path.relpath(path, folder) for path in paths}


def test_a_new_workspace_gets_schemas_and_settings(tmp_path: Path) -> None:
    assert relative(workspace_files.install(str(tmp_path)).changed, tmp_path) == EVERYTHING
    wired = json.loads((tmp_path / ".vscode/settings.json").read_text())["yaml.schemas"]
    assert all((tmp_path / schema).is_file() for schema in wired)
    assert wired[".rcyaml/schemas/cdsl.schema.json"] == ["*.cdsl.yaml", "cdsl.yaml"]


def test_nothing_is_written_twice(tmp_path: Path) -> None:
    workspace_files.install(tmp_path)
    assert not workspace_files.install(str(tmp_path)).changed


def test_schemas_are_made_again_only_for_other_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace_files.install(str(tmp_path))
    made = list[str]()
    schema_of = workspace_files.schema_of
    monkeypatch.setattr(workspace_files, "schema_of", lambda kind, *rest: made.append(kind) or schema_of(kind, *rest))
    workspace_files.install(str(tmp_path))
    assert made == []
    (tmp_path / "left.cdsl.yaml").write_text("component: Left\nlanguage: python\n")
    changed = workspace_files.install(str(tmp_path)).changed
    assert relative(changed, tmp_path) == {".rcyaml/schemas/ddsl.schema.json"}
    assert set(made) == set(KINDS)


def test_an_older_schema_is_brought_up_to_date(tmp_path: Path) -> None:
    workspace_files.install(tmp_path)
    (tmp_path / ".rcyaml/schemas/idsl.schema.json").write_text("{}")
    assert relative(workspace_files.install(str(tmp_path)).changed, tmp_path) == {".rcyaml/schemas/idsl.schema.json"}


def test_the_users_settings_are_kept(tmp_path: Path) -> None:
    settings = tmp_path / ".vscode/settings.json"
    settings.parent.mkdir()
    settings.write_text('{\n  // I like it wide\n  "editor.rulers": [120],\n}\n')
    workspace_files.install(tmp_path)
    text = settings.read_text()
    assert text.endswith('  // I like it wide\n  "editor.rulers": [120],\n}\n')
    assert '".rcyaml/schemas/idsl.schema.json": [' in text
    assert workspace_files.settings_problem(tmp_path) == ""


@pytest.mark.parametrize(
    ("content", "reason"), [(b"{ nonsense", "it is not JSON"), (b"\xff\xfe", "it is not UTF-8 text")]
)
def test_unreadable_settings_are_not_changed(tmp_path: Path, content: bytes, reason: str) -> None:
    settings = tmp_path / ".vscode/settings.json"
    settings.parent.mkdir()
    settings.write_bytes(content)
    assert relative(workspace_files.install(str(tmp_path)).changed, tmp_path) == EVERYTHING - {".vscode/settings.json"}
    assert settings.read_bytes() == content
    assert reason in workspace_files.settings_problem(tmp_path)


def test_settings_behind_a_link_are_not_changed(tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere.json"
    elsewhere.write_text("{}")
    (tmp_path / "home/.vscode").mkdir(parents=True)
    (tmp_path / "home/.vscode/settings.json").symlink_to(elsewhere)
    workspace_files.install(tmp_path / "home")
    assert elsewhere.read_text() == "{}"
    assert "it is a link" in workspace_files.settings_problem(tmp_path / "home")


def test_a_failure_leaves_no_partial_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "no space left")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="no space left"):
        workspace_files.install(tmp_path)
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


@pytest.mark.parametrize(
    ("document", "line"),
    [
        ("rcyaml.yaml", "# yaml-language-server: $schema=.rcyaml/schemas/idsl.schema.json"),
        ("a/b/x.idsl.yaml", "# yaml-language-server: $schema=../../.rcyaml/schemas/idsl.schema.json"),
    ],
)
def test_the_modeline_is_relative(document: str, line: str) -> None:
    assert workspace_files.modeline("idsl", f"ws/{document}", "ws") == line
