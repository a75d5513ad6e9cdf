"""An IceStorm that is started unless another one is present: that of the including deployment, or one that answers."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from processes import Ports, kill_left

Rcyaml = Callable[..., Result]

pytestmark = pytest.mark.skipif(shutil.which("icebox") is None, reason="no icebox (Debian: zeroc-icebox)")

PART = """\
deployment: {name}
services: {{storm: {{icestorm: {{port: {port}, publish: {publish}, shared: true}}}}}}
components:
  base: {{program: sleep, args: ["600"], after: [storm]}}
"""
ROBOT = "deployment: Robot\ninclude: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}\n"


@pytest.fixture
def folder(tmp_path: Path, free_port: Ports) -> Iterator[Path]:
    ports = {name: free_port() for name in ("port", "publish")}
    own = f"services: {{mine: {{icestorm: {{port: {free_port()}, publish: {free_port()}}}}}}}\n"
    write_tree(tmp_path, {
        "arm.ddsl.yaml": PART.format(name="Arm", **ports), "leg/leg.ddsl.yaml": PART.format(name="Leg", **ports),
        "robot.ddsl.yaml": ROBOT, "own.ddsl.yaml": f"{ROBOT}{own}",
    })  # fmt: skip
    yield tmp_path
    for name in ("Arm", "Robot", "leg/Leg"):
        above, _, last = name.rpartition("/")
        kill_left(str(tmp_path / above / ".rcyaml" / "deployments" / last))


def planned(rcyaml: Rcyaml, document: str) -> set[str]:
    found = rcyaml("deploy", "plan", document, "--format", "json")
    assert found.exit_code == 0, found.output
    return {step["name"] for step in json.loads(found.stdout)["plan"] if step["action"] == "start"}


def test_which_one_is_started(folder: Path, rcyaml: Rcyaml) -> None:
    assert planned(rcyaml, "arm.ddsl.yaml") == {"storm", "base"}
    assert planned(rcyaml, "robot.ddsl.yaml") == {"left.storm", "left.base", "right.base"}
    assert planned(rcyaml, "own.ddsl.yaml") == {"mine", "left.base", "right.base"}


def test_one_that_answers_is_used(folder: Path, rcyaml: Rcyaml) -> None:
    assert rcyaml("deploy", "up", "arm.ddsl.yaml").exit_code == 0
    assert planned(rcyaml, "leg/leg.ddsl.yaml") == {"base"}
    assert rcyaml("deploy", "up", "leg/leg.ddsl.yaml").stdout == "base   ready\nLeg: 1 process as desired\n"
    status = rcyaml("deploy", "status", "leg/leg.ddsl.yaml")
    assert status.exit_code == 0 and "storm    another one is present" in status.stdout
    assert rcyaml("deploy", "down", "arm.ddsl.yaml").exit_code == 0
    assert planned(rcyaml, "leg/leg.ddsl.yaml") == {"storm"}
    assert "storm  ready" in rcyaml("deploy", "up", "leg/leg.ddsl.yaml").stdout
    assert rcyaml("deploy", "down", "leg/leg.ddsl.yaml").exit_code == 0
