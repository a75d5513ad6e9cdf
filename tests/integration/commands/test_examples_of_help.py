"""`--help` of each command ends with examples. Those that need no running network are run, with the robot of the
tutorial; the others are parsed."""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result

from conftest import ROOT, write_tree
from robocomp_yaml.cli import group
from robocomp_yaml.commands._command import examples

Rcyaml = Callable[..., Result]

EXAMPLES = {command.removeprefix("rcyaml "): lines for command, lines in examples().items()}

ROBOT = {
    "components/patrolcomp/patrolcomp.pdsl.yaml": """\
component: patrolcomp.cdsl.yaml
parameters:
  way: {type: float, range: [0, 5], unit: m, default: 0.2}
  speed: {type: float, range: [0.1, 1], unit: m/s, default: 0.5, editable: true}
""",
    "components/patrolcomp/etc/config.yaml": "component: ../patrolcomp.cdsl.yaml\nparameters:\n  speed: 0.5\n",
    "base.mock.yaml": "interfaces: {Base: {methods: {position: {returns: 1.5}}}}\n",
    "legacy/speech.cdsl": 'import "Speech.idsl";\nComponent SpeechComp\n{\n\tCommunications { implements Speech; };\n\tlanguage Python;\n};\n',
    "home/robocomp/interfaces/Speech.idsl": "module RoboCompSpeech { interface Speech { void say(string text); }; };\n",
}
TOPIC = "topics: {Odometry: {methods: {moved: {in: {position: float}}}}}\n"
ENDLESS = ("run", "call", "param", "topic", "top", "record", "mock", "manager", "lsp")
LIVING = (
    "build", "deploy up", "deploy restart", "deploy rollback", "deploy down", "deploy push", "deploy install",
    "deploy uninstall", "deploy probe", "deploy logs",
)  # fmt: skip
BEFORE = {
    "edit move": ["edit add-host laptop 192.168.7.2", "edit add-host onboard 192.168.7.3"],
    "edit remove-host": ["edit add-host laptop 192.168.7.2", "edit add-host spare 192.168.7.3"],
    "edit ungroup": ["edit group all base patrol"],
    "edit unset": ["edit set patrol way 2"],
    "edit after": ["edit publish BaseComp Odometry"],
    "edit not-after": ["edit after patrol base"],
    "edit topic": ["edit publish BaseComp Odometry"],
    "edit unpublish": ["edit publish BaseComp Odometry"],
    "edit unsubscribe": ["edit subscribe PatrolComp Odometry"],
    "edit undo": ["edit port base 10001"],
    "edit redo": ["edit port base 10001", "edit undo"],
    "edit disconnect": ["edit connect patrol Base base"],
    "edit unimplement": ["edit implement PatrolComp Base"],
    "edit require": ["new component PanelComp"],
    "edit port": ["edit port base 10002"],
}  # fmt: skip
"""What makes the examples of a command possible."""
FOLDERS = {"migrate": "legacy"}
"""Where the examples of a command are typed, if not in the robot's folder."""


def leaves(command: click.Command, path: str = "") -> Iterator[str]:
    if isinstance(command, click.Group):
        for name in command.list_commands(click.Context(command)):
            inner = command.get_command(click.Context(command), name)
            assert inner is not None
            yield from leaves(inner, f"{path} {name}".strip())
    else:
        yield path


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("robot") / "robot"
    shutil.copytree(ROOT / "examples" / "patrol", folder)
    write_tree(folder, ROBOT)
    with open(folder / "interfaces" / "Base.idsl.yaml", "a", encoding="utf-8") as file:
        file.write(TOPIC)
    with open(folder / "deployments" / "patrol.ddsl.yaml", "a", encoding="utf-8") as file:
        file.write("services: {storm: {icestorm: {}}}\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        done = CliRunner().invoke(group, ["compile"])
        assert done.exit_code == 0, done.output
    return folder


def test_each_command_has_examples() -> None:
    assert set(leaves(group)) <= EXAMPLES.keys()
    assert EXAMPLES.keys() - set(leaves(group)) == {"record"}


@pytest.mark.parametrize("path", EXAMPLES)
def test_help_shows_them_in_eighty_columns(path: str, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = rcyaml(*path.split(), "--help").output.splitlines()
    shown = EXAMPLES[path]
    assert lines[-len(shown) - 1 :] == ["Examples:", *(f"  {line}" for line in shown)]
    assert max(map(len, lines)) <= 80
    assert all(line.startswith(f"rcyaml {path}") for line in shown)


@pytest.mark.parametrize("path", [one for one in EXAMPLES if not one.startswith(ENDLESS) and one not in LIVING])
def test_they_work(
    path: str, robot: Path, rcyaml: Rcyaml, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    for number, line in enumerate(EXAMPLES[path]):
        folder = tmp_path / str(number)
        shutil.copytree(robot, folder)
        monkeypatch.chdir(folder / FOLDERS.get(path, ""))
        monkeypatch.setenv("HOME", str(folder / "home"))
        for before in BEFORE.get(path, []):
            done = rcyaml(*before.split())
            assert done.exit_code == 0, f"{before}\n{done.output}"
        words = [one.replace("~", str(folder / "home")) for one in shlex.split(line, comments=True)]
        done = rcyaml(*words[1:])
        assert done.exit_code == 0, f"{line}\n{done.output}"


@pytest.mark.parametrize("path", [one for one in EXAMPLES if one.startswith(ENDLESS) or one in LIVING])
def test_they_are_parsed(path: str, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(robot)
    (robot / "drive.mcap").touch()
    for line in EXAMPLES[path]:
        words = shlex.split(line, comments=True)[1:]
        command, parent = group, click.Context(group, info_name="rcyaml")
        while isinstance(command, click.Group):
            inner = command.get_command(parent, words[0] if words else "")
            name, words = (words[0], words[1:]) if inner is not None else ("start", words)  # `rcyaml record TOPIC`
            command = inner or command.get_command(parent, name)
            parent = (
                click.Context(command, info_name=name, parent=parent) if isinstance(command, click.Group) else parent
            )
        assert command is not None
        context = command.make_context(name, words, parent=parent)
        assert context.args == [], line
