"""Components in C++ in a deployment with `security: tls`: they serve, call, publish and subscribe over TLS, are watched
and controlled over it, and answer nobody without a certificate."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

import control_client
from conftest import ROOT, write_tree
from cpp_programs import Programs, needs_cpp
from processes import Ports, kill_left, until
from robocomp_yaml.deploy import registered
from robocomp_yaml.deploy.authority import properties

pytest.importorskip("Ice", reason="Ice's Python module is not installed")
pytestmark = [
    pytest.mark.slow,
    needs_cpp,
    pytest.mark.skipif(shutil.which("icebox") is None, reason="icebox is not installed (Debian: zeroc-icebox)"),
]
Rcyaml = Callable[..., Result]
NETWORK = """\
deployment: Robot
security: tls
alive: {{every: 500 ms, within: 5 s}}
services: {{storm: {{icestorm: {{port: {storm}, publish: {publish}}}}}}}
components:
  server: {{component: "{server}", ports: {{Arm: {arm}, Hand: {hand}, CommonBehavior: {behavior}}}}}
  client: {{component: "{client}", ports: {{CommonBehavior: {client_behavior}}}}}
  radio: {{component: "{radio}", ports: {{CommonBehavior: {radio_behavior}}}}}
  second: {{component: "{radio}", ports: {{CommonBehavior: {second_behavior}}}, after: [radio]}}
"""
SLICE = ROOT / "templates" / "slice" / "CommonBehavior.ice"


@dataclass(frozen=True)
class Robot:
    """`interfaces` is the folder of the imports, `folder` that of the deployment."""

    rcyaml: Rcyaml
    ports: dict[str, int]
    interfaces: str
    folder: str

    def deploy(self, command: str, *words: str) -> Result:
        return self.rcyaml("deploy", command, "robot.ddsl.yaml", *words, "-I", self.interfaces)

    def own(self, *words: str) -> str:
        """What a command says that talks to a component."""
        return self.rcyaml(*words, "--deployment", "robot.ddsl.yaml", "-I", self.interfaces).output

    def status(self, name: str) -> dict[str, Any]:
        (process,) = json.loads(self.deploy("status", name, "--format", "json").stdout)["processes"]
        return dict(process)

    def log(self, name: str) -> str:
        return self.deploy("logs", name, "-n", "1000").stdout


@pytest.fixture
def robot(
    programs: Programs, free_port: Ports, rcyaml: Rcyaml, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Robot]:
    """A network that runs: a server, its client, and two publishers, of which the first hears the second."""
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    names = ("storm", "publish", "arm", "hand", "behavior", "client_behavior", "radio_behavior", "second_behavior")
    ports = {name: free_port() for name in names}
    roots = {name.lower(): str(programs(name).root) for name in ("Server", "Client", "Radio")}
    write_tree(tmp_path, {"robot.ddsl.yaml": NETWORK.format(**ports, **roots)})
    robot = Robot(rcyaml, ports, str(programs("Server").root.parent), f"{tmp_path}/.rcyaml/deployments/Robot")
    try:
        up = robot.deploy("up")
        assert up.exit_code == 0, up.output
        yield robot
    finally:
        robot.deploy("down")
        kill_left(robot.folder)


def test_components_in_cpp_over_tls(robot: Robot) -> None:
    until(lambda: "grasp cba" in robot.log("client"), lambda: robot.log("client"))
    until(lambda: "moved to 4 right" in robot.log("radio"), lambda: robot.log("radio"))

    # The own commands have certificate and token; nobody else gets an answer, but with a certificate.
    assert "returns:" in robot.own("call", "server.Arm.state")
    assert "period.compute = 90" in robot.own("param", "set", "server", "period.compute", "90")
    certificate = properties(f"{registered.authority(robot.folder)}/commands.pem")
    plugin = {"Ice.Plugin.IceSSL": "IceSSL:createIceSSL", "IceSSL.VerifyPeer": "0"}
    for name in ("behavior", "client_behavior", "radio_behavior"):
        port = robot.ports[name]
        assert call("ssl", port, "getPeriod", plugin).startswith("failed")
        assert call("tcp", port, "getPeriod", {}).startswith("failed")
        assert call("ssl", port, "getPeriod", certificate).startswith("ok")
        assert "token of its deployment" in call("ssl", port, "killYourSelf", certificate)

    # One that hangs is noticed over TLS, and the others call the new one.
    before = robot.status("server")["pid"]
    os.kill(before, signal.SIGSTOP)

    def is_back() -> bool:
        now = robot.status("server")
        return bool(now["ready"]) and now["pid"] != before

    until(is_back, lambda: robot.log("server"))
    assert "not alive: it does not answer" in robot.log("server")
    assert robot.status("radio")["restarts"] == 0 == robot.status("client")["restarts"]
    assert "returns:" in robot.own("call", "server.Arm.state")


def call(protocol: str, port: int, operation: str, tls: dict[str, str]) -> str:
    """What comes of a call by a client of its own."""
    proxy = f"commonbehavior:{protocol} -h 127.0.0.1 -p {port}"
    command = [sys.executable, control_client.__file__, str(SLICE), proxy, operation, ""]
    command += [f"{key}={value}" for key, value in tls.items()]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
