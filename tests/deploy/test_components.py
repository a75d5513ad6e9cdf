"""Generated components, compiled and deployed: they are ready when they answer over Ice, and call each other."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import ROOT
from processes import Ports, until
from robocomp_yaml.deploy import ice_ping
from seen import status
from small_networks import Place

pytest.importorskip("Ice", reason="Ice's Python module is not installed")

Rcyaml = Callable[..., Result]

DOCUMENT = """\
deployment: Robot
components:
  speech: {{component: talkinghead/components/speech, port: {speech}}}
  mouth: {{component: talkinghead/components/mouth, port: {mouth}}}
  motors: {{component: jointmotor/python, port: {motors}, set: {{"motors[0].vel": {velocity}}}}}
"""


@pytest.mark.slow
def test_the_network_of_the_paper(
    place: Place, tmp_path: Path, rcyaml: Rcyaml, free_port: Ports, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    shutil.copytree(ROOT / "examples", tmp_path, dirs_exist_ok=True)
    (tmp_path / "head.ddsl.yaml").unlink()
    ports = {name: free_port() for name in ("speech", "mouth", "motors")}

    def write(velocity: str) -> None:
        text = DOCUMENT.format(**ports, velocity=velocity)
        (tmp_path / "robot.ddsl.yaml").write_text(text, encoding="utf-8")

    write("0.5")
    assert rcyaml("migrate", "talkinghead").exit_code == 0
    assert rcyaml("compile", ".").exit_code == 0
    up = rcyaml("deploy", "up", "robot.ddsl.yaml")
    assert up.exit_code == 0, up.output
    # Speech requires Mouth, which therefore starts first.
    assert up.stdout.index("mouth   ready") < up.stdout.index("speech  ready")

    before = place.pids()
    write("0.75")
    said = rcyaml("deploy", "plan", "robot.ddsl.yaml").stdout
    # The values of one motor are one property of this component.
    change = "dunker0,A,true,-3.14,3.14,0,0.5 → dunker0,A,true,-3.14,3.14,0,0.75"
    assert said == f"~ motors  restart: config JointMotor.M0: {change}\n1 to restart, 2 to keep\n"
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
    after = place.pids()
    assert {name for name in before if before[name] != after[name]} == {"motors"}

    os.kill(after["mouth"], signal.SIGKILL)

    def is_back() -> bool:
        mouth = status(rcyaml, place.folder, "robot.ddsl.yaml", is_ice=True)["mouth"]
        return mouth["ready"] and mouth["restarts"] == 1 and mouth["pid"] != after["mouth"]

    until(is_back, "mouth answers again")
    assert place.pids()["speech"] == before["speech"]
    _pings(ports["mouth"])
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0
    place.wait_gone()


def _pings(port: int) -> None:
    """Pings of real servers."""

    def answers(proxy: str) -> bool:
        return asyncio.run(ice_ping.answers(proxy, 5))

    assert answers(f"mouth:tcp -h 127.0.0.1 -p {port}") and answers(f"mouth -t:default -h localhost -p {port} -t 1000")
    assert not answers(f"nobody:tcp -h 127.0.0.1 -p {port}")
    assert not answers(f"category/mouth:tcp -h 127.0.0.1 -p {port}")
    assert not answers("mouth:tcp -h 127.0.0.1 -p 1")
    # Without plain TCP, the Ice runtime pings.
    assert answers(f"mouth:udp -h 127.0.0.1 -p 1:tcp -h 127.0.0.1 -p {port}")
    assert not answers(f"nobody:udp -h 127.0.0.1 -p 1:tcp -h 127.0.0.1 -p {port}")
