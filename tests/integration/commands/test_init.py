"""`rcyaml init`."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree
from robocomp_yaml.transactions import whole_file

Run = Callable[..., Result]
OWN_FILES = {
    "rcyaml.yaml", ".gitignore", ".vscode/settings.json",
    *(f".rcyaml/schemas/{kind}.schema.json" for kind in ("idsl", "cdsl", "pdsl", "ddsl", "config", "workspace", "mock")),
    ".rcyaml/stamps/.gitignore", ".rcyaml/stamps/schemas",
}  # fmt: skip
EXAMPLE = {"interfaces/Hello.idsl.yaml", "components/hellocomp/hellocomp.cdsl.yaml"}


def test_an_empty_folder_becomes_a_workspace_that_checks(rcyaml: Run, tmp_path: Path) -> None:
    result = rcyaml("init")
    assert result.exit_code == 0
    assert set(read_tree(tmp_path)) == OWN_FILES | EXAMPLE
    checked = rcyaml("check")
    assert (checked.exit_code, checked.stdout) == (0, "2 documents: nothing wrong\n")


def test_the_workspace_compiles(rcyaml: Run, tmp_path: Path) -> None:
    rcyaml("init")
    assert rcyaml("compile").exit_code == 0
    assert (tmp_path / "components/hellocomp/bin/HelloComp").is_file()
    again = rcyaml("compile", "--check")
    assert again.exit_code == 0


@pytest.mark.skipif(not shutil.which("git"), reason="git is not installed")
def test_git_ignores_build_results_but_not_programs(rcyaml: Run, tmp_path: Path) -> None:
    rcyaml("init")
    rcyaml("new", "component", "Arm", "--language", "cpp", "--implements", "Hello")
    rcyaml("compile")
    built = {"bin/Arm", "build/CMakeCache.txt", "build/x.o", "CMakeFiles/a.o", "CMakeCache.txt", "arm_autogen/moc.cpp"}
    write_tree(tmp_path / "components/arm", dict.fromkeys(built, "made\n"))
    write_tree(tmp_path / "components/hellocomp", {"src/__pycache__/x.pyc": "made\n"})
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    listed = subprocess.run(
        ["git", "ls-files", "--others", "--ignored", "--exclude-standard"], cwd=tmp_path, capture_output=True, text=True,
        check=True,
    ).stdout.splitlines()  # fmt: skip
    seen = {path for path in listed if not path.startswith(".rcyaml/stamps/")}
    assert seen == {*(f"components/arm/{path}" for path in built), "components/hellocomp/src/__pycache__/x.pyc"}


def test_the_next_command_works(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("init").stdout.splitlines()[-3:] == ["next: rcyaml check", "      rcyaml compile", "      rcyaml run"]
    lines = rcyaml("init", "my robot").stdout.splitlines()
    assert lines[-4:-2] == ["next: cd 'my robot'", "      rcyaml check"] and max(map(len, lines)) <= 80


def test_json(rcyaml: Run, tmp_path: Path) -> None:
    data = json.loads(rcyaml("-q", "init", "--bare", "--format", "json").stdout)
    assert {"done": "wrote", "path": "rcyaml.yaml"} in data["files"] and data["notes"] == []
    assert data["next"][0] == "rcyaml new interface NAME"
    data = json.loads(rcyaml("new", "interface", "Camera", "--format", "json").stdout)
    assert data["files"] == [{"done": "wrote", "path": "interfaces/Camera.idsl.yaml"}]
    assert data["next"] == ["rcyaml compile interfaces/Camera.idsl.yaml"]


def test_another_folder_may_be_named(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("init", "robots/shelly").exit_code == 0
    assert set(read_tree(tmp_path / "robots/shelly")) == OWN_FILES | EXAMPLE
    assert rcyaml("check").exit_code == 0


def test_bare_writes_no_example(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("init", "--bare").exit_code == 0
    assert set(read_tree(tmp_path)) == OWN_FILES
    assert (tmp_path / "interfaces").is_dir() and (tmp_path / "components").is_dir()


def test_a_folder_with_documents_gets_no_example(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": "module: RoboCompSpeech\n"})
    assert rcyaml("init").exit_code == 0
    assert set(read_tree(tmp_path)) == OWN_FILES | {"Speech.idsl.yaml"}


def test_nothing_is_overwritten(rcyaml: Run, tmp_path: Path) -> None:
    mine = {"rcyaml.yaml": "# mine\n", ".gitignore": "mine\n", ".vscode/settings.json": '{"mine": true}'}
    write_tree(tmp_path, mine)
    result = rcyaml("init")
    tree = read_tree(tmp_path)
    assert (tree["rcyaml.yaml"], tree[".gitignore"]) == ("# mine\n", "mine\n")
    assert tree[".vscode/settings.json"].endswith(',"mine": true}')
    assert "kept  rcyaml.yaml\n" in result.stdout


def test_a_second_time_changes_nothing(rcyaml: Run, tmp_path: Path) -> None:
    rcyaml("init")
    before = read_tree(tmp_path)
    result = rcyaml("init")
    assert result.exit_code == 0 and "wrote" not in result.stdout
    assert read_tree(tmp_path) == before


def test_settings_that_cannot_be_read_are_reported(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {".vscode/settings.json": "{ nonsense"})
    result = rcyaml("init")
    assert result.exit_code == 0
    assert "note: .vscode/settings.json is not changed, because it is not JSON" in result.stderr
    assert read_tree(tmp_path)[".vscode/settings.json"] == "{ nonsense"


def test_a_file_is_no_workspace(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"robot": ""})
    assert rcyaml("init", "robot").exit_code == 2


def test_a_file_that_cannot_be_written_is_reported(
    rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(path: Path, _: str) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(whole_file, "create", refuse)
    result = rcyaml("init")
    assert (result.exit_code, result.stderr) == (1, "Error: cannot write rcyaml.yaml: permission denied\n")


def test_quiet_prints_nothing(rcyaml: Run) -> None:
    assert rcyaml("-q", "init").output == ""
