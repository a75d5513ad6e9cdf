"""What the editor proposes, at each construct: where a value is missing, inside a mapping, and behind a letter in {}.

Each row is a kind, a text with the cursor as `|`, and the labels proposed, in their order.
"""

from __future__ import annotations

import pytest

from editor.proposals import assert_can_stand_there
from editor.workbench import Workbench
from robocomp_yaml.languages import table

BASIC = "bool byte short int long float double string".split()
TYPE = [*BASIC, "type of another module"]
STRUCT = "module: A\ntypes:\n  P:\n    struct:\n"
METHOD = "module: A\ninterfaces:\n  I:\n    methods:\n"
TOPIC = "module: A\ntopics:\n  T:\n    methods:\n"
COMPONENT = "component: A\nlanguage: cpp\n"
MACHINE = COMPONENT + "statemachine:\n  initial: a\n"

IDSL = [
    ("|", ["interface document", "imports: […]", "constants: …", "types: …", "exceptions: …", "interfaces: …",
           "topics: …", "module", "doc", "imports", "constants", "types", "exceptions", "interfaces",
           "topics"]),
    ("module: |", ["for example RoboCompSpeech"]),
    ("module: A\ndoc: |", ["for example Says things."]),
    ("module: A\nimports: |", ["list of imports"]),
    ("module: A\nimports:\n  - |", ["for example CommonTypes"]),
    ("module: A\nimports: [C|]", ["for example CommonTypes"]),
    # constants
    ("module: A\nconstants: |", ["constant"]),
    ("module: A\nconstants:\n  |", ["constant"]),
    ("module: A\nconstants:\n  c: |", ["type and value", "with unit and documentation"]),
    ("module: A\nconstants:\n  c: {t|}", ["type", "value", "unit", "doc"]),
    ("module: A\nconstants:\n  c: {type: |}", TYPE),
    ("module: A\nconstants:\n  c: {type: int, value: |}", ["for example 100", "for example spanish", "true", "false"]),
    ("module: A\nconstants:\n  c: {type: int, value: 1, unit: |}", ["for example m/s", "for example rad", "for example percent"]),
    # types
    ("module: A\ntypes: |", ["struct", "enum", "sequence", "map"]),
    ("module: A\ntypes:\n  |", ["struct", "enum", "sequence", "map"]),
    ("module: A\ntypes:\n  P: |", ["a struct", "an enum", "a sequence", "a map"]),
    ("module: A\ntypes:\n  P:\n    |",
     ["struct: {…}", "enum: […]", "map: {…}", "struct", "enum", "sequence", "map", "doc"]),
    ("module: A\ntypes:\n  P: {s|}",
     ["struct: {…}", "enum: […]", "map: {…}", "struct", "enum", "sequence", "map", "doc"]),
    ("module: A\ntypes:\n  P: {struct: |}", ["members"]),
    (STRUCT + "      |", ["member", "documented member"]),
    ("module: A\ntypes:\n  P: {struct: {x|}}", ["member", "documented member"]),
    (STRUCT + "      x: |", [*TYPE, "long form"]),
    (STRUCT + "      x:\n        |", ["type", "default", "unit", "doc"]),
    (STRUCT + "      x: {t|}", ["type", "default", "unit", "doc"]),
    (STRUCT + "      x: {type: float, default: |}", ["for example 0", "for example spanish", "true", "false"]),
    ("module: A\ntypes:\n  P: {enum: |}", ["names", "names with numbers"]),
    ("module: A\ntypes:\n  P:\n    enum: |", ["names", "names with numbers"]),
    ("module: A\ntypes:\n  P: {enum: [s|]}", ["for example spanish"]),
    ("module: A\ntypes:\n  P:\n    enum:\n      a: 0\n      |", ["enumerator", "documented enumerator"]),
    ("module: A\ntypes:\n  P: {enum: {a|}}", ["enumerator", "documented enumerator"]),
    ("module: A\ntypes:\n  P: {enum: {a: |}}", ["number", "long form"]),
    ("module: A\ntypes:\n  P: {enum: {a: {v|}}}", ["value", "doc"]),
    ("module: A\ntypes:\n  P: {enum: {a: {value: |}}}", ["5"]),
    ("module: A\ntypes:\n  P: {sequence: |}", TYPE),
    ("module: A\ntypes:\n  P: {map: |}", ["key and value"]),
    ("module: A\ntypes:\n  P:\n    map:\n      |", ["key", "value"]),
    ("module: A\ntypes:\n  P: {map: {k|}}", ["key", "value"]),
    ("module: A\ntypes:\n  P: {map: {key: |}}", TYPE),
    # exceptions
    ("module: A\nexceptions: |", ["exception"]),
    ("module: A\nexceptions:\n  |", ["exception"]),
    ("module: A\nexceptions:\n  E: |", ["with a text"]),
    ("module: A\nexceptions:\n  E:\n    |", ["struct: {…}", "doc", "struct"]),
    ("module: A\nexceptions:\n  E: {s|}", ["struct: {…}", "doc", "struct"]),
    # interfaces
    ("module: A\ninterfaces: |", ["interface"]),
    ("module: A\ninterfaces:\n  |", ["interface"]),
    ("module: A\ninterfaces:\n  I: |", ["interface with a method"]),
    ("module: A\ninterfaces:\n  I:\n    |", ["methods: …", "doc", "methods"]),
    ("module: A\ninterfaces:\n  I:\n    methods: |", ["method", "query", "documented method block"]),
    (METHOD + "      |", ["method", "query", "documented method block"]),
    (METHOD + "      f: |", ["parameters and result", "only a result", "documented method"]),
    (METHOD + "      f:\n        |",
     ["in: {…}", "out: {…}", "throws: […]", "doc", "in", "out", "returns", "throws", "idempotent"]),
    (METHOD + "      f: {i|}",
     ["in: {…}", "out: {…}", "throws: […]", "doc", "in", "out", "returns", "throws", "idempotent"]),
    (METHOD + "      f: {in: |}", ["parameters"]),
    (METHOD + "      f: {in: {a|}}", ["parameter", "documented parameter"]),
    (METHOD + "      f: {in: {a: |}}", [*TYPE, "long form"]),
    (METHOD + "      f: {in: {a: {t|}}}", ["type", "unit", "doc"]),
    (METHOD + "      f: {out: |}", ["parameters"]),
    (METHOD + "      f:\n        out:\n          |", ["parameter", "documented parameter"]),
    (METHOD + "      f: {returns: |}", [*TYPE, "long form"]),
    (METHOD + "      f: {returns: {t|}}", ["type", "unit", "doc"]),
    (METHOD + "      f: {throws: |}", ["list of exceptions"]),
    (METHOD + "      f: {throws: [H|]}", ["for example HardwareFailed"]),
    (METHOD + "      f: {idempotent: |}", ["true", "false"]),
    # topics
    ("module: A\ntopics: |", ["topic"]),
    ("module: A\ntopics:\n  |", ["topic"]),
    ("module: A\ntopics:\n  T: |", ["topic with a method"]),
    ("module: A\ntopics:\n  T:\n    |", ["methods: …", "doc", "methods"]),
    (TOPIC + "      |", ["method", "documented method block"]),
    (TOPIC + "      f: |", ["parameters", "documented method"]),
    (TOPIC + "      f:\n        |", ["in: {…}", "doc", "in", "idempotent"]),
    (TOPIC + "      f: {i|}", ["in: {…}", "doc", "in", "idempotent"]),
]  # fmt: skip

