"""`rcyaml mock`: generated components that need others, tried with stand-ins."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from components import Build
from conftest import write_tree
from processes import Ports, Start, Storm

MOUTH = """\
module: RoboCompMouth
types:
  Mode: {enum: [idle, moving]}
exceptions:
  Jammed: {struct: {why: string}}
interfaces:
  Mouth:
    methods:
      open: {in: {width: float}, returns: bool, throws: [Jammed]}
      state: {out: {mode: Mode, turns: int}}
topics:
  Opened:
    methods:
      wide: {in: {width: float}}
      shut:
"""
SPEECH = "component: SpeechComp\nlanguage: python\nimports: [../Mouth]\nrequires: [Mouth]\n"
CODE = """
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompMouth

class SpecificWorker(GenericWorker):
    def initialize(self):
        for width in (1, 2, 3):
            try:
                print("opened", self.mouth_proxy.open(width))
            except RoboCompMouth.Jammed as jammed:
                print("jammed:", jammed.why)
        print("state", *self.mouth_proxy.state())
"""
SCRIPT = """\
interfaces:
  Mouth:
    methods:
      open:
        - {returns: true}
        - {throws: {Jammed: {why: sand}}, delay: 300 ms}
      state: {out: {mode: moving, turns: 7}}
"""
RCYAML = [os.path.join(os.path.dirname(sys.executable), "rcyaml")]


def test_a_component_resolves_the_mock_by_its_configuration(build: Build, start: Start) -> None:
    built = build({"Mouth.idsl.yaml": MOUTH, "speech/speech.cdsl.yaml": SPEECH, "r.mock.yaml": SCRIPT})
    speech = built["SpeechComp"]
    (speech.root / "src" / "specificworker.py").write_text(CODE)
    subprocess.run([*RCYAML, "-q", "compile", "--target", "config"], cwd=speech.root.parent, check=True)
    mock = start([*RCYAML, "mock", "--script", "r.mock.yaml"], cwd=speech.root.parent)
    mock.wait_for("serving  mouth:tcp -h 127.0.0.1 -p ")
    running = start(speech.command)
    running.wait_for("state moving 7")
    lines = [line for line in running.output.splitlines() if line.startswith(("opened", "jammed", "state"))]
    assert lines == ["opened True", "jammed: sand", "opened True", "state moving 7"]
    assert "Mouth.open(width: 2.0) raises Jammed" in mock.output
    assert "Mouth.state() returns {mode: moving, turns: 7}" in mock.output
    assert mock.stop(2) == 130


def test_without_a_script_it_returns_examples(build: Build, start: Start, free_port: Ports) -> None:
    built = build({"Mouth.idsl.yaml": MOUTH, "speech/speech.cdsl.yaml": SPEECH})
    speech, port = built["SpeechComp"], free_port()
    (speech.root / "src" / "specificworker.py").write_text(CODE)
    speech.configure({"Proxies.Mouth": f"mouth:tcp -h localhost -p {port}"})
    endpoint = f"RoboCompMouth.Mouth=tcp -h 127.0.0.1 -p {port}"
    command = [*RCYAML, "mock", "Mouth", "--endpoint", endpoint, "--format", "json"]
    mock = start(command, cwd=speech.root.parent)
    mock.wait_for("serving")
    running = start(speech.command)
    running.wait_for("state idle 0")
    assert running.output.count("opened False") == 3
    mock.wait_for('"method": "state"')
    told = [json.loads(line) for line in mock.output.splitlines() if line.startswith("{")]
    assert [(one["method"], one["arguments"], one["results"]) for one in told] == [
        *(("open", {"width": float(width)}, {"returns": False}) for width in (1, 2, 3)),
        ("state", {}, {"mode": "idle", "turns": 0}),
    ]


def test_topics_are_published_at_a_rate(build: Build, start: Start, icestorm: Storm) -> None:
    script = "topics:\n  Opened: {rate: 50, messages: [{wide: {width: 2.5}}, {shut: }]}\n"
    built = build({
        "Mouth.idsl.yaml": MOUTH, "r.mock.yaml": script,
        "ear/ear.cdsl.yaml": "component: Ear\nlanguage: python\nimports: [../Mouth]\nsubscribes: [Opened]\n",
    })  # fmt: skip
    ear = built["Ear"]
    (ear.root / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\n\nclass SpecificWorker(GenericWorker):\n"
        "    def initialize(self):\n        self.heard = []\n\n"
        "    def Opened_wide(self, width):\n        self.heard.append(width)\n        self.tell()\n\n"
        "    def Opened_shut(self):\n        self.heard.append('shut')\n        self.tell()\n\n"
        "    def tell(self):\n        if len(self.heard) == 20:\n"
        "            print('heard', *sorted(map(str, set(self.heard))))\n"
    )
    ear.configure({"TopicManager.Proxy": icestorm.manager})
    hearing = start(ear.command)
    hearing.wait_for("Ear is running")
    mock = start([*RCYAML, "mock", "--script", "r.mock.yaml", "--storm", icestorm.manager], cwd=ear.root.parent)
    hearing.wait_for("heard 2.5 shut")
    mock.wait_for("published Opened.shut()")


@pytest.mark.parametrize(
    ("args", "code", "told"),
    [
        ([], 2, "name the interfaces to stand in for"),
        (["Muoth"], 2, "did you mean 'Mouth'?"),
        (["Mouth", "--endpoint", "Mouth"], 2, "'Mouth' is not NAME=ENDPOINT"),
        (["Mouth", "--endpoint", "Mout=tcp -p 3"], 2, "this mock has no interface 'Mout'; did you mean 'Mouth'?"),
        (["Mouth", "--endpoint", "Mouth=tcp -q 3"], 2, "Mouth cannot be served at 'tcp -q 3'"),
        (["--script", "nowhere.mock.yaml"], 2, "nowhere.mock.yaml"),
        (["--script", "bad.mock.yaml"], 1, "'width' is missing"),
        (["--script", "broken.mock.yaml"], 1, "RC0101"),
        (["Opened", "--storm", "IceStorm/TopicManager:tcp -h localhost -p 1"], 2, "does not answer"),
    ],
)
def test_what_cannot_be_served(start: Start, tmp_path: Path, args: list[str], code: int, told: str) -> None:
    bad = "topics:\n  Opened: {messages: [{wide: {}}]}\n"
    write_tree(tmp_path, {"Mouth.idsl.yaml": MOUTH, "bad.mock.yaml": bad, "broken.mock.yaml": "a: {"})
    run = start([*RCYAML, "mock", *args], cwd=tmp_path)
    assert run.process.wait(60) == code
    run.wait_for(told)
