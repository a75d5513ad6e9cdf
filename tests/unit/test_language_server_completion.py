"""What completion offers at each place: names that fit there, also while a bracket is not closed."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from in_memory import ROOT, analysed
from robocomp_yaml.api.completing.places import typed_at
from robocomp_yaml.api.completing.proposals import codes_at, proposals
from robocomp_yaml.naming.analysis import names_of

WORKSPACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Pose.idsl.yaml": "module: RoboCompPose\ntypes: {Pose: {struct: {x: float}}}\nexceptions: {Lost: {struct: {x: int}}}\n",
    "interfaces/Arm.idsl.yaml": (
        "module: RoboCompArm\nimports: [Pose]\ninterfaces: {Arm: {methods: {stop: }}}\ntopics: {Moved: {methods: {moved2: }}}\n"
    ),
    "interfaces/Eye.idsl.yaml": "module: RoboCompEye\ninterfaces: {Eye: {methods: {look: }}}\ntopics: {Seen: {methods: {saw: }}}\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters:\n  speed: {type: int, default: 1}\n  camera: {group: {width: {type: int, default: 1}}}\n",
    "eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: python\nimports: [Eye]\nimplements: [Eye]\n",
}  # fmt: skip
IMPORTABLE = ["Arm", "Eye", "Pose"]
ANALYSIS = analysed(WORKSPACE)
NAMES = names_of(ANALYSIS)

IDSL = "module: RoboCompLeg\nimports: [Pose]\ntypes: {Own: {enum: [a]}}\n"
CDSL = "component: C\nlanguage: python\nimports: [Arm]\n"
DDSL = "deployment: D\nhosts: {left: 10.0.0.2, right: 10.0.0.3}\ncomponents:\n  one: {component: arm}\n"
ROWS = [
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports: [|]\n", ["Arm", "Eye", "Pose"]),
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports: [Pose, E|]\n", ["Arm", "Eye"]),
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports: [Pose, |", ["Arm", "Eye"]),
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports:\n  - Pose\n  - |\n", ["Arm", "Eye"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces: {{I: {{methods: {{m: {{in: {{a: |}}}}}}}}}}\n", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces: {{I: {{methods: {{m: {{in: {{a: Po|", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces:\n  I:\n    methods:\n      m: {{returns: |\n      n:\n", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces: {{I: {{methods: {{m: {{throws: [|]}}}}}}}}\n", ["Pose.Lost"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}exceptions: {{E: {{struct: {{x: |}}}}}}\n", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}topics: {{|}}\n", []),
    ("leg/leg.cdsl.yaml", "component: C\nlanguage: python\nimports: [|]\n", ["Arm", "Eye", "Pose"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}implements: [|]\n", ["Arm", "Eye +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}requires: [{{Left: A|}}]\n", ["Arm", "Eye +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}requires: [{{Left: {{interface: |}}}}]\n", ["Arm", "Eye +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}requires: [{{Left: {{absent: |}}}}]\n", []),
    ("leg/leg.cdsl.yaml", f"{CDSL}publishes:\n  - |\nperiod: 5\n", ["Moved", "Seen +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}subscribes: [M|", ["Moved", "Seen +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}language: |\n", []),
    ("leg/leg.cdsl.yaml", f"{CDSL}# implements: [|\n", []),
    ("leg/leg.pdsl.yaml", "types: {Joint: {struct: {n: string}}}\nparameters: {a: {type: |}}\n", ["Joint"]),
    ("leg/leg.pdsl.yaml", "types: {Joint: {struct: {n: string}}}\nparameters:\n  a: {list: J|\n  b: {type: int}\n", ["Joint"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: |}}\n", ["arm", "eye"]),
    ("lab/robot.ddsl.yaml", f"{DDSL}  two: {{component: ../a|\n", ["../arm", "../eye"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, host: |}}\n", ["left", "right"]),
    ("robot.ddsl.yaml", f"{DDSL}services: {{storm: {{icestorm: {{host: |}}}}}}\n", ["left", "right"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, connect: {{Arm: |}}}}\n", ["one"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, after: [|]}}\nservices: {{storm: {{icestorm: }}}}\n", ["one", "storm"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye}}\ngroups: {{g: {{components: [one, |]}}}}\n", ["two"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{|}}}}\n", ["speed", "camera", "period"]),
    ("robot.ddsl.yaml", f"{DDSL}  two:\n    component: arm\n    set:\n      sp|\n", ["speed", "camera", "period"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: |}}\n", []),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm/arm.cdsl.yaml, set: {{camera: {{w|: 3}}}}}}\n", ["width"]),
    ("robot.ddsl.yaml", "deployment: |\n", []),
]  # fmt: skip


@pytest.mark.parametrize(("file", "marked", "expected"), ROWS)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_what_is_offered(file: str, marked: str, expected: list[str], end: str) -> None:
    before, _, behind = marked.replace("\n", end).partition("|")
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    place = typed_at(before + behind, line, column)
    found = proposals(f"{ROOT}/{file}", place, NAMES, IMPORTABLE, ANALYSIS.program) if place is not None else []
    assert sorted(f"{one.text} +{one.imports}" if one.imports else one.text for one in found) == sorted(expected)


@pytest.mark.parametrize(
    ("typed", "columns", "expected"),
    [
        ("  - speed < |", (13, 13), {"speed", "camera", "camera.width", "len"}),
        ("  - sp| < 3", (5, 7), {"speed", "camera", "camera.width", "all"}),
        ("  - {that: speed-ca|, else: no}", (18, 20), {"speed", "camera.width"}),
        ("  - sp|eed/2-1 < 3", (5, 10), {"speed"}),
        ('  - {that: "speed < 3 and camera.w|", else: no}', (27, 35), {"camera.width"}),
        ("  - that: all(j.|", (15, 17), {"j.n"}),
        ("  - that: all(j.| for j in joints)", (15, 17), {"j.n"}),
        ("  - that: all(j.| for j in arms[0].joints)", (15, 17), {"j.n"}),
        ("  - that: all(| for j in joints)", (15, 15), {"j", "joints", "view2d", "arms"}),
        ("  - arms[1].|", (5, 13), {"arms[1].joints"}), ("  - camera.|", (5, 12), {"camera.width"}), ("  - vi|", (5, 7), {"view2d"}),
    ],
)  # fmt: skip
def test_in_constraints(typed: str, columns: tuple[int, int], expected: set[str]) -> None:
    """The word alone is replaced; what begins otherwise is filtered by the editor."""
    files = WORKSPACE | {
        "arm/arm.pdsl.yaml": (
            f"types: {{Joint: {{struct: {{n: int}}}}, Arm: {{struct: {{joints: {{list: Joint}}}}}}}}\n{WORKSPACE['arm/arm.pdsl.yaml']}"
            "  joints: {list: Joint}\n  arms: {list: Arm}\n  2d: {type: bool, default: true, as: view2d}\nconstraints: [speed < 9]\n"
        )
    }
    analysis = analysed(files)
    before, _, behind = typed.partition("|")
    place = typed_at(f"{WORKSPACE['arm/arm.pdsl.yaml']}constraints:\n{before}{behind}\n", 6, len(before) + 1)
    assert place is not None and (place.column, place.end_column) == columns
    found = {
        one.text for one in proposals(f"{ROOT}/arm/arm.pdsl.yaml", place, names_of(analysis), [], analysis.program)
    }
    assert expected <= found and "2d" not in found
    if ".|" in typed and typed != "  - that: all(j.|":
        assert found == expected


def test_modules_that_no_folder_of_the_search_path_has() -> None:
    place = typed_at("component: C\nlanguage: python\nimports: [../interfaces/Arm, ]\n", 3, 30)
    assert place is not None
    found = [one.text for one in proposals(f"{ROOT}/leg/leg.cdsl.yaml", place, NAMES, ["Pose"], ANALYSIS.program)]
    assert found == ["Pose", "../interfaces/Eye"]


def test_the_word_at_the_cursor_is_replaced() -> None:
    place = typed_at("module: RoboCompA\ntypes: {P: {sequence: Pose.Po}}\n", 2, 26)
    assert place is not None and place.keys == ("types", "P", "sequence")
    assert (place.line, place.column, place.end_column) == (2, 23, 30)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("more", ["", "\n", "\nz: {y: x}\n"])
@pytest.mark.parametrize(
    ("marked", "keys"),
    [
        ("a: {b: 1,\n  c: d|", ("a", "c")),
        ("a: [b, c,\n  d|", ("a", "")),
        ("a:\n  - {b: 1, # {[\n     c: |", ("a", "", "c")),
        ("a: {\n  b: 'it''s {',\n\n  c: [\n    d, |", ("a", "c", "")),
        ('a: see [1\nb: {c: "x\n  y", d: e|', ("b", "d")),
    ],
)
def test_brackets_that_were_opened_lines_above_need_not_be_closed(
    marked: str, keys: tuple[str, ...], more: str, end: str
) -> None:
    before = marked.removesuffix("|").replace("\n", end)
    place = typed_at(before + more.replace("\n", end), before.count("\n") + 1, len(before) - before.rfind("\n"))
    assert place is not None and place.keys == keys


@pytest.mark.parametrize("text", ["", "a: [b: {", "\x00", "x: |\n  text", "- a\n- b"])
def test_odd_texts_have_no_place_or_one(text: str) -> None:
    for column in range(1, 12):
        for line in (1, 2, 9):
            typed_at(text, line, column)


WITH_VALUES = {
    **WORKSPACE,
    "arm/arm.cdsl.yaml": (
        "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\nrequires: [{Left: Arm}]\npublishes: [Moved]\n"
    ),
    "arm/arm.pdsl.yaml": (
        "component: arm.cdsl.yaml\ntypes:\n  Mode: {enum: {slow: {doc: by night}, fast: }}\n  Wheel: {struct: {size: {type: int, values: [3, 5]}}}\n"
        "parameters:\n  mode: {type: Mode, default: slow}\n  is_on: bool\n  speed: {type: float, range: [0, 2], unit: m/s}\n"
        "  wheels: {list: Wheel}\n  token: {type: string, secret: true}\n  camera: {group: {width: {type: int, default: 640}}}\n"
    ),
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {}\n",
    "robot.ddsl.yaml": f"{DDSL}",
}  # fmt: skip
PROGRAM = analysed(WITH_VALUES).program
MACHINE = "component: C\nlanguage: python\nstatemachine:\n  initial: idle\n  events: [go]\n  states: {busy: }\n"
OF_VALUES = [
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{mode: |}}}}\n", ["slow", "fast"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{is_on: |}}}}\n", ["true", "false"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{speed: |}}}}\n", ["0", "2"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{camera: {{width: |}}}}}}\n", ["640"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{camera.width: |}}}}\n", ["640"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{'wheels[0].size': |}}}}\n", ["3", "5"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{token: |}}}}\n", []),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, connect: {{|}}}}\n", ["Left"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, ports: {{|}}}}\n", ["Arm"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, topics: {{Moved: |}}}}\n", ["Moved"]),
    ("robot.ddsl.yaml", f"{DDSL}groups: {{g: {{components: [one], expose: {{Arm: |}}}}}}\n", ["one"]),
    ("robot.ddsl.yaml", f"{DDSL}groups: {{g: {{expose: {{Arm: {{member: one, allow: [|]}}}}}}}}\n", ["stop"]),
    ("arm/etc/config.yaml", "component: ../arm.cdsl.yaml\nparameters: {mode: |}\n", []),  # its schema has them
    ("arm/etc/config.yaml", "component: |\n", ["../../eye/eye.cdsl.yaml", "../arm.cdsl.yaml"]),
    ("leg/leg.cdsl.yaml", f"{MACHINE}  transitions: {{idle: |}}\n", ["busy", "idle"]),
    ("leg/leg.cdsl.yaml", f"{MACHINE}  transitions: {{idle: [{{to: |}}]}}\n", ["busy", "idle"]),
    ("leg/leg.cdsl.yaml", f"{MACHINE}  transitions:\n    |\n", ["busy", "idle"]),
    ("leg/leg.cdsl.yaml", f"{MACHINE}  transitions: {{idle: {{to: busy, event: |}}}}\n", ["go"]),
    ("leg/leg.cdsl.yaml", f"{MACHINE}  final: |\n", ["busy", "idle"]),
]  # fmt: skip


def offered(file: str, marked: str, *, with_schema: bool = False) -> list[str]:
    before, _, behind = marked.partition("|")
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    place = typed_at(before + behind, line, column)
    assert place is not None
    found = proposals(f"{ROOT}/{file}", place, NAMES, IMPORTABLE, PROGRAM, with_schema=with_schema)
    return [one.text for one in found]


@pytest.mark.parametrize(("file", "marked", "expected"), OF_VALUES)
def test_values_states_and_ports_are_offered(file: str, marked: str, expected: list[str]) -> None:
    assert offered(file, marked) == expected


def test_names_are_offered_once_and_a_list_with_its_brackets() -> None:
    arm = "component: C\nlanguage: python\nimports: [Arm, Eye]\n"
    assert offered("leg/leg.cdsl.yaml", f"{arm}implements: [Arm, |]\n") == ["Eye"]
    assert offered("leg/leg.cdsl.yaml", f"{arm}implements:\n  - Arm\n  - |\n") == ["Eye"]
    for place in ("implements: |", "implements: A|"):
        assert sorted(inserted("leg/leg.cdsl.yaml", f"{arm}{place}\n")) == ["[Arm]", "[Eye]"]
    assert sorted(inserted("leg/leg.cdsl.yaml", f"{arm}implements: [|\n")) == ["Arm", "Eye"]
    assert inserted("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, host: |}}\n") == ["left", "right"]
    assert inserted("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, after: |}}\n") == ["[one]"]


@pytest.mark.parametrize(
    ("marked", "expected", "replaced"),
    [
        ("mode: '|'", ["slow", "fast"], ""), ('mode: "sl|', ["slow", "fast"], "sl"), ("mode: a b|", ["slow", "fast"], "a b"),
        ("mode: 'a |c'", ["slow", "fast"], "a c"), ("wheels: [{|}]", ["size: "], ""), ("wheels:\n  - |", ["size: "], ""),
        ("wheels:\n  - si|", ["size: "], "si"), ("wheels: [{size: |", ["3", "5"], ""), ("camera.|", ["camera.width: "], "camera."),
        ("'wheels[0].|'", ["wheels[0].size"], "wheels[0]."), ("{\"wheels[1].s|", ["wheels[1].size"], "wheels[1].s"),
        ("wheels[0].|: 3", ["wheels[0].size"], "wheels[0]."), ("wheels[0].si|", ["wheels[0].size: "], "wheels[0].si"),
        ("mo|de: slow", ["mode", "is_on", "speed", "wheels", "token", "camera", "period"], "mode"), ("mode:|", [], ""),
    ],
)  # fmt: skip
def test_half_typed_values_and_keys(marked: str, expected: list[str], replaced: str) -> None:
    """In quotes, also open ones, in texts with blanks, in records of lists, behind dots, and in keys that are there."""
    below = marked.replace("\n", "\n      ")
    for file, text in (
        ("robot.ddsl.yaml", f"{DDSL}  two:\n    component: arm\n    set:\n      {below}\n"),
        ("arm/etc/config.yaml", f"component: ../arm.cdsl.yaml\nparameters:\n      {below}\n"),
    ):
        before, _, behind = text.partition("|")
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        place = typed_at(before + behind, line, column)
        found = inserted(file, text, with_schema=True)
        assert found[: len(expected)] == expected, file
        if expected:
            assert place is not None
            assert (before + behind).split("\n")[line - 1][place.column - 1 : place.end_column - 1] == replaced


def inserted(file: str, marked: str, *, with_schema: bool = False) -> list[str]:
    before, _, behind = marked.partition("|")
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    place = typed_at(before + behind, line, column)
    found = proposals(f"{ROOT}/{file}", place, NAMES, IMPORTABLE, PROGRAM, with_schema=with_schema) if place else []
    return [one.snippet or one.text for one in found]


def test_only_what_can_serve_is_offered_to_connect_to() -> None:
    """`arm` requires Left, which is an Arm. Of what is unknown, nobody can say it."""
    more = (
        "  eye: {component: eye}\n  sh: {program: sh}\n  old: {program: sh, endpoints: {Arm: tcp -p 5}}\n  gone: {component: gone}\n"
        "groups: {g: {components: [one]}}\n"
    )
    place = f"{DDSL}  two: {{component: arm, connect: {{Left: |}}}}\n{more}"
    assert offered("robot.ddsl.yaml", place) == ["one", "old", "gone", "g"]
    place = f"{DDSL}  two: {{program: sh, connect: {{Left: |}}}}\n{more}"
    assert offered("robot.ddsl.yaml", place) == ["one", "eye", "old", "gone", "g"]


def test_values_in_quotes_keep_these() -> None:
    pdsl = "parameters: {a: {type: string, values: ['1', \"it's\", b c], default: %s}}\n"
    assert inserted("leg/leg.pdsl.yaml", pdsl % "|") == ['"1"', '"it\'s"', "b c"]
    assert inserted("leg/leg.pdsl.yaml", pdsl % '"|"') == ["1", "it's", "b c"]
    assert inserted("leg/leg.pdsl.yaml", pdsl % "'|'") == ["1", "it''s", "b c"]


def test_paths_of_documents_are_offered() -> None:
    assert offered("leg/leg.cdsl.yaml", "component: C\nparameters: |\n") == ["../arm/arm.pdsl.yaml"]
    assert offered("arm/etc/more.config.yaml", "extends: [|]\n") == ["config.yaml"]
    assert offered("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, config: |}}\n") == ["etc/config.yaml"]
    for text in ("include: [|]", "include: {left: |}", "groups: {g: {include: |}}"):
        assert offered("lab/lab.ddsl.yaml", f"deployment: D\n{text}\n") == ["../robot.ddsl.yaml"]
        assert offered("robot.ddsl.yaml", f"deployment: D\n{text}\n") == []


def test_mock_scripts_settings_and_ports_of_values() -> None:
    assert set(offered("a.mock.yaml", "interfaces: {|}\n")) == {"Arm", "Eye"}
    assert offered("a.mock.yaml", "interfaces:\n  Arm:\n    methods:\n      |\n") == ["stop"]
    assert offered("a.mock.yaml", "topics: {Moved: {messages: [|]}}\n") == ["moved2"]
    assert {"interfaces: ", "topics: "} <= set(offered("a.mock.yaml", "|\n", with_schema=True))
    assert {"interfaces: ", "lint: "} <= set(offered("rcyaml.yaml", "|\n", with_schema=True))
    assert "RC2003" in offered("rcyaml.yaml", "lint: {|}\n", with_schema=True)
    values = "component: ../arm.cdsl.yaml\n"
    assert offered("arm/etc/config.yaml", f"{values}proxies: {{|}}\n", with_schema=True)[0] == "Left"
    assert offered("arm/etc/config.yaml", f"{values}endpoints: {{|}}\n", with_schema=True)[:2] == [
        "Arm",
        "CommonBehavior",
    ]
    assert offered("arm/etc/config.yaml", f"{values}topics: {{name: {{|}}}}\n", with_schema=True)[0] == "Moved"


def test_defaults_are_those_of_the_type() -> None:
    own = "module: M\nimports: [Pose]\ntypes:\n  E: {enum: [a, b]}\n  P: {struct: {e: {type: %s, default: |}}}\n"
    assert offered("interfaces/Leg.idsl.yaml", own % "E") == ["a", "b"]
    assert offered("interfaces/Leg.idsl.yaml", own % "bool") == ["true", "false"]
    assert offered("interfaces/Leg.idsl.yaml", own % "Pose.Pose") == []
    assert "E" in offered(
        "interfaces/Leg.idsl.yaml", "module: M\ntypes: {E: {enum: [a]}, T: {map: {key: int, value: |}}}\n"
    )


def test_without_a_server_of_schemas_keys_and_values_of_the_schema_are_offered_too() -> None:
    values = "component: ../arm.cdsl.yaml\nparameters: {|}\n"
    assert set(offered("arm/etc/config.yaml", values, with_schema=True)) >= {"mode", "is_on", "speed", "camera"}
    assert offered("arm/etc/config.yaml", values) == []
    mode = "component: ../arm.cdsl.yaml\nparameters: {mode: |}\n"
    assert offered("arm/etc/config.yaml", mode, with_schema=True)[:2] == ["slow", "fast"]
    keys = offered("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, |}}\n", with_schema=True)
    assert {"host: ", "connect: ", "set: "} <= set(keys) and "component: " not in keys
    assert {"python", "cpp"} <= set(offered("leg/leg.cdsl.yaml", "component: C\nlanguage: |\n", with_schema=True))
    top = offered("leg/leg.cdsl.yaml", "component: C\n|\n", with_schema=True)
    assert {"implements: ", "imports: "} <= set(top)


def test_codes_are_offered_behind_allow() -> None:
    found = analysed({"a.idsl.yaml": "module: M\nimports: [Nothing]\n"}, "a.idsl.yaml").diagnostics
    line = "imports: [Nothing]  # rcyaml: allow RC"
    column, codes = codes_at(line, len(line) + 1, found, 2) or (0, [])
    assert line[column - 1 :] == "RC" and codes[0].text == found[0].code and codes[0].doc == "reported here"
    assert len(codes) > 200 and len({one.text for one in codes}) == len(codes)
    assert codes_at("# rcyaml: allow RC1010, ", 25, (), 1) is not None
    assert codes_at("# allow RC", 11, (), 1) is None and codes_at("a: # rcyaml: guessed x", 23, (), 1) is None
    start, verbs = codes_at("a: 1  # rcyaml: al", 19, (), 1) or (0, [])
    assert (start, [one.text for one in verbs]) == (17, ["allow"])