TIME = ["for example 100 ms", "for example 100", "seconds"]
ENTRY = ["under a name of its own", "with more about it"]
LANGUAGES = [
    label for one in table().values()
    for label in (one.name, *([f"{one.name} with its standard"] if one.standards else []))
]  # fmt: skip
CDSL = [
    ("|", ["component document", "imports: […]", "implements: […]", "requires: […]", "publishes: […]",
           "subscribes: […]", "period: 100 ms", "gui: {…}", "statemachine: …", "uses: …", "component",
           "doc", "language", "imports", "implements", "requires", "publishes", "subscribes", "parameters", "period",
           "statemachine", "gui", "options", "compatibility", "uses"]),
    ("component: |", ["for example SpeechComp"]),
    ("component: A\nlanguage: |", LANGUAGES),
    ("component: A\nlanguage: {n|}", ["name", "standard"]),
    ("component: A\nlanguage: {name: |}", [*table()]),
    ("component: A\nlanguage: {name: cpp, standard: |}", ["17", "20", "23"]),
    (COMPONENT + "imports: |", ["list of imports"]),
    (COMPONENT + "implements: |", ["list of interfaces"]),
    (COMPONENT + "implements:\n  - |", ENTRY),
    (COMPONENT + "implements:\n  - {C|}", ENTRY),
    (COMPONENT + "implements:\n  - C: |", ["long form"]),
    (COMPONENT + "implements:\n  - C:\n      |", ["interface", "doc"]),
    (COMPONENT + "requires: |", ["list of interfaces"]),
    (COMPONENT + "requires:\n  - |", ENTRY),
    (COMPONENT + "requires:\n  - Mouth\n  - M|", ENTRY),
    (COMPONENT + "requires: [M|]", ENTRY),
    (COMPONENT + "requires: [{M|}]", ENTRY),
    (COMPONENT + "requires:\n  - {M: |}", ["long form"]),
    (COMPONENT + "requires:\n  - {M: {a|}}", ["interface", "absent", "timeout", "doc"]),
    (COMPONENT + "requires:\n  - M:\n      |", ["interface", "absent", "timeout", "doc"]),
    (COMPONENT + "requires:\n  - {M: {interface: |}}", ["for example Camera", "for example RoboCompCamera.Camera"]),
    (COMPONENT + "requires:\n  - {M: {absent: |}}", ["wait", "fail", "ignore"]),
    (COMPONENT + "requires:\n  - {M: {timeout: |}}", TIME),
    (COMPONENT + "publishes: |", ["list of topics"]),
    (COMPONENT + "publishes:\n  - |", ENTRY),
    (COMPONENT + "subscribes: |", ["list of topics"]),
    (COMPONENT + "subscribes: [A|]", ENTRY),
    (COMPONENT + "parameters: |", ["for example speech.pdsl.yaml"]),
    (COMPONENT + "period: |", TIME),
    (COMPONENT + "options: |", ["list of options"]),
    (COMPONENT + "options: [d|]", ["for example dsr"]),
    (COMPONENT + "compatibility: |", ["robocomp"]),
    # gui
    (COMPONENT + "gui: |", ["Qt window"]),
    (COMPONENT + "gui:\n  |", ["toolkit", "base"]),
    (COMPONENT + "gui: {t|}", ["toolkit", "base"]),
    (COMPONENT + "gui: {toolkit: |}", ["qt"]),
    (COMPONENT + "gui: {toolkit: qt, base: |}", ["QWidget", "QMainWindow", "QDialog"]),
    # statemachine
    (COMPONENT + "statemachine: |", ["SCXML file", "inline machine"]),
    (COMPONENT + "statemachine:\n  |", ["states: {…}", "transitions: {…}", "doc", "initial", "final",
                                        "states", "transitions", "events"]),
    (MACHINE + "  states: |", ["state", "state with states"]),
    (MACHINE + "  states:\n    |", ["state", "state with states"]),
    (MACHINE + "  states: {c|}", ["state", "state with states"]),
    (MACHINE + "  states: {c: |}", ["plain state", "state with states"]),
    (MACHINE + "  states: {c: {i|}}", ["doc", "initial", "final", "states", "transitions", "parallel", "history", "entry",
                                         "exit"]),
    (MACHINE + "  transitions:\n    |", ["transition", "several transitions"]),
    (MACHINE + "  transitions:\n    a: |", ["state", "transition on an event", "list of transitions"]),
    (MACHINE + "  transitions:\n    a:\n      - |", ["to", "event", "if", "do", "internal", "doc"]),
    (MACHINE + "  transitions:\n    a: {t|}", ["to", "event", "if", "do", "internal", "doc"]),
    (MACHINE + "  transitions:\n    a: [{t|}]", ["to", "event", "if", "do", "internal", "doc"]),
    (MACHINE + "  transitions: {a: {to: |}}", ["several states"]),
    (MACHINE + "  transitions: {a: {do: |}}", ["method", "list of actions"]),
    (MACHINE + "  transitions: {a: {do: [{r|}]}}", ["raise", "send", "after", "id", "cancel", "doc"]),
    (MACHINE + "  events: |", ["list of events"]),
    (MACHINE + "  states: {c: {entry: |}}", ["method", "list of actions"]),
    (MACHINE + "  states: {c: {parallel: |}}", ["true", "false"]),
    (MACHINE + "  states: {c: {history: |}}", ["shallow", "deep"]),
    # uses
    (COMPONENT + "uses: |", ["libraries", "sources"]),
    (COMPONENT + "uses:\n  |", ["libraries: […]", "sources: […]", "sources", "classes", "libraries"]),
    (COMPONENT + "uses: {s|}", ["libraries: […]", "sources: […]", "sources", "classes", "libraries"]),
    (COMPONENT + "uses: {sources: |}", ["list of files"]),
    (COMPONENT + "uses: {classes: |}", ["list of class folders"]),
    (COMPONENT + "uses: {libraries: |}", ["list of libraries"]),
    (COMPONENT + "uses:\n  libraries:\n    - cmake: A\n      |", ["pkg-config", "link", "pip", "version", "doc"]),
    (COMPONENT + "uses:\n  libraries:\n    - {cmake: A, v|}", ["pkg-config", "link", "pip", "version", "doc"]),
]  # fmt: skip

