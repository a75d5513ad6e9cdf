"""The paper's example: JointMotorComp, in both languages, from one document of parameters and one of values."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import ROOT
from robocomp_yaml.source import properties

PAPER = {
    "JointMotor.NumMotors": "2",
    "JointMotor.Handler": "Dunkermotoren",
    "JointMotor.Device": "/dev/ttyUSB0",
    "JointMotor.BaudRate": "115200",
    "JointMotor.BasicPeriod": "220",
    "JointMotor.M0": "dunker0,A,true,-3.14,3.14,0,.9",
    "JointMotor.M1": "dunker1,B,false,-3.14,3.14,0,.9",
}


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_the_papers_listing(rcyaml: Callable[..., Result], tmp_path: Path, language: str) -> None:
    shutil.copytree(ROOT / "examples/jointmotor", tmp_path, dirs_exist_ok=True)
    result = rcyaml("compile", f"{language}/jointmotor.cdsl.yaml")
    assert result.exit_code == 0, result.output
    held = properties.read((tmp_path / language / "etc/config").read_text()).values
    assert {
        key: value for key, value in held.items() if key.startswith("JointMotor.") and "Endpoints" not in key
    } == PAPER
    assert (tmp_path / language / "generated/parameters.md").is_file()
