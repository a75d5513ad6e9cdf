"""`set:` of a deployment on a flat config: what of its parameters is written, and what of the flat config still counts."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import config, deployed, faults, network, said

PDSL = """\
component: mouth.cdsl.yaml
types:
  Motor: {struct: {name: string, vel: {type: float, default: 0.9}, unit: {type: string, default: mm}}}
parameters:
  motors: {list: Motor, default: [{name: left}]}
  rows: {list: Motor, default: []}
  open: {list: int, optional: true}
  by: {map: Motor, default: {}}
  one: {type: Motor, default: {name: first}}
  arm: {group: {speed: {type: int, default: 5}, home: {list: int, default: [1, 2]}}}
legacy:
  rows: {key: "Row{i}", columns: [name, vel, unit], separator: ","}
  open: {key: "Open{i}"}
"""
FLAT = """\
motors.size=2
motors.0.name=a
motors.1.name=b
motors.1.vel=1
Row0=a,0.5,cm
Row1=b,0.6,cm
Open0=1
Open1=2
by.keys=l m
by.l.name=left
by.m.name=middle
by.m.vel=0.1
one.name=x
one.vel=0.2
arm.speed=6
arm.home.size=1
arm.home.0=7
Own=kept
"""
ROWS = {"Row0": "a,0.5,cm", "Row1": "b,0.6,cm"}
DERIVED = ("Mouth.Endpoints", "CommonBehavior.Endpoints")


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def written(given: str, base: str = "") -> dict[str, str]:
    """The parameters of the configuration with `set: {given}`."""
    text = f"components: {{lips: {{component: mouth{base}, set: {{{given}}}}}}}\n"
    files = deployed(text, **{"mouth/mouth.pdsl.yaml": PDSL, "mouth/etc/config": FLAT})
    found = config(network(files).processes["lips"])
    return {key: value for key, value in found.items() if key not in DERIVED}


def before() -> dict[str, str]:
    return dict(line.split("=") for line in FLAT.splitlines())


def motor(path: str, name: str, vel: str = "0.9", unit: str = "mm") -> dict[str, str]:
    return {f"{path}.name": name, f"{path}.vel": vel, f"{path}.unit": unit}


CASES: list[tuple[str, str, dict[str, str]]] = [
    # what is set, the beginning of the properties that it replaces, what replaces them
    ('"rows[1]": {name: x, unit: m}', "Row", {"Row0": "a,0.5,cm", "Row1": "x,0.9,m"}),
    ("rows: [{name: x}]", "Row", {"Row0": "x,0.9,mm"}),
    ("rows: null", "Row", {}),
    ("open: [3]", "Open", {"Open0": "3"}),
    ("open: null", "Open", {}),
    ('"motors[0]": {name: x}', "motors",
     {"motors.size": "2", **motor("motors.0", "x"), **motor("motors.1", "b", "1")}),
    ("motors: [{name: x}]", "motors", {"motors.size": "1", **motor("motors.0", "x")}),
    ("motors: null", "motors", {}),
    ("by: {r: {name: right}}", "by",
     {"by.keys": "l m r", **motor("by.l", "left"), **motor("by.m", "middle", "0.1"), **motor("by.r", "right")}),
    ('"by.m": {unit: cm}', "by",
     {"by.keys": "l m", **motor("by.l", "left"), **motor("by.m", "middle", "0.1", "cm")}),
    ("by: {m: null}", "by", {"by.keys": "l", **motor("by.l", "left")}),
    ("one: {unit: cm}", "one", motor("one", "x", "0.2", "cm")),
    ("one: {vel: null}", "one", motor("one", "x")),
    ("one: null", "one", {}),
    ("arm.speed: 7", "arm.speed", {"arm.speed": "7"}),
    ("arm: {home: null}", "arm.home", {}),
    ("arm: null", "arm", {}),
]  # fmt: skip


@pytest.mark.parametrize("base", ["", ", config: etc/config"])
@pytest.mark.parametrize(("given", "start", "expected"), CASES, ids=[given for given, _, _ in CASES])
def test_a_parameter_is_replaced_as_a_whole_and_no_other_one(
    given: str, start: str, expected: dict[str, str], base: str
) -> None:
    others = {key: value for key, value in before().items() if not key.startswith(start)}
    assert written(given, base) == {**others, **expected}


def test_a_flat_config_that_config_names_keeps_its_text() -> None:
    text = "components: {lips: {component: mouth, config: etc/config, set: {open: [3]}}}\n"
    files = deployed(text, **{"mouth/mouth.pdsl.yaml": PDSL, "mouth/etc/config": FLAT})
    made = network(files).processes["lips"].config
    assert made is not None and made.text.startswith(f"{FLAT}\n# What the deployment replaces.\nOpen1=\n")


def test_values_of_a_flat_config_that_nobody_judges_are_not_used() -> None:
    text = 'components: {lips: {component: mouth, config: etc/config, set: {"open[0]": 3}}}\n'
    files = deployed(text, **{"mouth/mouth.pdsl.yaml": PDSL, "mouth/etc/config": "Open0=1\none.vel=fast\n"})
    assert [said(fault)[0] for fault in faults(files)] == ["RC4307"]


def test_a_period_by_the_name_of_robocomp_is_replaced() -> None:
    text = "components: {lips: {component: mouth, set: {period: {compute: 20}}}}\n"
    flat = "Period.Compute=50\nPeriod.Emergency=60\n"
    found = config(network(deployed(text, **{"mouth/etc/config": flat})).processes["lips"])
    assert found["period.compute"] == "20" and "Period.Compute" not in found
    assert found["Period.Emergency"] == "60" and "period.emergency" not in found
