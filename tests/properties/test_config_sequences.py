"""Compiles, merges, values documents that come later, and edits, in any order: what nobody edited never stands in the
way, no line of the user is lost, and a proxy leads to the port that is served."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from conftest import write_tree
from robocomp_yaml.cli import group
from verdicts import CASES

RELAXED = settings(max_examples=max(CASES // 25, 6), deadline=None, suppress_health_check=list(HealthCheck))
IDSL = "module: RoboComp{0}\ninterfaces: {{{0}: {{methods: {{go: }}}}}}\n"
NEEDS = ("Mouth", "Arm")
TREE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    **{f"interfaces/{name}.idsl.yaml": IDSL.format(name) for name in ("Speech", *NEEDS)},
    "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [Mouth]\nimplements: [Mouth]\n",
    "mouth/etc/config": "Mouth.Endpoints=tcp -p 12321\nCommonBehavior.Endpoints=tcp -p 12322\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nendpoints: {Arm: tcp -p 12400}\n",  # which is not compiled yet
    "speech/speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 5}}\n",
}  # fmt: skip
SERVED = {"Mouth": "12321", "Arm": "12400"}
DOCUMENT, CONFIG, VALUES = "speech/speech.cdsl.yaml", "speech/etc/config", "speech/etc/config.yaml"
ACTIONS = ("compile", "compile all", "merge", "config new", "edit", "require", "set", "open")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path, before = tmp_path_factory.mktemp("sequences"), Path.cwd()
    os.chdir(path)
    yield path
    os.chdir(before)


def run(*args: str) -> Result:
    result = CliRunner().invoke(group, list(args), prog_name="rcyaml")
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


class Model:
    """What the user has done so far. `mine` are lines that are to stand somewhere; `is_edited` as long as the
    configuration is not rewritten from values."""

    def __init__(self, number: int) -> None:
        self.root = Path(str(number))
        self.root.mkdir()
        write_tree(self.root, TREE)
        os.chdir(self.root)
        self.requires: list[str] = []
        self.mine: list[str] = []
        self.is_edited = False
        self.require("Mouth")

    def require(self, name: str) -> None:
        self.requires = list(dict.fromkeys([*self.requires, name]))
        names = ", ".join(self.requires)
        Path(DOCUMENT).write_text(
            f"component: SpeechComp\nlanguage: python\nimports: [Speech, {names}]\nimplements: [Speech]\n"
            f"requires: [{names}]\n"
        )

    def step(self, action: str) -> None:
        if action == "require":
            self.require("Arm")
        elif action == "config new":
            there = Path(VALUES).exists()
            assert run("config", "new", "SpeechComp").exit_code == (2 if there else 0)
        elif action == "edit" and Path(CONFIG).exists():
            self.is_edited = True
            self.mine.append(f"Mine.{len(self.mine)}=1")
            Path(CONFIG).write_text(f"{Path(CONFIG).read_text()}{self.mine[-1]}\n")
        elif action == "set" and Path(VALUES).exists():
            assert run("config", "set", "SpeechComp", "volume", "7").exit_code == 0
        elif action == "open" and Path(VALUES).exists():  # leaves all connections to rcyaml
            Path(VALUES).write_text("component: ../speech.cdsl.yaml\n")
        elif action in ("compile", "compile all", "merge"):
            self.compile(["--merge"] if action == "merge" else [], "." if action == "compile all" else "speech")
        assert not self.lost()

    def compile(self, options: list[str], what: str) -> None:
        result = run("compile", *options, what)
        assert "RC6001" not in result.output
        assert not result.exit_code, result.output
        if "RC6010" in result.output:
            assert self.is_edited and Path(VALUES).exists() and "Mine.0" in result.output, result.output
            return
        if Path(VALUES).exists():
            self.is_edited = False
        assert self.mine or not list(Path("speech").rglob("*.orig")), "nobody edited anything"
        text = Path(CONFIG).read_text()
        for name in self.requires:
            proxy = re.search(rf"^{name}Proxy=.* -p (\d+)$", text, re.MULTILINE)
            if proxy or Path(VALUES).exists() or options:
                assert proxy and proxy[1] == SERVED[name], text
        assert not run("compile", "--check", *options, what).exit_code

    def lost(self) -> set[str]:
        texts = "".join(path.read_text() for path in Path("speech").glob("etc/*"))
        return {line for line in self.mine if line not in texts and line.replace("=1", ': "1"') not in texts}


@given(sequence=st.lists(st.sampled_from(ACTIONS), min_size=3, max_size=9))
@RELAXED
def test_any_sequence(folder: Path, sequence: list[str]) -> None:
    os.chdir(folder)
    model = Model(len(list(folder.iterdir())))
    for action in sequence:
        model.step(action)


@pytest.mark.parametrize("sequence", [
    ["compile", "require", "merge", "config new", "compile"],
    ["compile all", "config new", "compile", "open", "compile", "compile all"],
    ["compile", "edit", "require", "merge", "config new", "compile"],
    ["compile", "edit", "config new", "compile", "set", "compile"],
    ["config new", "require", "compile", "open", "compile"],
    ["compile", "config new", "open", "edit", "compile"],
])  # fmt: skip
def test_a_sequence(folder: Path, sequence: list[str]) -> None:
    os.chdir(folder)
    model = Model(len(list(folder.iterdir())))
    for action in sequence:
        model.step(action)