WORKSPACE = [
    ("|", ["workspace", "doc", "interfaces", "output", "ports", "plugins", "lint"]),
    ("ports: |", ["range of ports"]),
    ("ports: {f|}", ["from", "to"]),
    ("interfaces: |", ["list of folders"]),
    ("interfaces:\n  - |", ["for example interfaces/"]),
    ("output: |", ["Slice folder"]),
    ("output: {s|}", ["slice", "runtime"]),
    ("lint: |", ["severity of a code"]),
    ("lint:\n  |", ["severity of a code"]),
    ("lint: {R|}", ["severity of a code"]),
    ("lint:\n  RC2003: |", ["error", "warning", "note", '"off"']),
]

ROWS = [(kind, *row) for kind, rows in (("idsl", IDSL), ("cdsl", CDSL), ("workspace", WORKSPACE)) for row in rows]


def named(row: object) -> str:
    return repr(row) if isinstance(row, str) else ""


@pytest.mark.parametrize(("kind", "text", "labels"), ROWS, ids=named)
def test_the_right_things_are_proposed(editor: Workbench, kind: str, text: str, labels: list[str]) -> None:
    proposals = editor.complete(kind, text)
    assert [proposal.label for proposal in proposals] == labels
    assert len({proposal.text for proposal in proposals}) == len(labels), "two proposals are the same"


@pytest.mark.parametrize(("kind", "text", "labels"), ROWS, ids=named)
def test_what_is_proposed_can_stand_there(editor: Workbench, kind: str, text: str, labels: list[str]) -> None:
    assert_can_stand_there(kind, text, editor.complete(kind, text))
