"""Names across modules, and modules that meet."""

from __future__ import annotations

from collections.abc import Callable

import pytest

POSE = "module: RoboCompTypes\ntypes: {Pose: {struct: {x: float}}}\nexceptions: {Lost: {}}\n"
Check = Callable[..., list[dict]]


def _one(said: list[dict]) -> tuple[str, str, int, str]:
    assert len(said) == 1, said
    return said[0]["code"], said[0]["file"], said[0]["line"], said[0]["hint"]


@pytest.mark.parametrize("name", ["Types.Pose", "RoboCompTypes.Pose"])
def test_a_type_of_an_import_stands_behind_its_module(name: str, diagnostics: Check) -> None:
    text = f"module: RoboCompMap\nimports: [Types]\ntypes:\n  Path: {{sequence: {name}}}\n"
    assert diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": POSE}) == []


@pytest.mark.parametrize(
    ("imports", "name", "hint"),
    [
        ("[Types]", "Pose", "write 'Types.Pose': names of other modules need the module's name"),
        ("[]", "Pose", "add Types to `imports`, and write 'Types.Pose'"),
        ("[]", "RoboCompTypes.Pose", "add Types to `imports`, and write 'Types.Pose'"),
        ("[Types]", "Types.Posse", "did you mean 'Types.Pose'?"),
        ("[Types]", "Typos.Pose", "did you mean 'Types.Pose'?"),
        ("[Types]", "Nothing.AtAll", "define it, or import the module that defines it"),
    ],
)
def test_the_hint_says_how_to_reach_a_type(imports: str, name: str, hint: str, diagnostics: Check) -> None:
    text = f"module: RoboCompMap\nimports: {imports}\ntypes:\n  Path: {{sequence: {name}}}\n"
    said = diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": POSE})
    assert _one(said) == ("RC1010", "Map.idsl.yaml", 4, hint)


def test_the_hint_says_how_to_reach_an_exception(diagnostics: Check) -> None:
    text = "module: RoboCompMap\ninterfaces: {Map: {methods: {go: {throws: [Lost]}}}}\n"
    said = diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": POSE})
    assert _one(said) == ("RC1011", "Map.idsl.yaml", 2, "add Types to `imports`, and write 'Types.Lost'")


def test_what_a_missing_import_might_define_is_not_reported_again(diagnostics: Check) -> None:
    text = (
        "module: RoboCompMap\nimports: [Gone]\ntypes:\n  A: {sequence: Gone.Pose}\n  B: {sequence: RoboCompGone.Pose}\n"
        "  C: {map: {key: Gone.Key, value: int}}\n  D: {struct: {s: {type: Gone.Side, default: left}}}\n"
        "interfaces: {Map: {methods: {go: {throws: [Gone.Lost]}}}}\n"
    )
    assert _one(diagnostics({"Map.idsl.yaml": text}))[0] == "RC1101"


def test_a_fault_is_told_of_the_module_that_has_it(diagnostics: Check) -> None:
    """Not of those that import it."""
    bad = "module: RoboCompTypes\ntypes: {Pose: {struct: {x: flaot}}}\n"
    text = "module: RoboCompMap\nimports: [Types]\ntypes:\n  Path: {sequence: Types.Pose}\n"
    said = diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": bad})
    assert _one(said) == ("RC1010", "Types.idsl.yaml", 2, "did you mean 'float'?")


TWINS = {"Types.idsl.yaml": POSE, "Types2.idsl.yaml": POSE, "A.idsl.yaml": "module: A\nimports: [Types]\n"}


def test_twins_that_nobody_joins_are_allowed(diagnostics: Check) -> None:
    assert diagnostics({**TWINS, "B.idsl.yaml": "module: B\nimports: [Types2]\n"}) == []


def test_twins_are_told_of_where_they_first_meet(diagnostics: Check) -> None:
    """In B, through A; not again in C, which imports B."""
    both = {"B.idsl.yaml": "module: B\nimports: [A, Types2]\n", "C.idsl.yaml": "module: C\nimports: [B]\n"}
    said = diagnostics({**TWINS, **both})
    assert _one(said) == ("RC1105", "B.idsl.yaml", 2, "import only one of them")
    assert "'Pose' of module RoboCompTypes" in said[0]["message"]


def test_twins_meet_in_a_component_too(diagnostics: Check) -> None:
    text = "component: C\nlanguage: python\nimports: [A, Types2]\n"
    said = diagnostics({**TWINS, "c.cdsl.yaml": text})
    assert _one(said)[:2] == ("RC1105", "c.cdsl.yaml")


def test_a_module_in_two_documents_with_names_of_their_own(diagnostics: Check) -> None:
    more = "module: RoboCompTypes\nimports: [Types]\ntypes: {Path: {sequence: Types.Pose}}\n"
    assert diagnostics({"Types.idsl.yaml": POSE, "More.idsl.yaml": more}) == []


@pytest.mark.parametrize("folder_and_name", ["old/Types", "types", "Ty_pes"])
def test_documents_that_become_the_same_file(folder_and_name: str, diagnostics: Check) -> None:
    first = "Ty-pes" if folder_and_name == "Ty_pes" else "Types"
    said = diagnostics(
        {
            f"{first}.idsl.yaml": POSE,
            f"{folder_and_name}.idsl.yaml": "module: RoboCompOther\n",
            "Map.idsl.yaml": f"module: RoboCompMap\nimports: [{first}, {folder_and_name}]\n",
        }
    )
    assert "RC1107" in [d["code"] for d in said if d["severity"] == "error"]
    assert {d["code"] for d in said if d["severity"] == "error"} == {"RC1107"}
