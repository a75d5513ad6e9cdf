"""Parameters and values in the editor: the PDSL from its schema alone, values from their component's own schema."""

from __future__ import annotations

import pytest

from conftest import write_tree
from editor.proposals import assert_can_stand_there
from editor.workbench import Workbench
from robocomp_yaml.emit.component import SCHEMA, schemas
from robocomp_yaml.pipeline import analyse

P = "parameters:\n"
FORMS = ["number", "choice", "text", "secret", "list", "map"]
BASIC = ["bool", "int", "long", "float", "double", "string"]
IN_MEMBER = ["doc", "type", "list", "map", "range", "values", "pattern", "size", "unique", "unit", "default", "optional",
             "secret", "as"]  # fmt: skip
COMPLETIONS = [
    (
        "|",
        [
            "parameters document",
            "types: …",
            "parameters: …",
            "constraints: …",
            "legacy: …",
            "component",
            "doc",
            "types",
            "parameters",
            "constraints",
            "legacy",
        ],
    ),
    ("parameters: |", ["number", "text", "list of records"]),
    (P + "  |", ["number", "text", "list of records"]),
    (P + "  a: |", [*BASIC, *FORMS, "group"]),
    (P + "  a: {t|}", [*IN_MEMBER, "group", "editable"]),
    (P + "  a: {type: |}", BASIC),
    (P + "  a: {type: int, range: |}", ["smallest and largest", "open above", "at least", "above", "at most"]),
    (P + "  a: {list: |}", [*BASIC, "number", "list", "map"]),
    (P + "  a: {list: int, size: |}", ["least and most", "exactly", "at least", "at most"]),
    (P + "  a: {type: int, values: |}", ["list of values"]),
    (P + "  a: {type: bool, editable: |}", ["true", "false"]),
    (P + "  a: {type: string, secret: |}", ["true", "false"]),
    ("types: |", ["struct", "enum", "limited type"]),
    ("types:\n  A: |", ["a struct", "an enum", "a limited type", "a list"]),
    ("types:\n  A: {enum: |}", ["names", "documented names"]),
    ("types:\n  A:\n    struct:\n      a: |", [*BASIC, *FORMS]),
    ("constraints:\n  - |", ["that", "else", "doc"]),
    ("legacy:\n  a: |", ["property", "rows", "lists in one property"]),
]
MESSAGES = [
    (P + "  a: {type: int, rnge: [0, 1]}", ["2:18 Property rnge is not allowed."]),
    (
        P + "  a: 3",
        [
            "2:6 a parameter is a type, such as float or Motor, or a mapping, such as {type: float, range: [0, 2], "
            "default: 0.9}"
        ],
    ),
    (
        P + "  a: {type: int, range: 3}",
        ["2:25 range: is [smallest, largest], or a mapping of from or above, and to or below"],
    ),
    (P + "  a: {type: int, size: -1}", ["2:24 a size is a whole number, from 0"]),
    ("doc: x", ["1:1 the key 'parameters' is missing"]),
]
PDSL = """\
component: c.cdsl.yaml
types:
  Mode: {enum: {slow: {doc: Half the speed.}, fast: }}
  Motor: {struct: {name: string, vel: {type: float, range: [0, 2], default: 0.9, unit: rad/s, doc: How fast it turns.}}}
parameters:
  mode: {type: Mode, default: slow, doc: How hasty.}
  volume: {type: int, range: [0, 100], default: 50, unit: percent}
  on: {type: bool, default: true}
  motors: {list: Motor, size: [1, 2]}
  Yolo: {group: {use_gpu: {type: bool, default: false}}}
"""


@pytest.mark.parametrize(("text", "labels"), COMPLETIONS)
def test_a_pdsl_is_completed(editor: Workbench, text: str, labels: list[str]) -> None:
    proposals = editor.complete("pdsl", text)
    assert [proposal.label for proposal in proposals] == labels
    assert_can_stand_there("pdsl", text, proposals)


