"""Documents that IDSL allows but the Slice compilers reject: rcyaml rejects them first, with a location in the document.

The names are those of the tests of Ice's own error detection, where there is one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pytest

TYPES = "module: RoboCompMap\ntypes:\n"
SIDE = TYPES + "  Side: {enum: [left, right]}\n"
METHODS = (
    "module: RoboCompMap\nexceptions: {Busy: {}}\ntypes: {Pose: {struct: {x: float}}}\n"
    "interfaces:\n  Map:\n    methods:\n"
)


@dataclass(frozen=True)
class Fault:
    name: str
    code: str
    place: str
    says: str
    text: str


FAULTS = [
    Fault("IdentAsKeyword", "RC1001", "1:9", "no module can be called 'module'", "module: module\n"),
    Fault("IdentAsKeyword constant", "RC1001", "2:13", "Const",
          "module: M\nconstants: {const: {type: int, value: 1}}\n"),
    Fault("IdentAsKeyword type", "RC1001", "3:3", "'object' is allowed", TYPES + "  Object: {struct: {x: int}}\n"),
    Fault("IdentAsKeyword enumerator", "RC1001", "3:17", "no enumerator", TYPES + "  E: {enum: [a, out]}\n"),
    Fault("IdentAsKeyword method", "RC1001", "7:7", "no method", METHODS + "      optional:\n"),
    Fault("IdentAsKeyword parameter", "RC1001", "7:16", "no parameter", METHODS + "      f: {in: {local: int}}\n"),
    Fault("Reserved prefix", "RC1002", "3:3", "start with 'ice'", TYPES + "  iceberg: {sequence: int}\n"),
    Fault("Reserved suffix", "RC1002", "3:16", "end in 'Ptr'", TYPES + "  A: {struct: {anyPtr: int}}\n"),
    Fault("IllegalIdentifier", "RC1002", "3:16", "write 'a_b'", TYPES + "  A: {struct: {a__b: int}}\n"),
    Fault("IllegalIdentifier digit", "RC1002", "3:16", "choose another name", TYPES + "  A: {struct: {_1: int}}\n"),
    Fault("a name cut by the preprocessor", "RC1002", "3:16", "at most 200",
          TYPES + f"  A: {{struct: {{{'x' * 201}: int}}}}\n"),
    Fault("Python word", "RC1006", "3:16", "Python", TYPES + "  A: {struct: {with: int}}\n"),
    Fault("Python word of methods", "RC1006", "7:7", "Python", METHODS + "      staticmethod:\n"),
    Fault("RedefinitionAs", "RC1003", "4:10", "two definitions called 'A'",
          TYPES + "  A: {sequence: int}\ntopics: {A: {}}\n"),
    Fault("RedefinitionAs constant", "RC1003", "4:13", "module RoboCompMap",
          TYPES + "  A: {sequence: int}\nconstants: {A: {type: int, value: 1}}\n"),
    Fault("EnumeratorDuplication", "RC1003", "3:20", "enum E has two enumerators", TYPES + "  E: {enum: [a, b, a]}\n"),
    Fault("DuplicateParameter", "RC1003", "7:31", "two parameters",
          METHODS + "      f: {in: {a: int}, out: {a: int}}\n"),
    Fault("CaseInsensitive", "RC1004", "4:3", "'A' and 'a'", TYPES + "  A: {sequence: int}\n  a: {sequence: int}\n"),
    Fault("CaseInsensitive member", "RC1004", "3:24", "struct S", TYPES + "  S: {struct: {a: int, A: int}}\n"),
    Fault("OperationRedefinition", "RC1004", "8:7", "methods 'go' and 'Go'", METHODS + "      go:\n      Go:\n"),
    Fault("NameCanNotBeUsed", "RC1005", "7:7", "the method 'Map'", METHODS + "      Map:\n"),
    Fault("name of the module", "RC1005", "3:3", "the sequence 'RobocompMap'",
          TYPES + "  RobocompMap: {sequence: int}\n"),
    Fault("Undefined", "RC1010", "3:17", "unknown type 'Pose'", TYPES + "  A: {sequence: Pose}\n"),
    Fault("Undefined case", "RC1010", "3:17", "did you mean 'B'", TYPES + "  A: {sequence: b}\n  B: {sequence: int}\n"),
    Fault("Undefined foreign", "RC1010", "3:17", "did you mean 'float'", TYPES + "  A: {sequence: float32}\n"),
    Fault("Undefined void", "RC1010", "7:20", "returns nothing has no `returns`",
          METHODS + "      f: {returns: void}\n"),
    Fault("Undefined exception", "RC1011", "7:20", "did you mean 'Busy'", METHODS + "      f: {throws: [Bussy]}\n"),
    Fault("NotType", "RC1012", "7:19", "exception", METHODS + "      f: {in: {a: Busy}}\n"),
    Fault("WarningInterfaceByValue", "RC1012", "7:20", "interface", METHODS + "      f: {returns: Map}\n"),
    Fault("NotException", "RC1013", "7:20", "struct", METHODS + "      f: {throws: [Pose]}\n"),
    Fault("NotException basic", "RC1011", "7:20", "'string'", METHODS + "      f: {throws: [string]}\n"),
    Fault("DuplicateThrows", "RC1014", "7:26", "throws 'Map.Busy' twice",
          METHODS + "      f: {throws: [Busy, Map.Busy]}\n"),
    Fault("SelfContainment", "RC1015", "3:16", "A → A", TYPES + "  A: {struct: {a: A}}\n"),
    Fault("SelfContainment far", "RC1015", "3:30", "C → A → B → C",
          TYPES + "  C: {map: {key: int, value: A}}\n  A: {struct: {b: B}}\n  B: {sequence: C}\n"),
    Fault("IllegalDictionary", "RC1016", "3:18", "a double cannot", TYPES + "  A: {map: {key: double, value: int}}\n"),
    Fault("IllegalDictionary deep", "RC1016", "5:18", "a float cannot",
          TYPES + "  S: {struct: {t: T}}\n  T: {struct: {x: float}}\n  A: {map: {key: S, value: int}}\n"),
    Fault("IllegalDictionary map", "RC1016", "4:18", "a map cannot",
          TYPES + "  A: {map: {key: int, value: int}}\n  B: {map: {key: A, value: int}}\n"),
    Fault("EnumEmpty", "RC1018", "3:7", "no enumerators", TYPES + "  E: {enum: []}\n"),
    Fault("StructMembers", "RC1018", "3:7", "no members", TYPES + "  S: {struct: {}}\n"),
    Fault("EnumeratorValues", "RC1019", "3:26", "'a' and 'c'", TYPES + "  E: {enum: {a: 1, b: 0, c: }}\n"),
    Fault("EnumeratorValues overflow", "RC1020", "3:29", "2147483648", TYPES + "  E: {enum: {a: 2147483647, b: }}\n"),
    Fault("ConstDef type", "RC1021", "4:23", "'Q'",
          TYPES + "  Q: {sequence: int}\nconstants: {c: {type: Q, value: 1}}\n"),
    Fault("default of a struct", "RC1022", "4:38", "'Q'",
          TYPES + "  Q: {sequence: int}\n  S: {struct: {q: {type: Q, default: 1}}}\n"),
    Fault("ConstDef enumerator", "RC1023", "4:38", "did you mean 'left'",
          TYPES + "  E: {enum: [left]}\n  S: {struct: {e: {type: E, default: lift}}}\n"),
]  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_is_reported_once_at_its_location(fault: Fault, diagnostics: Callable[..., list[dict]]) -> None:
    said = diagnostics({"Map.idsl.yaml": fault.text})
    assert [(d["code"], f"{d['line']}:{d['column']}") for d in said] == [(fault.code, fault.place)], said
    assert fault.says in said[0]["message"] + said[0]["hint"], said


@pytest.mark.parametrize(
    ("type_", "value", "reason"),
    [
        ("bool", "1", "true or false"),
        ("bool", '"true"', "without quotes"),
        ("byte", "-1", "use short, or a larger value"),
        ("byte", "256", "not from 0 to 255"),
        ("short", "32768", "use int"),
        ("short", "1.0", "not an integer"),
        ("int", "-2147483649", "use long, or a larger value"),
        ("int", "left", "not a number"),
        ("int", "true", "not a number"),
        ("long", "9223372036854775808", "use double, or a smaller value"),
        ("float", "1e39", "use double"),
        ("float", "1e-60", "too small for a float"),
        ("double", "1" + "0" * 400, "too large for a double"),
        ("string", "5", 'in quotes: "5"'),
        ("string", '"a\\0b"', "NUL"),
        ("string", "x" * 10_001, "more than 10000 characters"),
        ("Side", "0", "it has left, right"),
        ("Side", "Left", "did you mean 'left'"),
    ],
)
def test_a_value_that_does_not_fit(type_: str, value: str, reason: str, diagnostics: Callable[..., list[dict]]) -> None:
    said = diagnostics(
        {
            "Map.idsl.yaml": SIDE
            + (
                f"  S: {{struct: {{a: {{type: {type_}, default: {value}}}}}}}\n"
                f"constants: {{c: {{type: {type_}, value: {value}}}}}\n"
            )
        }
    )
    assert [(d["code"], d["line"]) for d in said] == [("RC1023", 4), ("RC1023", 5)], said
    assert reason in said[0]["message"] + said[0]["hint"], said


@pytest.mark.parametrize(
    ("type_", "value"),
    [
        ("bool", "True"), ("byte", "+255"), ("short", "-32768"), ("int", "2147483647"), ("long", str(-(2**63))),
        ("float", ".9"), ("float", "3"), ("float", "0e-999"), ("double", "2000."), ("double", "1" + "0" * 30),
        ("string", '""'), ("string", '"5"'), ("string", "on"), ("Side", "right"),
    ],
)  # fmt: skip
def test_a_value_that_fits(type_: str, value: str, diagnostics: Callable[..., list[dict]]) -> None:
    text = f"  S: {{struct: {{a: {{type: {type_}, default: {value}}}}}}}\n"
    assert diagnostics({"Map.idsl.yaml": SIDE + text}) == []


def test_reserved_words_of_other_languages_are_allowed(diagnostics: Callable[..., list[dict]]) -> None:
    words = ["lambda", "self", "None", "current", "c", "namespace", "template", "delete", "Struct", "object", "array"]
    members = ", ".join(f"{word}: int" for word in words)
    assert diagnostics({"Map.idsl.yaml": TYPES + f"  S: {{struct: {{{members}}}}}\n"}) == []


def test_a_sequence_as_a_key_is_a_warning(diagnostics: Callable[..., list[dict]]) -> None:
    said = diagnostics({"Map.idsl.yaml": TYPES + "  Q: {sequence: int}\n  D: {map: {key: Q, value: int}}\n"})
    assert [(d["code"], d["severity"]) for d in said] == [("RC1017", "warning")]


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (TYPES + "  Text: {struct: {Text: string}}\n", "call it 'text'"),
        (METHODS + "      Pose: {returns: Pose}\n", "call it 'pose'"),
        (METHODS + "      Busy: {throws: [Busy]}\n", "call it 'busy'"),
    ],
)
def test_names_that_do_not_compile_in_cpp_are_a_warning(
    text: str, hint: str, diagnostics: Callable[..., list[dict]]
) -> None:
    said = diagnostics({"Map.idsl.yaml": text})
    assert [(d["code"], d["severity"], d["hint"]) for d in said] == [("RC1026", "warning", hint)]


@pytest.mark.parametrize(
    ("type_", "value", "hint"),
    [
        ("double", "3.141592653589793", "in the programs"),
        ("float", "3.14159265", "in the programs"),
        ("float", "1e-7", "use double"),
        ("float", "1e20", "use double"),
    ],
)
def test_a_number_that_ice_changes_is_a_warning(
    type_: str, value: str, hint: str, diagnostics: Callable[..., list[dict]]
) -> None:
    said = diagnostics({"Map.idsl.yaml": f"module: M\nconstants: {{c: {{type: {type_}, value: {value}}}}}\n"})
    assert [(d["code"], d["severity"], d["line"]) for d in said] == [("RC1025", "warning", 2)]
    assert hint in said[0]["hint"]


@pytest.mark.parametrize(
    ("type_", "value"),
    [("double", "1e-7"), ("float", "1.5e-7"), ("float", ".1"), ("double", "1234567.0"), ("float", "1e6")],
)
def test_a_number_that_ice_keeps(type_: str, value: str, diagnostics: Callable[..., list[dict]]) -> None:
    assert diagnostics({"Map.idsl.yaml": f"module: M\nconstants: {{c: {{type: {type_}, value: {value}}}}}\n"}) == []


def test_two_circles_of_types_are_two_errors(diagnostics: Callable[..., list[dict]]) -> None:
    text = TYPES + (
        "  A: {struct: {b: B, a: A}}\n  B: {struct: {a: A, d: D}}\n  C: {sequence: D}\n  D: {struct: {c: C}}\n"
        "  Fine: {struct: {a: A, d: D}}\n"
    )
    assert sorted(d["message"] for d in diagnostics({"Map.idsl.yaml": text})) == [
        "the sequence 'C' contains itself: C → D → C",
        "the struct 'A' contains itself: A → B → A",
    ]
