"""A component in Java and one in Python are deployed, and call each other."""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from java_programs import java_build, needs_java
from processes import Ports, until
from small_networks import Place

pytest.importorskip("Ice", reason="Ice's Python module is not installed")
pytestmark = [pytest.mark.slow, needs_java]
Rcyaml = Callable[..., Result]

FILES = {
    "Talk.idsl.yaml": """\
module: RoboCompTalk
interfaces:
  Ear: {methods: {hear: {in: {words: string}, returns: int}}}
  Mouth: {methods: {say: {in: {words: string}, returns: string}}}
""",
    "ear/ear.cdsl.yaml": "component: EarComp\nlanguage: java\nimports: [Talk]\nimplements: [Ear]\nrequires: [Mouth]\n"
    "parameters: ear.pdsl.yaml\nperiod: 50 ms\n",
    "ear/ear.pdsl.yaml": "parameters: {loud: {type: int, range: [0, 10], default: 3}}\n",
    "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [Talk]\nimplements: [Mouth]\n"
    "requires: [{Ear: {interface: Ear, absent: ignore}}]\n",
    "rcyaml.yaml": "interfaces: [.]\n",
}
EAR = """\
import generated.GenericWorker;

public class SpecificWorker extends GenericWorker {
    private boolean isTold;

    @Override
    public void compute() {
        if (!isTold) {
            log.info("said: " + mouth_proxy.say("one"));
            isTold = true;
        }
    }

    @Override
    public int Ear_hear(String words) {
        return words.length() * parameters.loud();
    }
}
"""
MOUTH = """\
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def Mouth_say(self, words):
        return f"{words} {self.ear_proxy.hear('four')}"
"""
ROBOT = """\
deployment: Robot
components:
  ear: {{component: ear, port: {ear}, set: {{loud: {loud}}}}}
  mouth: {{component: mouth, port: {mouth}}}
"""


def test_java_beside_python(
    place: Place, tmp_path: Path, rcyaml: Rcyaml, free_port: Ports, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    write_tree(tmp_path, FILES)
    ports = {"ear": free_port(), "mouth": free_port()}

    def write(loud: int) -> None:
        (tmp_path / "robot.ddsl.yaml").write_text(ROBOT.format(**ports, loud=loud))

    write(5)
    assert rcyaml("compile", ".").exit_code == 0
    (tmp_path / "ear/src/SpecificWorker.java").write_text(EAR)
    (tmp_path / "mouth/src/specificworker.py").write_text(MOUTH)
    told = rcyaml("deploy", "plan", "robot.ddsl.yaml")
    assert "`rcyaml compile ear/ear.cdsl.yaml`, then `rcyaml build EarComp`" in told.output, "it is not built yet"
    java_build(tmp_path / "ear")
    up = rcyaml("deploy", "up", "robot.ddsl.yaml")
    assert up.exit_code == 0, up.output
    until(lambda: "said: one 20" in rcyaml("deploy", "logs", "robot.ddsl.yaml", "ear").output, "they call each other")

    # Changed values, and a new build, restart the component, and no other.
    before = place.pids()
    write(6)
    assert "~ ear    restart: config loud: 5 → 6\n" in rcyaml("deploy", "plan", "robot.ddsl.yaml").stdout
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
    assert place.pids()["mouth"] == before["mouth"]
    time.sleep(0.01)
    java_build(tmp_path / "ear")
    assert "~ ear    restart: " in rcyaml("deploy", "plan", "robot.ddsl.yaml").stdout
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0

    # The interface has changed: both are compiled and built again.
    talk = tmp_path / "Talk.idsl.yaml"
    talk.write_text(talk.read_text().replace("say:", "tell: {}, say:"))
    told = rcyaml("deploy", "plan", "robot.ddsl.yaml").output
    assert "`rcyaml compile ear/ear.cdsl.yaml`, then `rcyaml build EarComp`" in told

    os.kill(place.pids()["ear"], signal.SIGKILL)

    def is_back() -> bool:
        answer = rcyaml("deploy", "status", "robot.ddsl.yaml", "ear", "--format", "json").stdout
        (ear,) = json.loads(answer)["processes"]
        return bool(ear["ready"]) and ear["restarts"] == 1

    until(is_back, "the ear answers again")
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0
    place.wait_gone()
