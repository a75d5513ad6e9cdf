"""`rcyaml top` of components in each language: their periods, calls and topics, also while one of them hangs."""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

from conftest import in_long, write_tree
from cpp_programs import FAST, cmake, needs_cpp
from java_programs import java_build, needs_java
from processes import Ports, until
from small_networks import Place

pytest.importorskip("Ice", reason="Ice's Python module is not installed")
Rcyaml = Callable[..., Result]

PERIOD = 0.04
FILES = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Gripper.idsl.yaml": """\
module: RoboCompGripper
exceptions:
  Stuck:
interfaces:
  Gripper: {methods: {close: {in: {seconds: float}, throws: [Stuck]}, open: {}}}
topics:
  Force: {methods: {felt: {in: {newton: float}}}}
""",
}
CODE = {
    "python": {"src/specificworker.py": """\
import time

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompGripper


class SpecificWorker(GenericWorker):
    def compute(self):
        self.force_proxy.felt(1.5)

    def Gripper_close(self, seconds):
        if seconds < 0:
            raise RoboCompGripper.Stuck()
        time.sleep(seconds)

    def Gripper_open(self):
        pass

    def Force_felt(self, newton):
        pass
"""},
    "cpp": {"src/specificworker.cpp": """\
#include "specificworker.h"

#include <thread>

void SpecificWorker::initialize()
{
}

void SpecificWorker::compute()
{
    force_pubproxy->felt(1.5f);
}

void SpecificWorker::Gripper_close(float seconds)
{
    if (seconds < 0)
    {
        throw RoboCompGripper::Stuck();
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void SpecificWorker::Gripper_open()
{
}

void SpecificWorker::Force_felt(float)
{
}
"""},
    "java": {"src/SpecificWorker.java": """\
import generated.GenericWorker;
import slice.RoboCompGripper.Stuck;

public class SpecificWorker extends GenericWorker {
    @Override
    public void compute() {
        force_pubproxy.felt(1.5f);
    }

    @Override
    public void Gripper_close(float seconds) throws Stuck {
        if (seconds < 0) {
            throw new Stuck();
        }
        try {
            Thread.sleep((long) (1000 * seconds));
        } catch (InterruptedException error) {
            throw new RuntimeException(error);
        }
    }

    @Override
    public void Gripper_open() {
    }

    @Override
    public void Force_felt(float newton) {
    }
}
"""},
}  # fmt: skip
DOCUMENT = """\
deployment: Robot
alive: off
security: {security}
services: {{storm{storm}: {{icestorm: {{port: {storm}, publish: {publish}}}}}}}
components:
  left: {{component: {language}}}
  user: {{program: sleep, args: ["600"]}}
"""


def sampled(rcyaml: Rcyaml) -> dict[str, Any]:
    """The second of two samples, so that it is over a whole second."""
    done = rcyaml("top", "--format", "json", "--every", "1s", "--count", "2", "hands.ddsl.yaml")
    assert done.exit_code == 0, done.output
    return {one["name"]: one for one in json.loads(done.stdout.splitlines()[-1])["processes"]}


@pytest.mark.parametrize(
    ("language", "security"),
    [
        pytest.param("python", "none", id="python"),
        pytest.param("python", "tls", id="over TLS"),
        pytest.param("cpp", "none", id="cpp", marks=[pytest.mark.slow, needs_cpp]),
        pytest.param("cpp", "tls", id="cpp over TLS", marks=[pytest.mark.slow, needs_cpp]),
        pytest.param("java", "none", id="java", marks=[pytest.mark.slow, needs_java]),
        pytest.param("java", "tls", id="java over TLS", marks=[in_long, needs_java]),
    ],
)
def test_what_a_component_says(
    language: str, security: str, place: Place, tmp_path: Path, rcyaml: Rcyaml, free_port: Ports,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    cdsl = f"component: Hand\nlanguage: {language}\nimports: [Gripper]\nimplements: [Gripper]\npublishes: [Force]\n"
    write_tree(tmp_path, {
        **FILES, f"{language}/hand.cdsl.yaml": f"{cdsl}subscribes: [Force]\nperiod: 40 ms\n",
        "hands.ddsl.yaml": DOCUMENT.format(
            language=language, security=security, storm=free_port(), publish=free_port()
        ),
    })  # fmt: skip
    assert rcyaml("compile", ".").exit_code == 0
    write_tree(tmp_path / language, CODE[language])
    if language == "cpp":
        cmake(tmp_path / language, *FAST)
    elif language == "java":
        java_build(tmp_path / language)
    up = rcyaml("deploy", "up", "hands.ddsl.yaml")
    assert up.exit_code == 0, up.output

    for seconds, code in (("0.05", 0), ("-1", 1), ("0", 0)):
        assert rcyaml("call", "left.Gripper.close", f"seconds={seconds}").exit_code == code
    assert rcyaml("call", "left.Gripper.open").exit_code == 0
    found = sampled(rcyaml)
    left = found["left"]
    assert left["state"] == "running" and left["is_component"] and left["memory"] > 1 << 20 and left["cpu"] is not None
    worker = left["worker"]
    assert worker["period"] == PERIOD and PERIOD * 0.8 < worker["achieved"] < PERIOD * 5 and worker["missed"] >= 0
    methods = {one["method"]: one for one in left["methods"]}
    assert (methods["Gripper.close"]["calls"], methods["Gripper.close"]["failed"]) == (3, 1)
    assert methods["Gripper.open"]["calls"] == 1 and methods["Gripper.open"]["rate"] == 0
    assert left["slowest"]["method"] == "Gripper.close" and left["slowest"]["longest"] >= 0.05
    rates = {one["direction"]: one["rate"] for one in left["topics"]}
    assert rates.keys() == {"in", "out"} and all(0.2 / PERIOD < rate < 2 / PERIOD for rate in rates.values())
    assert not found["user"]["is_component"] and found["user"]["worker"] is None
    (storm,) = (one for name, one in found.items() if name.startswith("storm"))
    assert not storm["is_component"] and storm["memory"] > 1 << 20

    os.kill(left["pid"], signal.SIGSTOP)
    hung = sampled(rcyaml)["left"]
    assert hung["worker"] is hung["calls"] is hung["topics"] is None, "it does not answer"
    assert hung["cpu"] == 0 and hung["memory"] > 1 << 20 and hung["is_component"]
    (row,) = [line for line in rcyaml("top", "--once", "hands.ddsl.yaml", "left").stdout.splitlines() if "left" in line]
    assert row.split()[-6:] == ["unknown"] * 6
    os.kill(left["pid"], signal.SIGCONT)
    until(lambda: sampled(rcyaml)["left"]["worker"], "it answers again")
    os.kill(left["pid"], signal.SIGKILL)
    until(lambda: (now := sampled(rcyaml)["left"])["restarts"] == 1 and now["methods"] == [], "it counts from 0 again")
    assert rcyaml("deploy", "down", "hands.ddsl.yaml").exit_code == 0