def test_one_message_for_each_fault(editor: Workbench) -> None:
    assert editor.messages("pdsl", [text for text, _ in MESSAGES]) == [messages for _, messages in MESSAGES]


@pytest.fixture(scope="module")
def modeline(editor: Workbench, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The first line of values of a component, whose schema stands in the editor's workspace."""
    folder = write_tree(
        tmp_path_factory.mktemp("c"), {"c.cdsl.yaml": "component: C\nlanguage: cpp\n", "c.pdsl.yaml": PDSL}
    )
    program = analyse([str(folder)]).program
    made = {plan.path: plan.text for plan in schemas(next(iter(program.components.values())))}
    write_tree(editor.folder, {"documents/c/" + SCHEMA: made[SCHEMA]})
    return f"# yaml-language-server: $schema=c/{SCHEMA}\n"


VALUES = "parameters:\n"
VALUE_COMPLETIONS = [
    (VALUES + "  |", ["mode", "volume", "on", "motors", "Yolo", "period"]),
    (VALUES + "  mode: |", ["slow", "fast", "from the environment", "from a file"]),
    (VALUES + "  on: |", ["true", "from the environment", "from a file", "false"]),
    (VALUES + "  motors:\n    - {n|}", ["name", "vel"]),
    (VALUES + "  Yolo: {u|}", ["use_gpu"]),
]
VALUE_MESSAGES = [
    ("  mode: fats", ["2:9 this must be one of slow, fast"]),
    ("  volume: 101", ["2:11 this must be a whole number from 0 to 100 (percent)"]),
    ("  volume: true", ["2:11 this must be a whole number from 0 to 100 (percent)"]),
    ("  volume: {env: SPEECH_VOLUME}", []),
    ("  volume: {file: volume.txt}", []),
    ("  volume: {file: volume/}", ["2:18 file: must be the path of a file"]),
    ("  volume: {env: 7}", ["2:17 env: must be the name of an environment variable: letters, digits and underscores"]),
    ("  volum: 1", ["2:3 Property volum is not allowed."]),
    ("  motors: []", ["2:11 there must be 1 to 2 elements"]),
    ("  motors: [{name: a, vel: 3}]", ["2:27 this must be a number from 0 to 2 (rad/s)"]),
    ("  motors: {name: a}", ["2:11 this must be a list of 1 to 2 elements, each of type Motor"]),
    ("  volume: null\n  mode:", []),
]


@pytest.mark.parametrize(("text", "labels"), VALUE_COMPLETIONS)
def test_values_are_completed(editor: Workbench, modeline: str, text: str, labels: list[str]) -> None:
    assert [proposal.label for proposal in editor.complete_with(modeline, text)] == labels


def test_lists_of_records_are_inserted_as_such(editor: Workbench, modeline: str) -> None:
    """What an editor makes of an example, or of a default, that nests is `[object Object]`."""
    inserted = {proposal.label: proposal.text for proposal in editor.complete_with(modeline, VALUES + "  |")}
    assert inserted["motors"] == "motors: "
    (proposal,) = editor.complete_with(modeline, VALUES + "  motors: |")
    assert (proposal.label, proposal.text) == ("list of Motor", "[{name: text, vel: 0.9}]")


def test_values_are_checked(editor: Workbench, modeline: str) -> None:
    documents = [
        (editor.folder / "documents" / f"v{number}.config.yaml", f"{modeline}{VALUES}{text}\n")
        for number, (text, _) in enumerate(VALUE_MESSAGES)
    ]
    assert editor.marked(documents) == [messages for _, messages in VALUE_MESSAGES]


def test_a_hover_says_type_limits_unit_and_default(editor: Workbench, modeline: str) -> None:
    said = editor.hover_with(modeline, VALUES + "  motors: [{name: a, ve|l: 1}]")
    assert "How fast it turns." in said
    assert "A number from 0 to 2 (rad/s); default: 0.9." in said
