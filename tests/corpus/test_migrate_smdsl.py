"""Real state machines: the SCXML has the states and transitions of the file, which are read in another way."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner

from conftest import CORPUS, needs_corpus
from robocomp_yaml.cli import group
from robocomp_yaml.pipeline import analyse

pytestmark = needs_corpus
FILES = sorted((CORPUS / "smdsl").glob("*.smdsl")) if CORPUS.is_dir() else []
NEGATIVE = "robolab__phidgetimu__statemachine"
SPACE = "{http://www.w3.org/2005/07/scxml}"

Facts = tuple[dict[str, str], set[tuple[str, str]], dict[str, str], set[str], set[str]]


def _said(text: str) -> Facts:
    """Return each state with its parent, transitions, initial states by parent, end states and parallel ones; read with
    regular expressions only."""
    bare = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    parents: dict[str, str] = {}
    transitions: set[tuple[str, str]] = set()
    initial: dict[str, str] = {}
    final: set[str] = set()
    parallel: set[str] = set()
    for colon, name, is_parallel, body in re.findall(r"(:?)(\w+)\s*(parallel)?\s*\{((?:[^{}]|\{[^{}]*\})*)\}", bare):
        parent = name if colon else ""
        parallel |= {name} if is_parallel else set()
        plain = re.sub(r"transitions?\s*\{[^}]*\}", "", body)
        for word, names in re.findall(r"(states|initial_state|end_state)\s+([^;]+);", plain):
            for state in (part.strip() for part in names.split(",")):
                parents[state] = parent
                if word == "initial_state":
                    initial[parent] = state
                if word == "end_state":
                    final.add(state)
        for inner in re.findall(r"transitions?\s*\{([^}]*)\}", body):
            for source, targets in re.findall(r"(\w+)\s*=>\s*([^;]+);", inner):
                transitions |= {(source, target.strip()) for target in targets.split(",")}
    return parents, transitions, initial, final, parallel


def _written(path: Path) -> Facts:
    parents: dict[str, str] = {}
    transitions: set[tuple[str, str]] = set()
    initial: dict[str, str] = {}
    final: set[str] = set()
    parallel: set[str] = set()

    def walk(element: ElementTree.Element, parent: str) -> None:
        for child in element:
            name = child.get("id", "")
            kind = child.tag.removeprefix(SPACE)
            if kind == "transition":
                target = child.get("target", "")
                assert child.get("event") == f"t_{parent}_to_{target}"
                transitions.add((parent, target))
                continue
            parents[name] = parent
            final.update({name} if kind == "final" else set())
            parallel.update({name} if kind == "parallel" else set())
            if child.get("initial"):
                initial[name] = child.get("initial", "")
            walk(child, name)

    root = ElementTree.parse(path).getroot()
    initial[""] = root.get("initial", "")
    walk(root, "")
    return parents, transitions, initial, final, parallel


@pytest.mark.parametrize("file", [f for f in FILES if f.stem != NEGATIVE], ids=lambda file: file.stem)
def test_states_and_transitions(file: Path, tmp_path: Path) -> None:
    shutil.copyfile(file, tmp_path / "sm.smdsl")
    result = CliRunner().invoke(group, ["migrate", str(tmp_path / "sm.smdsl")])
    assert result.exit_code == 0, result.output
    assert _written(tmp_path / "sm.scxml") == _said(file.read_text(encoding="utf-8"))
    for language in ("python", "cpp"):
        document = f"component: C\nlanguage: {language}\nstatemachine: sm.scxml\n"
        (tmp_path / "c.cdsl.yaml").write_text(document, encoding="utf-8")
        assert [d for d in analyse([str(tmp_path)]).diagnostics if d.severity == "error"] == []


def test_the_syntax_help_is_rejected(tmp_path: Path) -> None:
    shutil.copyfile(CORPUS / "smdsl" / f"{NEGATIVE}.smdsl", tmp_path / "sm.smdsl")
    result = CliRunner().invoke(group, ["migrate", str(tmp_path / "sm.smdsl")])
    assert result.exit_code == 1
    assert "sm.smdsl:2:5" in result.output
    assert not (tmp_path / "sm.scxml").exists()
