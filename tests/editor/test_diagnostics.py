"""What the editor marks: one message for each fault, in words that say what would be right; nothing on right documents.

Each row is a kind, a text, and all that is marked in it, as `line:column message`; the modeline is line 0.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from editor.workbench import Workbench
from robocomp_yaml.source import schema, tree
from robocomp_yaml.source.discover import kind_of

DOCUMENTS = Path(__file__).resolve().parent / "documents"
C = "component: A\nlanguage: cpp\n"
NAME = "letters, digits and underscores, not starting with a digit"
A_NAME = "a name consists of letters, digits and underscores, and does not start with a digit"
TYPE = "a type is a name, such as float, Pose or CommonTypes.Pose"
MEMBER = "a member is a type, such as float or CommonTypes.Pose, or {type: float, default: 0, unit: m, doc: …}"
PARAMETER = "a parameter is a type, such as float or CommonTypes.Pose, or {type: float, unit: m/s, doc: …}"
METHOD = "a method is a mapping, such as {in: {text: string}, returns: bool}, or an empty value"
ENUM = "enum: is a list of names, [spanish, english], or a mapping of names to numbers, {spanish: 0, english: 5}"
RANGE = "an enumerator's value is an integer from 0 to 2147483647"
ENTRY = "an element is an interface, such as Camera, or {Camera1: Camera}, or {Camera1: {interface: Camera, "
PROXY = ENTRY + "absent: ignore, timeout: 10 s}}"
PORT = ENTRY + "doc: …}}"
TIME = "a time is milliseconds, such as 100, or has a unit, such as 100 ms or 10 s"

IDSL: list[tuple[str, list[str]]] = [
    ("- a", ["1:1 an interface document is a mapping: module: RoboCompSpeech, and what it defines"]),
    ("doc: x", ["1:1 the key 'module' is missing"]),
    ("module: A\ninterface: {}", ["2:1 Property interface is not allowed."]),
    ("module: a.b", [f"1:9 module: is a name: {NAME}"]),
    ("module: 3", [f"1:9 module: is a name: {NAME}"]),
    ("module: A\ndoc: [x]", ["2:6 doc: is text (Markdown); a text of several lines starts with |"]),
    ("module: A\nimports: B", ["2:10 imports: is a list of interface documents, such as [CommonTypes]"]),
    ("module: A\nimports: [3]",
     ["2:11 an import is the name of an interface document, such as CommonTypes, or a relative path"]),
    ("module: A\nconstants: [a]",
     ["2:12 constants: is a mapping of names to constants, such as maxVolume: {type: int, value: 100}"]),
    ("module: A\nconstants: {c: 3}", ["2:16 a constant is its type and its value, such as {type: int, value: 100}"]),
    ("module: A\nconstants: {c: {type: int}}", ["2:13 the key 'value' is missing"]),
    ("module: A\nconstants: {c: {type: int, value: [1]}}",
     ["2:35 a constant's value is one value: true, 100, a text, or the name of an enumerator"]),
    ("module: A\nconstants: {c: {type: in t, value: 1}}", [f"2:23 {TYPE}"]),
    ("module: A\nconstants: {1c: {type: int, value: 1}}", [f"2:13 {A_NAME}"]),
    ("module: A\nconstants: {c: {type: int, value: 1, unit: 3}}", ["2:44 unit: is text, such as m/s"]),
    ('module: A\nconstants: {c: {type: int, value: 1, unit: "m\\t"}}',
     ["2:44 this is one line of text, without control characters"]),
    ("module: A\ntypes: P",
     ["2:8 types: is a mapping of names to types, such as Pose: {struct: {x: float, y: float}}"]),
    ("module: A\ntypes: {P: int}",
     ["2:12 a type is a struct, an enum, a sequence or a map, such as {struct: {x: float, y: float}}"]),
    ("module: A\ntypes: {a b: {sequence: int}}", [f"2:9 {A_NAME}"]),
    ("module: A\ntypes: {P: {strct: {x: int}}}", ["2:13 Property strct is not allowed."]),
    ("module: A\ntypes: {P: {struct: [x]}}",
     ["2:21 struct: is a mapping of names to types, such as {x: float, y: float}"]),
    ("module: A\ntypes: {P: {struct: {x: }}}", [f"2:25 {MEMBER}"]),
    ("module: A\ntypes: {P: {struct: {x: 3}}}", [f"2:25 {MEMBER}"]),
    ("module: A\ntypes: {P: {struct: {x: vector<int>}}}", [f"2:25 {MEMBER}"]),
    ("module: A\ntypes: {P: {struct: {x: {default: 3}}}}", ["2:22 the key 'type' is missing"]),
    ("module: A\ntypes: {P: {struct: {x: {type: int, defualt: 3}}}}", ["2:37 Property defualt is not allowed."]),
    ("module: A\ntypes: {P: {struct: {x: {type: int, default: [3]}}}}",
     ["2:46 a default is one value: true, 0.5, a text, or the name of an enumerator"]),
    ("module: A\ntypes: {P: {enum: one}}", [f"2:19 {ENUM}"]),
    ("module: A\ntypes: {P: {enum: [one, 2]}}", [f"2:25 an enumerator is a name: {NAME}"]),
    ("module: A\ntypes: {P: {enum: {one: first}}}",
     ["2:25 an enumerator's value is an integer from 0 to 2147483647, empty, or {value: 5, doc: …}"]),
    ("module: A\ntypes: {P: {enum: {one: -1}}}", [f"2:25 {RANGE}"]),
    ("module: A\ntypes: {P: {enum: {one: {value: 3000000000}}}}", [f"2:33 {RANGE}"]),
    ("module: A\ntypes: {P: {enum: {one: {value: x}}}}", [f"2:33 {RANGE}"]),
    ("module: A\ntypes: {P: {sequence: [int]}}", [f"2:23 {TYPE}"]),
    ("module: A\ntypes: {P: {map: int}}",
     ["2:18 map: is a mapping with the types of key and value, such as {key: string, value: Pose}"]),
    ("module: A\ntypes: {P: {map: {value: int}}}", ["2:13 the key 'key' is missing"]),
    ("module: A\ntypes: {P: {map: {key: int}}}", ["2:13 the key 'value' is missing"]),
    ("module: A\ntypes: {P: {map: {key: 3, value: int}}}", [f"2:24 {TYPE}"]),
    ("module: A\nexceptions: {E: what}",
     ["2:17 an exception is a mapping, such as {doc: …, struct: {what: string}}, or an empty value"]),
    ("module: A\nexceptions: [E]",
     ["2:13 exceptions: is a mapping of names to exceptions, such as HardwareFailed: {struct: {what: string}}"]),
    ("module: A\ninterfaces: [I]",
     ["2:13 interfaces: is a mapping of names to interfaces, such as Speech: {methods: {isBusy: {returns: bool}}}"]),
    ("module: A\ninterfaces: {I: }",
     ["2:17 an interface is a mapping, such as {doc: …, methods: {isBusy: {returns: bool}}}"]),
    ("module: A\ninterfaces: {I: {extends: J}}", ["2:18 Property extends is not allowed."]),
    ("module: A\ninterfaces: {I: {methods: [f]}}",
     ["2:27 methods: is a mapping of names to methods, such as isBusy: {returns: bool}"]),
    ("module: A\ninterfaces: {I: {methods: {f: int}}}", [f"2:31 {METHOD}"]),
    ("module: A\ninterfaces: {I: {methods: {f: {in: [x]}}}}",
     ["2:36 in: is a mapping of names to types, such as {text: string, overwrite: bool}"]),
    ("module: A\ninterfaces: {I: {methods: {f: {in: {x: 3}}}}}", [f"2:40 {PARAMETER}"]),
    ("module: A\ninterfaces: {I: {methods: {f: {in: {x: {unit: m}}}}}}", ["2:37 the key 'type' is missing"]),
    ("module: A\ninterfaces: {I: {methods: {f: {out: int}}}}",
     ["2:37 out: is a mapping of names to types, such as {volume: int, queue: Utterances}"]),
    ("module: A\ninterfaces: {I: {methods: {f: {returns: [int]}}}}",
     ["2:41 returns: is a type, such as bool or CommonTypes.Pose, or {type: bool, doc: …}"]),
    ("module: A\ninterfaces: {I: {methods: {f: {throws: E}}}}",
     ["2:40 throws: is a list of exceptions, such as [HardwareFailed]"]),
    ("module: A\ninterfaces: {I: {methods: {f: {throws: [3]}}}}",
     ["2:41 an exception is a name, such as HardwareFailed or CommonTypes.HardwareFailed"]),
    ("module: A\ninterfaces: {I: {methods: {f: {idempotent: maybe}}}}", ["2:44 idempotent: is true or false"]),
    ("module: A\ntopics: [T]",
     ["2:9 topics: is a mapping of names to topics, such as SpeechEvents: {methods: {spoken: {in: {text: string}}}}"]),
    ("module: A\ntopics: {T: [f]}",
     ["2:13 a topic is a mapping, such as {doc: …, methods: {spoken: {in: {text: string}}}}"]),
    ("module: A\ntopics: {T: {methods: [f]}}",
     ["2:23 methods: is a mapping of names to methods, such as spoken: {in: {text: string}}"]),
    ("module: A\ntopics: {T: {methods: {f: {returns: int}}}}",
     ["2:28 a topic is one-way: its methods have only in:"]),
    ("module: A\ntopics: {T: {methods: {f: {in: {x: int}, out: {y: int}}}}}",
     ["2:42 a topic is one-way: its methods have only in:"]),
    ("module: A\ntopics: {T: {methods: {f: int}}}",
     ["2:27 a method of a topic is a mapping, such as {in: {text: string}}, or an empty value"]),
]  # fmt: skip

CDSL: list[tuple[str, list[str]]] = [
    ("[]",
     ["1:1 a component document is a mapping: component: SpeechComp, language: python, and its interfaces"]),
    ("language: cpp", ["1:1 the key 'component' is missing"]),
    ("component: A", ["1:1 the key 'language' is missing"]),
    (C + "implement: [A]", ["3:1 Property implement is not allowed."]),
    ("component: a b\nlanguage: cpp", [f"1:12 component: is a name: {NAME}"]),
    ("component: A\nlanguage: rust", ["2:11 language: is python, cpp, java, or {name: cpp, standard: 20}"]),
    ("component: A\nlanguage: [cpp]", ["2:11 language: is python, cpp, java, or {name: cpp, standard: 20}"]),
    ("component: A\nlanguage: {standard: 20}", ["2:1 the key 'name' is missing"]),
    ("component: A\nlanguage: {name: rust}", ["2:18 a language is python, cpp or java"]),
    ("component: A\nlanguage: {name: cpp, standard: 11}", ["2:33 standard: is the C++ standard: 17, 20 or 23"]),
    (C + "implements: A", ["3:13 implements: is a list of interfaces, such as [Speech]"]),
    (C + "implements: [3]", [f"3:14 {PORT}"]),
    (C + "implements: [{A: [B]}]",
     ["3:18 the value of a name is an interface, {Camera1: Camera}, or a mapping, {Camera1: {interface: Camera, doc: …}}"]),
    (C + "implements: [{A: {absent: fail}}]", ["3:19 Property absent is not allowed."]),
    (C + "requires: {A: B}", ["3:11 requires: is a list of interfaces, such as [Mouth, {Mouth1: Mouth}]"]),
    (C + "requires: [a-b]", [f"3:12 {PROXY}"]),
    (C + "requires: [{}]", [f"3:12 {PROXY}"]),
    (C + "requires: [{A: B, C: D}]",
     ["3:12 each element has one name: - {Camera1: Camera} and - {Camera2: Camera} are two elements"]),
    (C + "requires: [{1A: B}]", [f"3:13 {A_NAME}"]),
    (C + "requires: [{A: [B]}]",
     ["3:16 the value of a name is an interface, {Camera1: Camera}, or a mapping, {Camera1: {interface: Camera, "
      "absent: ignore, timeout: 10 s}}"]),
    (C + "requires: [{A: {interface: 3}}]", ["3:28 an interface is a name, such as Camera or RoboCompCamera.Camera"]),
    (C + "requires: [{A: {absent: no}}]", ["3:25 absent: is wait, fail or ignore"]),
    (C + "requires: [{A: {timeout: 3 parsecs}}]", [f"3:26 {TIME}"]),
    (C + "publishes: A", ["3:12 publishes: is a list of topics, such as [SpeechEvents]"]),
    (C + "subscribes: A", ["3:13 subscribes: is a list of topics, such as [Asr]"]),
    (C + "parameters: [a]", ["3:13 parameters: is a path, such as speech.pdsl.yaml"]),
    (C + "period: fast", [f"3:9 {TIME}"]),
    (C + "period: 0", ["3:9 a time is at least 1 ms"]),
    (C + "period: 0 ms", [f"3:9 {TIME}"]),
    (C + "period: 1.5", [f"3:9 {TIME}"]),
    (C + "gui: qt", ["3:6 gui: is a mapping, such as {toolkit: qt, base: QWidget}"]),
    (C + "gui: {toolkit: gtk}", ["3:16 toolkit: is qt"]),
    (C + "gui: {toolkit: qt, base: QLabel}", ["3:26 base: is QWidget, QMainWindow or QDialog"]),
    (C + "gui: {base: QWidget}", ["3:1 the key 'toolkit' is missing"]),
    (C + "options: dsr", ["3:10 options: is a list of names, such as [dsr]"]),
    (C + "options: [3]", ["3:11 an option is a name, such as dsr"]),
    (C + "compatibility: ros", ["3:16 compatibility: is robocomp"]),
    (C + "statemachine: [a]",
     ["3:15 statemachine: is an SCXML file, such as speech.scxml, or {initial: …, states: …, transitions: …}"]),
    (C + "statemachine: {states: {a: }}", ["3:1 the key 'initial' is missing"]),
    (C + "statemachine: {initial: a b}", [f"3:25 a state is a name: {NAME}"]),
    (C + "statemachine: {initial: a, states: [a]}",
     ["3:36 states: is a mapping of names to states, such as {compute: {}}"]),
    (C + "statemachine: {initial: a, states: {a: b}}",
     ["3:40 a state is a mapping, such as {initial: sense, states: {sense: {}, act: {}}}, or an empty value"]),
    (C + "statemachine: {initial: a, transitions: [a]}",
     ["3:41 transitions: is a mapping of states to their transitions, such as {initialize: compute}"]),
    (C + "statemachine: {initial: a, transitions: {a: 3}}",
     ["3:45 a transition is a state, or a mapping such as {to: finalize, event: stop}"]),
    (C + "statemachine: {initial: a, transitions: {a: [b, 3]}}",
     ["3:49 a transition is a state, or a mapping such as {to: finalize, event: stop}"]),
    (C + "statemachine: {initial: a, transitions: {a: {to: b, event: 3}}}", ["3:60 event: is a name"]),
    (C + "statemachine: {initial: a, transitions: {a: {to: b, if: [c]}}}",
     ["3:57 if: is a name, or a condition in quotes"]),
    (C + "statemachine: {initial: a, transitions: {a: {to: b, do: 3}}}",
     ["3:57 an action is the name of a method, or a mapping such as {raise: stop}"]),
    (C + "statemachine: {initial: a, transitions: {a: {to: b, do: [3]}}}",
     ["3:58 an action is the name of a method, or a mapping such as {raise: stop}"]),
    (C + "statemachine: {initial: a, transitions: {a: {do: {raise: b, cancel: c}}}}",
     ["3:50 an action is one of {raise: …}, {send: …} and {cancel: …}"]),
    (C + "statemachine: {initial: a, transitions: {a: {do: {raise: b c}}}}",
     ["3:58 an event is a name, perhaps with dots: stop, door.open"]),
    (C + "statemachine: {initial: a, transitions: {a: {do: {send: b, after: 5}}}}",
     ["3:67 after: is a time with its unit, such as 100 ms or 5 s"]),
    (C + "statemachine: {initial: a, transitions: {a: {do: {send: b, id: [c]}}}}", ["3:64 id: is a name"]),
    (C + "statemachine: {initial: a, transitions: {a: {do: {cancel: 3}}}}",
     ["3:59 cancel: is the id of a sent event"]),
    (C + "statemachine: {initial: a, transitions: {a: {to: b, internal: 1}}}", ["3:63 internal: is true or false"]),
    (C + "statemachine: {initial: a, states: {a: {parallel: 1}}}", ["3:51 parallel: is true or false"]),
    (C + "statemachine: {initial: a, states: {a: {history: flat}}}", ["3:50 history: is shallow or deep"]),
    (C + "statemachine: {initial: a, events: stop}", ["3:36 events: is a list of names, such as [stop]"]),
    (C + "uses: [a]", ["3:7 uses: is a mapping, such as {libraries: [{cmake: OpenCV}]}"]),
    (C + "uses: {sources: a.cpp}", ["3:17 sources: is a list of paths, such as [Classes/rcdraw/rcdraw.cpp]"]),
    (C + "uses: {classes: a}", ["3:17 classes: is a list of names, such as [rapplication]"]),
    (C + "uses: {libraries: {pip: a}}", ["3:19 libraries: is a list, such as [{cmake: OpenCV}, {pip: numpy}]"]),
    (C + "uses: {libraries: [numpy]}", ["3:20 a library is a mapping, such as {cmake: OpenCV} or {pip: numpy}"]),
    (C + 'uses: {libraries: [{version: "3"}]}',
     ["3:20 a library has one of the keys cmake, pkg-config, link and pip"]),
    (C + "uses: {sources: [3]}", ["3:18 a source is a relative path, such as Classes/rcdraw/rcdraw.cpp"]),
    (C + "uses: {classes: [3]}", ["3:18 a class is a name, such as rapplication"]),
    (C + "uses: {libraries: [{cmake: 3}]}", ["3:28 cmake: is the name of a package, such as OpenCV"]),
    (C + "uses: {libraries: [{pkg-config: 3}]}", ["3:33 pkg-config: is the name of a module, such as eigen3"]),
    (C + "uses: {libraries: [{link: [a]}]}", ["3:27 link: is the name of a library, such as ipp"]),
    (C + "uses: {libraries: [{pip: }]}", ["3:26 pip: is the name of a package, such as numpy"]),
    (C + "uses: {libraries: [{pip: a, version: 3}]}", ['3:38 version: is text: quote it, such as ">=4"']),
]  # fmt: skip

WORKSPACE: list[tuple[str, list[str]]] = [
    ("[]", ["1:1 rcyaml.yaml is a mapping, such as interfaces: [interfaces/], or empty"]),
    ("interface: [a]", ["1:1 Property interface is not allowed."]),
    ("interfaces: a", ["1:13 interfaces: is a list of folders, such as [interfaces/]"]),
    ("interfaces: [3]", ["1:14 a folder is a path, such as interfaces/"]),
    ("output: a", ["1:9 output: is a mapping, such as {slice: slice/}"]),
    ("output: {slice: [a]}", ["1:17 slice: is a folder, such as slice/"]),
    ("output: {runtime: [a]}", ["1:19 runtime: is a folder, such as runtime/"]),
    ("ports: 12000", ["1:8 ports: is a range of TCP ports, such as {from: 12000, to: 12999}"]),
    ("ports: {from: 1}", ["1:1 the key 'to' is missing"]),
    ("ports: {to: 1}", ["1:1 the key 'from' is missing"]),
    ("ports: {from: 1, to: 70000}", ["1:22 a port is a whole number from 1 to 65535"]),
    ("plugins: a", ["1:10 plugins: is a list of distributions, such as [rcyaml-acme]"]),
    ("plugins: [a, a]", ["1:10 plugins: is a list without duplicates"]),
    ("plugins: [a b]", ["1:11 a plug-in is the name of a distribution, such as rcyaml-acme"]),
    ("lint: [RC2003]", ["1:7 lint: is a mapping of codes to severities, such as {RC2003: warning}"]),
    ("lint: {X2003: note}", ["1:8 a code is RC and four digits, such as RC2003"]),
    ("lint: {RC2003: loud}", ["1:16 a severity is error, warning, note or off"]),
]

TABLES = {"idsl": IDSL, "cdsl": CDSL, "workspace": WORKSPACE}
ROWS = [(kind, *row) for kind, rows in TABLES.items() for row in rows]


@pytest.fixture(scope="module")
def marked(editor: Workbench) -> dict[tuple[str, str], list[str]]:
    """What the editor marks in every text of the tables."""
    return {
        (kind, text): messages
        for kind, rows in TABLES.items()
        for (text, _), messages in zip(rows, editor.messages(kind, [text + "\n" for text, _ in rows]), strict=True)
    }


@pytest.mark.parametrize(("kind", "text", "expected"), ROWS, ids=lambda value: repr(value)[:80])
def test_a_fault_has_one_message(
    marked: dict[tuple[str, str], list[str]], kind: str, text: str, expected: list[str]
) -> None:
    assert marked[kind, text] == expected


@pytest.mark.parametrize("name", sorted(path.name for path in DOCUMENTS.iterdir()))
def test_a_right_document_is_clean(editor: Workbench, name: str) -> None:
    kind = kind_of(name) or ("mock" if name.endswith(".mock.yaml") else "workspace")
    assert editor.messages(kind, [(DOCUMENTS / name).read_text(encoding="utf-8")]) == [[]]


def test_what_rcyaml_writes_is_clean(editor: Workbench, tmp_path: Path) -> None:
    """The documents of `init` and `new`, at their own places."""
    from click.testing import CliRunner

    from robocomp_yaml.cli import group

    assert CliRunner().invoke(group, ["init", str(tmp_path)]).exit_code == 0
    documents = sorted(tmp_path.rglob("*.yaml"))
    assert len(documents) == 3
    assert editor.marked((path, path.read_text(encoding="utf-8")) for path in documents) == [[], [], []]


@pytest.mark.parametrize(("kind", "text", "expected"), ROWS, ids=lambda value: repr(value)[:80])
def test_rcyaml_check_says_the_same(kind: str, text: str, expected: list[str]) -> None:
    """One fault, one message; in the same words, but where rcyaml has better ones (it knows what was meant)."""
    root, _ = tree.parse("document.yaml", text + "\n")
    assert root is not None
    [said] = schema.validate(kind, root)
    assert said.code != "RC0204" or [said.message] == [message.partition(" ")[2] for message in expected]


def test_every_message_of_the_schemas_is_here() -> None:
    """No `errorMessage` is without a row that shows it."""
    from robocomp_yaml.source.schema_text import schema_text

    said = {message.partition(" ")[2] for _, _, expected in ROWS for message in expected}
    for kind in TABLES:
        assert set(_messages(json.loads(schema_text(kind)))) - said == set()


def _messages(schema: object) -> list[str]:
    if isinstance(schema, dict):
        own = [schema["errorMessage"]] if "errorMessage" in schema else []
        return own + [message for value in schema.values() for message in _messages(value)]
    return [message for value in schema for message in _messages(value)] if isinstance(schema, list) else []
