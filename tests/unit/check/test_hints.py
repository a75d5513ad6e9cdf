"""A hint is something to type: never what stands there already, nor what beside it would be the next error."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robocomp_yaml.diag.suggest import did_you_mean, suggest

Check = Callable[..., list[dict[str, Any]]]
IDSL = "module: RoboCompArm\nexceptions: {Stuck: {}, Slow: {}}\ninterfaces: {Arm: {}, Army: {}}\n"


def component(keys: str) -> dict[str, str]:
    return {"Arm.idsl.yaml": IDSL, "c.cdsl.yaml": f"component: C\nlanguage: python\n{keys}"}


def test_the_word_itself_is_no_suggestion() -> None:
    assert suggest("closd", ["closd", "closed"]) == "closed"
    assert suggest("closed", ["closed"]) is None


def test_what_stands_beside_it_is_none_either() -> None:
    assert did_you_mean("Amr", ["Arm", "Leg"]) == "did you mean 'Arm'?"
    assert did_you_mean("Amr", ["Arm", "Amor"], {"Arm"}) == "did you mean 'Amor'?"
    assert did_you_mean("Amr", ["Arm"], {"Arm"}) == "'Arm' is there already"
    assert did_you_mean("Leg", ["Arm"], {"Arm"}) == ""


@pytest.mark.parametrize(("files", "hint"), [
    (component("imports: [Arm, Amr]\n"), "'Arm' is there already"),
    (component("imports: [Amr]\n"), "did you mean 'Arm'?"),
    (component("imports: [Arm]\nrequires: [Arm, Arny]\n"), "did you mean 'Army' (Arm.idsl.yaml)?"),
    (component("imports: [Arm]\nrequires: [Arm, Army, Armmy]\n"), "'Army' is there already"),
    (component("imports: [Arm]\nrequires: [Arm]\nimplements: [Amr]\n"), "did you mean 'Arm' (Arm.idsl.yaml)?"),
    ({"Arm.idsl.yaml": IDSL.replace("Army: {}", "Leg: {methods: {go: {throws: [Stuck, Stuk]}}}")},
     "'Stuck' is there already"),
    ({"Arm.idsl.yaml": IDSL, "Leg.idsl.yaml": "module: RoboCompLeg\ntypes: {Pose: {struct: {x: int}}}\n"
      "interfaces: {Leg: {methods: {go: {throws: [Arm.Stuck]}}}}\n"}, "add Arm to `imports`"),
    ({"Leg.idsl.yaml": "module: RoboCompLeg\nimports: [Lge]\n"}, "put its document beside this one, or name its folder "
     "under `interfaces:` in rcyaml.yaml, or with -I"),
])  # fmt: skip
def test_hints_of_lists(diagnostics: Check, files: dict[str, str], hint: str) -> None:
    assert [d["hint"] for d in diagnostics(files)] == [hint]
