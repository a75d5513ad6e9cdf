"""Names across modules, and modules that are imported together."""

from __future__ import annotations

from collections.abc import Callable

import pytest

POSE = "module: RoboCompTypes\ntypes: {Pose: {struct: {x: float}}}\nexceptions: {Lost: {}}\n"
Check = Callable[..., list[dict]]


def _one(diagnosed: list[dict]) -> tuple[str, str, int, str]:
    assert len(diagnosed) == 1, diagnosed
    return diagnosed[0]["code"], diagnosed[0]["file"], diagnosed[0]["line"], diagnosed[0]["hint"]


@pytest.mark.parametrize("name", ["Types.Pose", "RoboCompTypes.Pose"])
def test_a_type_of_an_import_needs_the_modules_name(name: str, diagnostics: Check) -> None:
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
def test_the_hint_at_a_type_of_another_module(imports: str, name: str, hint: str, diagnostics: Check) -> None:
    text = f"module: RoboCompMap\nimports: {imports}\ntypes:\n  Path: {{sequence: {name}}}\n"
    diagnosed = diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": POSE})
    assert _one(diagnosed) == ("RC1010", "Map.idsl.yaml", 4, hint)


def test_the_hint_at_an_exception_of_another_module(diagnostics: Check) -> None:
    text = "module: RoboCompMap\ninterfaces: {Map: {methods: {go: {throws: [Lost]}}}}\n"
    diagnosed = diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": POSE})
    assert _one(diagnosed) == ("RC1011", "Map.idsl.yaml", 2, "add Types to `imports`, and write 'Types.Lost'")


def test_types_of_a_missing_import_are_not_reported(diagnostics: Check) -> None:
    text = (
        "module: RoboCompMap\nimports: [Gone]\ntypes:\n  A: {sequence: Gone.Pose}\n  B: {sequence: RoboCompGone.Pose}\n"
        "  C: {map: {key: Gone.Key, value: int}}\n  D: {struct: {s: {type: Gone.Side, default: left}}}\n"
        "interfaces: {Map: {methods: {go: {throws: [Gone.Lost]}}}}\n"
    )
    assert _one(diagnostics({"Map.idsl.yaml": text}))[0] == "RC1101"


def test_a_fault_is_reported_for_its_module_only(diagnostics: Check) -> None:
    """It is not reported for modules that import the module."""
    bad = "module: RoboCompTypes\ntypes: {Pose: {struct: {x: flaot}}}\n"
    text = "module: RoboCompMap\nimports: [Types]\ntypes:\n  Path: {sequence: Types.Pose}\n"
    diagnosed = diagnostics({"Map.idsl.yaml": text, "Types.idsl.yaml": bad})
    assert _one(diagnosed) == ("RC1010", "Types.idsl.yaml", 2, "did you mean 'float'?")


TWINS = {"Types.idsl.yaml": POSE, "Types2.idsl.yaml": POSE, "A.idsl.yaml": "module: A\nimports: [Types]\n"}


def test_modules_of_one_name_that_are_not_imported_together(diagnostics: Check) -> None:
    assert diagnostics({**TWINS, "B.idsl.yaml": "module: B\nimports: [Types2]\n"}) == []


def test_modules_of_one_name_are_reported_at_the_first_common_importer(diagnostics: Check) -> None:
    """B imports both, one through A. C, which imports B, is not reported."""
    both = {"B.idsl.yaml": "module: B\nimports: [A, Types2]\n", "C.idsl.yaml": "module: C\nimports: [B]\n"}
    diagnosed = diagnostics({**TWINS, **both})
    assert _one(diagnosed) == ("RC1105", "B.idsl.yaml", 2, "import only one of them")
    assert "'Pose' of module RoboCompTypes" in diagnosed[0]["message"]


def test_a_component_that_imports_two_modules_of_one_name(diagnostics: Check) -> None:
    text = "component: C\nlanguage: python\nimports: [A, Types2]\n"
    diagnosed = diagnostics({**TWINS, "c.cdsl.yaml": text})
    assert _one(diagnosed)[:2] == ("RC1105", "c.cdsl.yaml")


def test_a_module_in_two_documents_without_common_names(diagnostics: Check) -> None:
    more = "module: RoboCompTypes\nimports: [Types]\ntypes: {Path: {sequence: Types.Pose}}\n"
    assert diagnostics({"Types.idsl.yaml": POSE, "More.idsl.yaml": more}) == []


@pytest.mark.parametrize("folder_and_name", ["old/Types", "types", "Ty_pes"])
def test_documents_with_the_same_slice_file(folder_and_name: str, diagnostics: Check) -> None:
    first = "Ty-pes" if folder_and_name == "Ty_pes" else "Types"
    diagnosed = diagnostics(
        {
            f"{first}.idsl.yaml": POSE,
            f"{folder_and_name}.idsl.yaml": "module: RoboCompOther\n",
            "Map.idsl.yaml": f"module: RoboCompMap\nimports: [{first}, {folder_and_name}]\n",
        }
    )
    assert "RC1107" in [d["code"] for d in diagnosed if d["severity"] == "error"]
    assert {d["code"] for d in diagnosed if d["severity"] == "error"} == {"RC1107"}


@pytest.mark.parametrize(("name", "hint"), [
    ("Tpes", "did you mean 'Types'?"), ("Typos", "did you mean 'Types'?"), ("Types360RGB", "put its document beside this one"),
])  # fmt: skip
def test_an_import_that_is_missing_is_no_typing_error(name: str, hint: str, diagnostics: Check) -> None:
    """The names of interfaces are similar: `Camera` is not meant by `Camera360`, whose document is elsewhere."""
    found = diagnostics({"Map.idsl.yaml": f"module: RoboCompMap\nimports: [{name}]\n", "Types.idsl.yaml": POSE})
    assert _one(found)[3].startswith(hint), found
