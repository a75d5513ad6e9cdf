"""Derived networks: every process with its command, ports, configuration and order, and its location in the
document."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from deployments import FACE, component
from in_memory import ROOT, analysed, outline, plain

SPEECH = "implements: [Speech]\nrequires: [Mouth, Eye: {interface: Mouth, absent: ignore}]\npublishes: [Heard]\n"
MOUTH = "implements: [Mouth]\nsubscribes: [Heard]\nparameters: mouth.pdsl.yaml\n"
ARM = """\
deployment: Arm
components:
  elbow: {component: mouth}
  hand: {component: speech, connect: {Mouth: elbow, Eye: "mouth:tcp -h 10.0.0.9 -p 1"}, topics: {Heard: said}}
"""
FILES = {
    "Face.idsl.yaml": FACE,
    "speech/speech.cdsl.yaml": component("SpeechComp", SPEECH),
    "mouth/mouth.cdsl.yaml": component("MouthComp", MOUTH).replace("python", "cpp"),
    "mouth/mouth.pdsl.yaml": "parameters:\n  lips: {type: int, default: 2}\n  wifi: {type: string, secret: true, optional: true}\n",
    "mouth/etc/config.yaml": "parameters: {lips: 3}\nice: {Warn.Connections: 1}\nendpoints: {Mouth: tcp -p 10050}\n",
    "arm.ddsl.yaml": ARM,
    "speech/classic.conf": (
        "# old\nSpeech.Endpoints=tcp -p 10300\nMouthProxy=mouth:tcp -p 1\nHeard=Heard\nTopicManager.Proxy=x:tcp -p 2\nn=1\n"
    ),
    "speech/flat.conf": (
        'Endpoints.Speech="tcp -p 10301"\nProxies.Mouth="mouth:tcp -p 1"\nProxies.HeardPubPrefix="robot1"\nn=1\n'
    ),
    "speech/own.conf": "EyeProxy=mouth:tcp -h 10.0.0.9 -p 4\nProxies.HeardPubPrefix=robot1\nPeriod.Compute=7\n",
    "speech/v.config.yaml": (
        "endpoints: {Speech: tcp -p 10302}\nproxies: {Mouth: {proxy: 'mouth:tcp -p 1', key: Lips}}\n"
        "topics: {prefix: {HeardPub: robot1}}\n"
    ),
    "tool.conf": "a=1\nMouthProxy=mouth:tcp -p 5\n",
    "rcyaml.yaml": "lint: {RC4403: 'off', RC4404: 'off'}\n",
}

CASES = {
    "one machine": """\
services: {storm: {icestorm: {}}}
components:
  speech: {component: speech, connect: {Eye: mouth}}
  mouth: {component: mouth, set: {lips: 4, wifi: {env: WIFI}}, env: {A: b, C: {env: D}, E: {file: keys/e}}, restart: always}
""",
    "hosts": """\
hosts: {onboard: 10.0.0.2, head: {address: fd00::3, user: pi}}
services: {storm: {icestorm: {host: head, port: 9900}}}
components:
  speech: {component: speech, host: onboard, connect: {Mouth: listener, Eye: mouth}, topics: {Heard: other}, ready: {within: 3 s, log: "^up"}}
  mouth: {component: mouth, host: head, port: 10002, restart: {policy: "no"}, topics: {Heard: other}}
  listener: {component: mouth, host: onboard, ports: {Mouth: 10009, CommonBehavior: 11009}, topics: {Heard: other}}
  late: {component: mouth, host: head, enabled: false, topics: {Heard: other}}
""",
    "instances, programs and second names": """\
services: {storm: {icestorm: {}}}
components:
  "mouth{i}": {component: mouth, instances: 2, port: 10100, args: ["--number={i}"], set: {lips: "{i}"}}
  speech: {component: speech, connect: {Mouth: mouth0, Eye: mouth1}, after: [tool, "mouth{i}"]}
  tool: {program: ./tool, cwd: bin, args: [-v, "{config}"], config: ../tool.conf, ready: {command: ask --it, within: 2 s}}
  viewer: {program: viewer, config-as: --Ice.Config, connect: {Lips: mouth0.Mouth}, endpoints: {Speech: tcp -p 12000}, after: [storm]}
  second: {process: viewer, endpoints: {Laser: tcp -p 12001}}
  x: {program: sh, executable: bin/sh, x-rcmanager: {x: 1.50}}
x-rcmanager: {general: {editor: vim}}
""".replace(', set: {lips: "{i}"}', "").replace(", executable: bin/sh", ""),
    "groups and gates": """\
services: {storm: {icestorm: {}}}
components:
  speech: {component: speech, connect: {Mouth: lips, Eye: face.Mouth}}
  mouth: {component: mouth, after: [storm]}
  other: {component: mouth, port: 10051}
groups:
  lips: {components: [mouth], expose: {Mouth: {member: mouth, rate: 5, allow: [moveTo]}}}
  face: {components: [other], expose: {Mouth: other}}
""",
    "old configurations": """\
services: {storm: {icestorm: {}}}
components:
  classic: {component: speech, config: classic.conf, connect: {Mouth: mouth, Eye: mouth}, topics: {Heard: said}, port: 10200}
  flat: {component: speech, config: flat.conf, connect: {Mouth: mouth, Eye: mouth}, topics: {Heard: said}}
  own: {component: speech, config: own.conf, connect: {Mouth: mouth, Eye: "mouth:tcp -h 10.0.0.9 -p 4"}}
  values: {component: speech, config: v.config.yaml, connect: {Mouth: mouth, Eye: mouth}, topics: {Heard: said}}
  mouth: {component: mouth, topics: {Heard: said}}
  hears: {component: mouth, port: 10051, topics: {Heard: robot1/Heard}}
""",
    "includes": """\
hosts: {onboard: 10.0.0.2, head: 10.0.0.3}
services: {storm: {icestorm: {host: head}}}
groups:
  left: {include: arm.ddsl.yaml, host: onboard}
  right: {include: arm.ddsl.yaml, host: head, expose: {Mouth: elbow}}
components:
  speech: {component: speech, host: onboard, connect: {Mouth: right, Eye: left.elbow}, after: [left, right]}
""",
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_network(name: str, golden: Callable[[str, Mapping[str, str]], None]) -> None:
    documents = {**FILES, "robot.ddsl.yaml": f"deployment: Robot\n{CASES[name]}"}
    analysis = analysed(documents, "robot.ddsl.yaml")
    assert not analysis.diagnostics, [(one.code, one.message) for one in analysis.diagnostics]
    network = analysis.networks[f"{ROOT}/robot.ddsl.yaml"]
    lines = [line for one in network.processes.values() for line in outline("process", one, documents)]
    lines += [line for one in network.connections for line in outline("connection", one, documents)]
    lines += [line for one in network.hosts.values() for line in outline("host", one, documents)]
    lines += [f"order: {wave}" for wave in network.order] + [f"extra: {network.extra}", f"folder: {network.folder}"]
    lines = [line if len(line) < 1200 else f"{line[:600]} …" for line in lines]  # the program of a gate
    golden(f"networks/{name.replace(' ', '-').replace(',', '')}", {"network.txt": plain("\n".join(lines) + "\n")})
