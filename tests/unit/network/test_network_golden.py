"""A network with everything in it: each process and each configuration."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from deployments import deployed, network

ROBOT = """\
hosts:
  onboard: {address: 10.0.0.2}
  head: {address: 10.0.0.3, user: robocomp}
services:
  storm: {icestorm: {host: onboard}}
components:
  speech:
    component: speech
    host: onboard
    port: 10001
    config: etc/config.yaml
    topics: {Heard: robot1/Heard}
    set: {volume: 70, "motors[1].vel": 1}
    restart: always
    ready: {within: 20 s}
  mouth: {component: mouth, host: head, ports: {Mouth: 10002, CommonBehavior: 10003}}
  mind{i}: {component: mind, host: head, instances: 2, config: etc/config, topics: {Heard: robot1/Heard}}
  laser: {program: rcis, args: [simulation.xml], host: head, endpoints: {Laser: tcp -p 10004}, config-as: --Ice.Config}
  base: {process: laser, endpoints: {DifferentialRobot: tcp -p 10005}}
groups:
  face: {components: [mouth], expose: {Mouth: {member: mouth, allow: [moveTo]}}}
"""
FILES = {
    "speech": "implements: [Speech]\nrequires: [Mouth]\npublishes: [Heard]\n",
    "mind": "subscribes: [Heard]\n",
    "speech/speech.pdsl.yaml": (
        "component: speech.cdsl.yaml\ntypes:\n  Motor: {struct: {vel: {type: float, default: 0.9}}}\nparameters:\n"
        "  volume: {type: int, range: [0, 100], default: 50}\n  motors: {list: Motor, default: [{}, {}]}\n"
    ),
    "speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nice: {Warn.Connections: '1'}\n",
    "mind/etc/config": "# carried over\nDepth = 3\nPeriod.Compute = 100\n",
}


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_everything_at_once(golden: Callable[[str, Mapping[str, str]], None]) -> None:
    found = network(deployed(ROBOT, **FILES))
    here = str(Path.cwd())
    files = {}
    lines = []
    for process in found.processes.values():
        lines.append(f"{process.name} on {process.host}: {' '.join(process.command)}")
        lines += [
            f"  serves {one.module or '-'} {one.interface} as {one.identity or '-'} at {one.text}"
            for one in process.endpoints
        ]
        lines += [f"  after {name}" for name in process.after]
        lines += [f"  ready when {ping} answers" for ping in process.ready.pings]
        lines.append(f"  restart {process.restart.policy}, ready within {process.ready.within:g} s")
        if process.config and process.name != "face.gate":
            files[process.config.path] = process.config.text
    for line in found.connections:
        arrow = "publishes" if line.is_out else "hears" if line.topic else "calls"
        lines.append(f"{line.source} {arrow} {line.topic or line.interface} by {line.port}: {line.target} {line.proxy}")
    lines += [f"wave {number}: {' '.join(wave)}" for number, wave in enumerate(found.order, 1)]
    files["network"] = "".join(f"{line}\n" for line in lines)
    golden("network", {path: text.replace(here, "HERE") for path, text in files.items()})
