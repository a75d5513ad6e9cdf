"""JCDSL, and the PDSL and values of 2011."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]

SPEECH = "module RoboCompSpeech { interface Speech { void say(string text); }; };\n"
JCDSL = """\
{
    "imports": ["Speech.idsl"],
    "name": "SpeechComp",
    "implements": ["Speech"],
    "requires": ["Speech", ["Speech", "ice"]],
    "language": {"name": "Cpp11"},
    "gui": ["Qt", "QDialog"],
    "options": ["DSR"],
    "innermodelviewer": true,
    "modules": ["x"]
}
"""
PDSL = """\
// the laser
ComponentParams Laser{
\tdevice string "" T;
\tstart int 169 0:1000 T;   // degrees
\tangle float 1 0:10;
\ttalk bool true T;
};
"""
PCONF = """\
import "Laser.pdsl";
ConfigFile Laser{
\tdevice = "192.168.187.204"
    start = 0   # first
\tangle = 0.5
\ttalk = True
}"""


def text(folder: Path, name: str) -> str:
    return (folder / name).read_text(encoding="utf-8").split("\n", 1)[1]


def test_json_of_a_component(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl": SPEECH, "speech.jcdsl": JCDSL})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "RC5017" in result.output, result.output
    assert (
        text(tmp_path, "speech.cdsl.yaml")
        == """\
component: SpeechComp
language: cpp
imports: [Speech]
implements: [Speech]
requires: [Speech, Speech1: Speech]
gui: {toolkit: qt, base: QDialog}
options: [dsr, innermodelviewer]
x-legacy-modules: '["x"]'
""".replace("[Speech, Speech1: Speech]", "[Speech, {Speech1: Speech}]")
    )
    assert rcyaml("check", ".").exit_code == 0


@pytest.mark.parametrize(("old", "new", "code"), [
    ('"name": "SpeechComp",', "", "RC5003"), ('"language": {"name": "Cpp11"},', "", "RC5016"),
    ('"Cpp11"', '"N++"', "RC5015"), ('"imports": [', '"imports": ', "RC5003"), ('["Speech.idsl"]', "[3]", "RC5003"),
    ('"gui": ["Qt"', '"gui": ["Gtk"', "RC5015"), ('["x"]', "[" * 300 + "]" * 300, "RC5003"),
])  # fmt: skip
def test_json_that_is_not_a_component(rcyaml: Run, tmp_path: Path, old: str, new: str, code: str) -> None:
    assert old in JCDSL
    write_tree(tmp_path, {"speech.jcdsl": JCDSL.replace(old, new)})
    result = rcyaml("migrate", "speech.jcdsl")
    assert result.exit_code == 1 and f"[{code}]" in result.output, result.output
    assert not (tmp_path / "speech.cdsl.yaml").exists()


def test_parameters_and_values_of_2011(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"laser.pdsl": PDSL, "laser.pconf": PCONF, "etc/config": "start = 5\nother = 1\n"})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0, result.output
    assert (
        text(tmp_path, "laser.pdsl.yaml")
        == """\

# the laser
component: Laser
parameters:
  device: {type: string, default: "", editable: true}
  start: {type: int, range: [0, 1000], default: 169, editable: true}  # degrees
  angle: {type: float, range: [0, 10], default: 1}
  talk: {type: bool, default: true, editable: true}
"""
    )
    assert (
        text(tmp_path, "laser.config.yaml")
        == """\
component: laser.pdsl.yaml
parameters:
  device: 192.168.187.204
  start: 0  # first
  angle: 0.5
  talk: true
"""
    )
    assert "component: ../laser.pdsl.yaml\nparameters:\n  start: 5\nproperties:\n  other: " in text(
        tmp_path, "etc/config.yaml"
    )
    assert rcyaml("check", ".").exit_code == 0


def test_a_default_outside_of_its_range_is_omitted(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"laser.pdsl": PDSL.replace("169 0:1000", "2000 0:1000").replace('""', "5")})
    result = rcyaml("migrate", "laser.pdsl")
    assert result.exit_code == 0 and result.output.count("RC5005") == 2, result.output
    assert "start: {type: int, range: [0, 1000], editable: true}" in text(tmp_path, "laser.pdsl.yaml")
    assert rcyaml("check", ".").exit_code == 0


def test_parameters_of_2011_belong_to_the_component_in_their_folder(rcyaml: Run, tmp_path: Path) -> None:
    component = "Component Laser { Communications { }; language python; };\n"
    write_tree(tmp_path, {"laser.cdsl": component, "laser.pdsl": PDSL, "etc/config": "start = 5\n"})
    assert rcyaml("migrate", ".").exit_code == 0
    assert "component: laser.cdsl.yaml\n" in text(tmp_path, "laser.pdsl.yaml")
    assert not (tmp_path / "Laser.pdsl.yaml").exists()
    assert text(tmp_path, "etc/config.yaml").startswith("component: ../laser.cdsl.yaml\nparameters:\n  start: 5\n")
    assert rcyaml("check", ".").exit_code == 0
