"""A hint can be typed: it is neither the word itself, nor a word that would be the next error."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, suggest

Check = Callable[..., list[dict[str, Any]]]
IDSL = "module: RoboCompArm\nexceptions: {Stuck: {}, Slow: {}}\ninterfaces: {Arm: {}, Army: {}}\n"


def component(keys: str) -> dict[str, str]:
    return {"Arm.idsl.yaml": IDSL, "c.cdsl.yaml": f"component: C\nlanguage: python\n{keys}"}


def test_the_word_itself_is_not_suggested() -> None:
    assert suggest("closd", ["closd", "closed"]) == "closed"
    assert suggest("closed", ["closed"]) is None


def test_words_of_the_same_list_are_not_suggested() -> None:
    assert str(did_you_mean("Amr", ["Arm", "Leg"])) == "did you mean 'Arm'?"
    assert str(did_you_mean("Amr", ["Arm", "Amor"], {"Arm"})) == "did you mean 'Amor'?"
    assert str(did_you_mean("Amr", ["Arm"], {"Arm"})) == "'Arm' is already present"
    assert not did_you_mean("Leg", ["Arm"], {"Arm"})
    assert str(did_you_mean("Leg", ["Arm"], otherwise="there is Arm")) == "there is Arm"


@pytest.mark.parametrize(("word", "known", "open_", "meant", "safe"), [
    ("Amr", ["Arm", "Leg"], False, "Arm", False),
    ("ARM", ["Arm", "Leg"], False, "Arm", True),
    ("ARM", ["Arm", "arm"], False, "Arm", False),  # both are possible
    ("ARM", ["Arm", "Leg"], True, "Arm", False),  # there may be an unknown third one
    ("Leg", ["Arm"], False, "", False),
])  # fmt: skip
def test_a_fix_of_the_case_is_safe_if_only_one_word_matches(
    word: str, known: list[str], open_: bool, meant: str, safe: bool
) -> None:
    hint = did_you_mean(word, known, open_=open_)
    assert (hint.meant, hint.safe) == (meant, safe)
    assert [(edit.word, edit.text) for fix in hint.fixes(Span("a")) for edit in fix.edits] == [(word, meant)][
        : bool(meant)
    ]


@pytest.mark.parametrize(("files", "hint"), [
    (component("imports: [Arm, Amr]\n"), "'Arm' is already present"),
    (component("imports: [Amr]\n"), "did you mean 'Arm'?"),
    (component("imports: [Arm]\nrequires: [Arm, Arny]\n"), "did you mean 'Army' (Arm.idsl.yaml)?"),
    (component("imports: [Arm]\nrequires: [Arm, Army, Armmy]\n"), "the list already has 'Army'"),
    (component("imports: [Arm]\nrequires: [Arm]\nimplements: [Amr]\n"), "did you mean 'Arm' (Arm.idsl.yaml)?"),
    ({"Arm.idsl.yaml": IDSL.replace("Army: {}", "Leg: {methods: {go: {throws: [Stuck, Stuk]}}}")},
     "'Stuck' is already present"),
    ({"Arm.idsl.yaml": IDSL, "Leg.idsl.yaml": "module: RoboCompLeg\ntypes: {Pose: {struct: {x: int}}}\n"
      "interfaces: {Leg: {methods: {go: {throws: [Arm.Stuck]}}}}\n"}, "add Arm to `imports`"),
    ({"Leg.idsl.yaml": "module: RoboCompLeg\nimports: [Lge]\n"}, "put its document beside this one, or list its folder "
     "under `interfaces:` in rcyaml.yaml, or pass it with -I"),
])  # fmt: skip
def test_hints_of_lists(diagnostics: Check, files: dict[str, str], hint: str) -> None:
    assert [d["hint"] for d in diagnostics(files)] == [hint]
