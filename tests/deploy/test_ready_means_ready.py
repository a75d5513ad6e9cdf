"""A component is ready when it runs: not while it waits for another one, and not in `initialize()`."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

from processes import Ports, until
from robocomp_yaml.network.network import Process, Readiness
from seen import status
from small_networks import Place

pytest.importorskip("Ice", reason="Ice's Python module is not installed")

Rcyaml = Callable[..., Result]
Light = Callable[[int], None]
INTERFACE = "module: RoboCompLamp\ninterfaces: {Lamp: {methods: {light: {}}}}\n"
SERVER = """\
import sys
import Ice
with Ice.initialize() as ice:
    adapter = ice.createObjectAdapterWithEndpoints("Lamp", f"tcp -h 127.0.0.1 -p {sys.argv[1]}")
    adapter.add(type("Lamp", (Ice.Object,), {})(), ice.stringToIdentity(sys.argv[2]))
    adapter.activate()
    ice.waitForShutdown()
"""


@pytest.fixture
def light() -> Iterator[Light]:
    """`light(port)`: something answers there."""
    started: list[subprocess.Popen[bytes]] = []
    yield lambda port: started.append(subprocess.Popen([sys.executable, "-c", SERVER, str(port), "lamp"]))
    for process in started:
        process.kill()
        process.wait()


@pytest.fixture
def switch(tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> Callable[[str, int], None]:
    """`switch(body of initialize(), port of the lamp)`: a deployment with a component that requires a lamp, and one
    that requires the switch."""
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    (tmp_path / "Lamp.idsl.yaml").write_text(INTERFACE)
    for name, more in (("switch", "implements: [Lamp]\nrequires: [{Bulb: Lamp}]"), ("user", "requires: [Lamp]")):
        (tmp_path / name).mkdir()
        document = f"component: {name.title()}\nlanguage: python\nimports: [../Lamp]\n{more}\n"
        (tmp_path / name / f"{name}.cdsl.yaml").write_text(document)
    assert rcyaml("compile", ".").exit_code == 0

    def write(body: str, lamp: int) -> None:
        code = (
            "from generated.genericworker import GenericWorker\nimport time\n\n\nclass SpecificWorker(GenericWorker):\n"
        )
        (tmp_path / "switch" / "src" / "specificworker.py").write_text(
            f"{code}    def initialize(self):\n        {body}\n"
        )
        (tmp_path / "robot.ddsl.yaml").write_text(
            f'deployment: Robot\ncomponents:\n  switch: {{component: switch, ready: 4 s, restart: "no", '
            f'connect: {{Bulb: "lamp:tcp -h 127.0.0.1 -p {lamp}"}}}}\n  user: {{component: user, connect: {{Lamp: switch}}}}\n'
        )

    return write


def own(rcyaml: Rcyaml, name: str) -> dict[str, Any]:
    return status(rcyaml, f"{os.getcwd()}/.rcyaml/deployments/Robot", "robot.ddsl.yaml", is_ice=True)[name]


def test_it_waits_for_an_absent_server(
    place: Place, rcyaml: Rcyaml, switch: Callable[[str, int], None], free_port: Ports, light: Light
) -> None:
    lamp = free_port()
    switch("pass", lamp)
    up = rcyaml("deploy", "up", "robot.ddsl.yaml", "--on-failure", "keep")
    assert up.exit_code == 1
    waiting = f"waiting for Bulb at 127.0.0.1:{lamp}"
    assert f"'switch' was not ready within 4 s: it is {waiting} (connection refused)" in up.stderr
    assert not place.pids()["user"], "what needs it is not started"
    assert waiting in rcyaml("deploy", "status", "robot.ddsl.yaml").stdout
    found = own(rcyaml, "switch")
    assert not found["ready"] and found["own"]["waits_for"] == "Bulb" and found["own"]["state"] == "waiting"

    light(lamp)
    until(lambda: own(rcyaml, "switch")["ready"], "the lamp")
    assert own(rcyaml, "switch")["own"]["state"] == "running"
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
    assert own(rcyaml, "user")["ready"]
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0


def test_it_raises_after_a_sleep(
    rcyaml: Rcyaml, switch: Callable[[str, int], None], free_port: Ports, light: Light
) -> None:
    lamp = free_port()
    light(lamp)
    switch("time.sleep(1.5); raise ValueError('no device')", lamp)
    up = rcyaml("deploy", "up", "robot.ddsl.yaml")
    assert up.exit_code == 1 and "ready" not in up.stdout, up.stdout
    assert "ValueError: no device" in up.stderr


def test_it_is_long_in_initialize(
    rcyaml: Rcyaml, switch: Callable[[str, int], None], free_port: Ports, light: Light
) -> None:
    lamp = free_port()
    light(lamp)
    switch("time.sleep(60)", lamp)
    up = rcyaml("deploy", "up", "robot.ddsl.yaml", "--on-failure", "keep")
    assert up.exit_code == 1
    assert "'switch' was not ready within 4 s: it is starting: in initialize() for" in up.stderr
    assert "in initialize() for" in rcyaml("deploy", "status", "robot.ddsl.yaml").stdout
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0


def test_components_of_an_earlier_version_answer_pings(place: Place, free_port: Ports) -> None:
    """Their CommonBehavior has no facet."""
    port = free_port()
    proxy = f"commonbehavior:tcp -h 127.0.0.1 -p {port}"
    command = (sys.executable, "-c", SERVER, str(port), "commonbehavior")
    old = Process("old", "localhost", command, "/tmp", ready=Readiness(pings=(proxy,), within=20), introspection=proxy)
    assert place.up(old).diagnostics == []

    found = place.status(old)["old"]
    assert found.is_ready and found.own is None
    assert place.down() == ["old"]


def test_two_that_wait_for_each_other(tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    (tmp_path / "Talk.idsl.yaml").write_text(
        "module: RoboCompTalk\ninterfaces: {Ear: {methods: {hear: {}}}, Voice: {methods: {say: {}}}}\n"
    )
    for name, serves, needs in (("ear", "Ear", "Voice"), ("voice", "Voice", "Ear")):
        (tmp_path / name).mkdir()
        document = f"component: {serves}Comp\nlanguage: python\nimports: [../Talk]\nimplements: [{serves}]\n"
        (tmp_path / name / f"{name}.cdsl.yaml").write_text(f"{document}requires: [{needs}]\n")
    (tmp_path / "robot.ddsl.yaml").write_text(
        "deployment: Robot\ncomponents: {ear: {component: ear, ready: 20 s}, voice: {component: voice, ready: 20 s}}\n"
    )
    assert rcyaml("compile", ".").exit_code == 0
    try:
        up = rcyaml("deploy", "up", "robot.ddsl.yaml")
        assert up.exit_code == 0 and "RC4401" in up.output, up.output
        again = rcyaml("deploy", "restart", "robot.ddsl.yaml")
        assert again.exit_code == 0, again.output
        assert rcyaml("deploy", "status", "robot.ddsl.yaml").exit_code == 0
    finally:
        rcyaml("deploy", "down", "robot.ddsl.yaml")
