"""What the editor shows of a key or value under the pointer: for each construct, its title, text and examples."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest

from editor.workbench import Workbench
from robocomp_yaml.source.schema_text import schema_text

IDSL = [
    ("mod|ule: A", "Module"),
    ("d|oc: x\nmodule: A", "Documentation"),
    ("module: A\nimp|orts: [B]", "Imports"),
    ("module: A\nimports: [B|]", "Import"),
    ("module: A\nx-m|ine: 1", "Extension"),
    ("module: A\ncons|tants: {c: {type: int, value: 1}}", "Constants"),
    ("module: A\nconstants: {cc|: {type: int, value: 1}}", "Constant"),
    ("module: A\nconstants: {c: {ty|pe: int, value: 1}}", "Type"),
    ("module: A\nconstants: {c: {type: in|t, value: 1}}", "Type"),
    ("module: A\nconstants: {c: {type: int, va|lue: 1}}", "Constant's value"),
    ("module: A\nconstants: {c: {type: int, value: 1, un|it: m}}", "Unit"),
    ("module: A\nty|pes: {P: {sequence: int}}", "Types"),
    ("module: A\ntypes: {Po|se: {sequence: int}}", "Type definition"),
    ("module: A\ntypes:\n  Pose|:\n    struct:\n      x: int\n", "Type definition"),
    ("module: A\ntypes: {P: {str|uct: {x: int}}}", "Members"),
    ("module: A\ntypes: {P: {struct: {xx|: int}}}", "Member"),
    ("module: A\ntypes: {P: {struct: {x: in|t}}}", "Member"),
    ("module: A\ntypes: {P: {struct: {xx|: {type: int}}}}", "Member"),
    ("module: A\ntypes: {P: {struct: {x: {type: int, def|ault: 0}}}}", "Default"),
    ("module: A\ntypes: {P: {en|um: [a]}}", "Enum"),
    ("module: A\ntypes: {P: {en|um: {a: 0}}}", "Enum"),
    ("module: A\ntypes: {P: {enum: [aa|]}}", "Enumerator's name"),
    ("module: A\ntypes: {P: {enum: {aa|: 0}}}", "Enumerator"),
    ("module: A\ntypes: {P: {enum: {aa|: }}}", "Enumerator"),
    ("module: A\ntypes: {P: {enum: {a: {va|lue: 3}}}}", "Enumerator's value"),
    ("module: A\ntypes: {P: {seq|uence: int}}", "Sequence"),
    ("module: A\ntypes: {P: {ma|p: {key: int, value: int}}}", "Map"),
    ("module: A\ntypes: {P: {map: {ke|y: int, value: int}}}", "Key"),
    ("module: A\nexc|eptions: {E: }", "Exceptions"),
    ("module: A\nexceptions: {EE|: }", "Exception"),
    ("module: A\nexceptions: {EE|: {struct: {what: string}}}", "Exception"),
    ("module: A\ninter|faces: {I: {}}", "Interfaces"),
    ("module: A\ninterfaces: {II|: {}}", "Interface"),
    ("module: A\ninterfaces: {I: {meth|ods: {}}}", "Methods"),
    ("module: A\ninterfaces: {I: {methods: {re|set: }}}", "Method"),
    ("module: A\ninterfaces: {I: {methods: {re|set: {returns: int}}}}", "Method"),
    ("module: A\ninterfaces: {I: {methods: {f: {in|: {a: int}}}}}", "Inputs"),
    ("module: A\ninterfaces: {I: {methods: {f: {in: {aa|: int}}}}}", "Parameter"),
    ("module: A\ninterfaces: {I: {methods: {f: {ou|t: {a: int}}}}}", "Outputs"),
    ("module: A\ninterfaces: {I: {methods: {f: {ret|urns: int}}}}", "Result"),
    ("module: A\ninterfaces: {I: {methods: {f: {thr|ows: [E]}}}}", "Throws"),
    ("module: A\ninterfaces: {I: {methods: {f: {throws: [EE|]}}}}", "Exception's name"),
    ("module: A\ninterfaces: {I: {methods: {f: {idem|potent: true}}}}", "Idempotent"),
    ("module: A\ntop|ics: {T: {}}", "Topics"),
    ("module: A\ntopics: {TT|: {}}", "Topic"),
    ("module: A\ntopics: {T: {meth|ods: {}}}", "Methods of a topic"),
    ("module: A\ntopics: {T: {methods: {ff|: {in: {a: int}}}}}", "Method of a topic"),
]

C = "component: A\nlanguage: cpp\n"
M = C + "statemachine:\n  "
CDSL = [
    ("comp|onent: A", "Component"),
    ("component: A\nd|oc: x", "Documentation"),
    ("component: A\nlang|uage: cpp", "Language"),
    ("component: A\nlang|uage: {name: cpp}", "Language"),
    ("component: A\nlanguage: {na|me: cpp}", "Language's name"),
    ("component: A\nlanguage: {name: cpp, stan|dard: 20}", "Standard"),
    (C + "x-m|ine: 1", "Extension"),
    (C + "imp|orts: [A]", "Imports"),
    (C + "imports: [AA|]", "Import"),
    (C + "imple|ments: [A]", "Implements"),
    (C + "implements: [AA|]", "Port"),
    (C + "implements: [{A|: B}]", "Port's interface"),
    (C + "req|uires: [A]", "Requires"),
    (C + "requires: [AA|]", "Proxy"),
    (C + "requires:\n  - AA|\n", "Proxy"),
    (C + "requires: [{AA|: B}]", "Proxy's interface"),
    (C + "requires: [{AA|: {interface: B}}]", "Proxy's interface"),
    (C + "requires: [{A: {inter|face: B}}]", "Interface"),
    (C + "requires: [{A: {abs|ent: wait}}]", "Absent"),
    (C + "requires: [{A: {time|out: 3 s}}]", "Timeout"),
    (C + "pub|lishes: [A]", "Publishes"),
    (C + "sub|scribes: [A]", "Subscribes"),
    (C + "para|meters: a.pdsl.yaml", "Parameters"),
    (C + "per|iod: 100", "Period"),
    (C + "period: 10|0 ms", "Period"),
    (C + "opt|ions: [dsr]", "Options"),
    (C + "options: [ds|r]", "Option"),
    (C + "compat|ibility: robocomp", "Compatibility"),
    (C + "gu|i: {toolkit: qt}", "Graphical interface"),
    (C + "gui: {tool|kit: qt}", "Toolkit"),
    (C + "gui: {toolkit: qt, ba|se: QWidget}", "Base class"),
    (C + "state|machine: a.scxml", "State machine"),
    (C + "state|machine: {initial: a}", "State machine"),
    (M + "ini|tial: a", "Initial state"),
    (M + "fin|al: a", "Final state"),
    (M + "sta|tes: {a: }", "States"),
    (M + "states: {aa|: }", "State"),
    (M + "states: {aa|: {states: {b: {}}}}", "State"),
    (M + "trans|itions: {a: b}", "Transitions"),
    (M + "transitions: {aa|: b}", "Transitions of a state"),
    (M + "transitions: {aa|: [b, c]}", "Transitions of a state"),
    (M + "transitions: {a: [b|]}", "Transition"),
    (M + "transitions: {a: {t|o: b}}", "Target"),
    (M + "transitions: {a: {to: b, eve|nt: e}}", "Event"),
    (M + "transitions: {a: {to: b, i|f: e}}", "Condition"),
    (M + "transitions: {a: {to: [b|, c]}}", "One of several targets"),
    (M + "transitions: {a: {to: b, d|o: e}}", "Actions"),
    (M + "transitions: {a: {to: b, d|o: [e]}}", "Actions"),
    (M + "transitions: {a: {to: b, do: [e|]}}", "Action"),
    (M + "transitions: {a: {to: b, do: [{ra|ise: e}]}}", "Raised event"),
    (M + "transitions: {a: {to: b, do: {se|nd: e}}}", "Sent event"),
    (M + "transitions: {a: {to: b, do: {send: e, af|ter: 1 s}}}", "After"),
    (M + "transitions: {a: {to: b, do: {send: e, i|d: f}}}", "Id of a sent event"),
    (M + "transitions: {a: {to: b, do: {can|cel: e}}}", "Cancelled event"),
    (M + "transitions: {a: {to: b, inter|nal: true}}", "Internal"),
    (M + "states: {a: {en|try: b}}", "Actions"),
    (M + "states: {a: {ex|it: b}}", "Actions"),
    (M + "states: {a: {para|llel: true}}", "Parallel"),
    (M + "states: {a: {his|tory: deep}}", "History"),
    (M + "ev|ents: [a]", "Events"),
    (M + "events: [aa|]", "Fired event"),
    (C + "use|s: {classes: [a]}", "Uses"),
    (C + "uses: {sour|ces: [a]}", "Sources"),
    (C + "uses: {sources: [aa|]}", "Source"),
    (C + "uses: {cla|sses: [a]}", "Classes"),
    (C + "uses: {classes: [aa|]}", "Class folder"),
    (C + "uses: {libr|aries: [{pip: a}]}", "Libraries"),
    (C + "uses: {libraries: [{cm|ake: a}]}", "CMake package"),
    (C + "uses: {libraries: [{pkg-con|fig: a}]}", "pkg-config module"),
    (C + "uses: {libraries: [{li|nk: a}]}", "Library to link"),
    (C + "uses: {libraries: [{pi|p: a}]}", "Python package"),
    (C + 'uses: {libraries: [{pip: a, ver|sion: "3"}]}', "Version"),
]

WORKSPACE = [
    ("do|c: x", "Documentation"),
    ("x-m|ine: 1", "Extension"),
    ("inter|faces: [a]", "Interfaces"),
    ("interfaces: [aa|]", "Folder"),
    ("out|put: {slice: a}", "Output"),
    ("output: {sl|ice: a}", "Slice folder"),
    ("output: {run|time: a}", "Run time folder"),
    ("plug|ins: [a]", "Plug-ins"),
    ("plugins: [aa|]", "Plug-in"),
    ("po|rts: {from: 1, to: 2}", "Port range"),
    ("ports: {fr|om: 1, to: 2}", "First port"),
    ("ports: {from: 1, t|o: 2}", "Last port"),
    ("li|nt: {RC2003: note}", "Lint"),
    ("lint: {RC2|003: note}", "Severity"),
]

ROWS = [(kind, *row) for kind, rows in (("idsl", IDSL), ("cdsl", CDSL), ("workspace", WORKSPACE)) for row in rows]
NO_KEY_OF_THEIR_OWN = {"IDSL document", "CDSL document", "Workspace", "Library"}


def constructs(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        if isinstance(schema.get("title"), str):
            yield schema
        for value in schema.values():
            yield from constructs(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from constructs(value)


@pytest.fixture(scope="module")
def texts() -> dict[tuple[str, str], set[str]]:
    """The Markdown of each construct, by kind and title."""
    found: dict[tuple[str, str], set[str]] = {}
    for kind in ("idsl", "cdsl", "workspace"):
        for construct in constructs(json.loads(schema_text(kind))):
            found.setdefault((kind, construct["title"]), set()).add(construct["markdownDescription"])
    return found


@pytest.mark.parametrize(("kind", "text", "title"), ROWS, ids=lambda value: repr(value))
def test_the_construct_explains_itself(
    editor: Workbench, texts: dict[tuple[str, str], set[str]], kind: str, text: str, title: str
) -> None:
    shown = editor.hover(kind, text)
    [expected] = texts[kind, title]
    assert shown.startswith(f"#### {title}\n\n{expected}\n"), shown
    assert shown.count(expected) == 1
    assert shown.endswith(f"{kind}.schema.json)")


def test_examples_are_shown(editor: Workbench) -> None:
    assert "Example:\n\n```yaml\n100 ms\n```" in editor.hover("cdsl", C + "per|iod: 3")
    assert "Example:\n\n```yaml\nkey: string\nvalue: float\n```" in editor.hover(
        "idsl", "module: A\ntypes: {P: {ma|p: {key: int, value: int}}}"
    )
    assert "* `ignore`: Start without it." in editor.hover("cdsl", C + "requires: [{A: {abs|ent: wait}}]")


def test_every_construct_is_here(texts: dict[tuple[str, str], set[str]]) -> None:
    assert {(kind, title) for kind, title in texts if title not in NO_KEY_OF_THEIR_OWN} == {
        (kind, title) for kind, _, title in ROWS
    }
