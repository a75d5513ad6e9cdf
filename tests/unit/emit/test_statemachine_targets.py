"""The files of a state machine in a component, for each language."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.emit.component import of_language
from robocomp_yaml.languages.cpp.text import literal as cpp_literal
from robocomp_yaml.languages.python.statemachine import text as python
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.transactions.plan import FilePlan

DOOR = """component: Door
language: LANGUAGE
statemachine:
  initial: closed
  final: gone
  events: [open, door.push]
  states:
    closed: {doc: Nobody passes.}
    opened:
      initial: still
      entry: [ring, {send: tired, after: 5 s, id: patience}]
      exit: {cancel: patience}
      states: {still: {}, moving: {}, last: {history: deep}}
      transitions:
        still: {to: moving, event: door.push, if: "pushed and not In('closed')", do: ring}
        last: still
  transitions:
    closed: {to: opened, event: open}
    opened: {to: gone, event: tired, do: killYourSelf}
"""
PLAIN = "component: Door\nlanguage: LANGUAGE\n"


def planned(folder: Path, document: str, language: str, **others: str) -> dict[str, FilePlan]:
    write_tree(folder, {"door.cdsl.yaml": document.replace("LANGUAGE", language), **others})
    analysis = analyse([str(folder)])
    assert not analysis.diagnostics
    [component] = analysis.program.components.values()
    return {file.path: file for file in of_language(component)}


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_golden(language: str, tmp_path: Path, golden: Callable[[str, Mapping[str, str]], None]) -> None:
    files = planned(tmp_path, DOOR, language)
    own = ("generated/statemachine.", "generated/genericworker.", "src/")
    golden(f"statemachine/{language}", {path: file.text for path, file in files.items() if path.startswith(own)})


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_a_component_without_a_machine_has_no_such_files(language: str, tmp_path: Path) -> None:
    with_machine, without = planned(tmp_path / "a", DOOR, language), planned(tmp_path / "b", PLAIN, language)
    more = {path for path in with_machine if path not in without}
    assert more == {path for path in with_machine if "/machine/" in path or "/statemachine." in path}
    assert not any(
        "machine" in file.text
        for path, file in without.items()
        if not path.startswith(("generated/runtime/", "generated/cmake/"))
    )


def test_only_machines_with_scripts_have_the_evaluator(tmp_path: Path) -> None:
    scxml = '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" datamodel="{}"><final id="a"/></scxml>\n'
    document = PLAIN + "statemachine: door.scxml\n"
    for datamodel in ("null", "python"):
        files = planned(tmp_path / datamodel, document, "python", **{"door.scxml": scxml.format(datamodel)})
        assert ("generated/machine/scripting.py" in files) == (datamodel == "python")
        machine = {path: file.text for path, file in files.items() if "runtime" not in path}
        evaluates = {path for path, text in machine.items() if "eval(" in text or "exec(" in text}
        assert evaluates == ({"generated/machine/scripting.py"} if datamodel == "python" else set())


@pytest.mark.parametrize("language", ["python", "cpp"])
@pytest.mark.parametrize(
    ("name", "member"),
    [("patrol", "patrol"), ("timer", "defaultMachine"), ("", "defaultMachine"), ("a-b", "defaultMachine")],
)
def test_robocomps_machine_has_the_name_of_its_file(name: str, member: str, language: str, tmp_path: Path) -> None:
    scxml = f'<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" name="{name}"><final id="a"/></scxml>\n'
    document = PLAIN + "statemachine: door.scxml\ncompatibility: robocomp\n"
    files = planned(tmp_path, document, language, **{"door.scxml": scxml})
    path, line = {
        "python": ("generated/robocomp/genericworker.py", f"self.{member} = _machine.StateMachine("),
        "cpp": ("generated/genericworker.h", f"robocomp::Machine {member};"),
    }[language]
    assert line in files[path].text


@pytest.mark.parametrize("text", ['"', "\\", "'''", "\n", "??/", "é\0", '*/ #include "x"', "{{ x }}", "\x1b[0m"])
def test_texts_stay_texts(text: str) -> None:
    assert eval(python(text)) == text
    literal = cpp_literal(text)
    assert "\n" not in literal and '"' not in literal[1:-1].replace('\\"', "").replace("\\042", "")
