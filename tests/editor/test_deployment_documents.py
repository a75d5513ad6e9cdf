"""Deployments in the editor: completion, messages and hovers at each construct."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from editor.proposals import assert_can_stand_there
from editor.workbench import Workbench
from robocomp_yaml.source.schema_text import schema_text

D = "deployment: A\n"
E = D + "components:\n  a:\n    component: b\n    "
P = D + "components:\n  a:\n    program: b\n    "
IN_ENTRY = [
    "connect: {…}",
    "set: {…}",
    "ready: 10 s",
    "restart: …",
    "alive: …",
    "component",
    "program",
    "process",
    "doc",
    "host",
    "executable",
    "args",
    "cwd",
    "env",
    "port",
    "ports",
    "config",
    "config-as",
    "connect",
    "topics",
    "set",
    "endpoints",
    "restart",
    "ready",
    "role",
    "alive",
    "listen",
    "limits",
    "after",
    "enabled",
    "instances",
]
COMPLETIONS = [
    ("|", ["deployment document", "hosts: …", "services: …", "components: …", "groups: …", "include: […]", "deployment",
           "doc", "hosts", "services", "ports", "components", "alive", "control", "security", "limits", "groups", "include"]),
    (D + "ports: |", ["range of ports"]),
    ("deployment: |", ["for example ShellyHead"]),
    (D + "hosts: |", ["host", "host of another user"]),
    (D + "hosts:\n  |", ["host", "host of another user"]),
    (D + "hosts:\n  a: |", ["address", "address and user"]),
    (D + "hosts: {a: {u|}}", ["address", "user", "listen", "path", "env", "python", "ssh", "limits", "systemd", "doc"]),
    (D + "hosts: {a: {address: b, listen: |}}", ["any", "address", "several addresses"]),
    (D + "control: |", ["token", "open"]),
    (D + "security: |", ["tls", "none"]),
    (D + "services: |", ["IceStorm"]),
    (D + "services:\n  storm: |", ["an IceStorm"]),
    (D + "services: {storm: {icestorm: |}}", ["port", "host and port"]),
    (D + "components: |", ["component", "program", "several instances"]),
    (D + "components:\n  |", ["component", "program", "several instances"]),
    (D + "components:\n  a: |", ["a component", "a program", "several instances", "a second name of a process"]),
    (D + "components:\n  a:\n    |", IN_ENTRY),
    (D + "components:\n  a: {c|}", IN_ENTRY),
    (E + "args: |", ["list of arguments"]),
    (E + "env: |", ["variable", "variable from outside"]),
    (E + "env:\n      X: |", ["text", "from outside", "from a file"]),
    (E + "ports: |", ["port"]),
    (E + "connect: |", ["connection"]),
    (E + "topics: |", ["topic"]),
    (E + "set: |", ["value"]),
    (E + "restart: |", ["on-failure", "always", "no", "with limits"]),
    (E + "restart: {p|}", ["policy", "delay", "tries", "within"]),
    (E + "restart: {policy: |}", ['"no"', "on-failure", "always"]),
    (E + "ready: |", ["time", "port", "ping", "command", "log"]),
    (E + "ready: {p|}", ["within", "port", "ping", "command", "log"]),
    (E + "ready: {command: |}", ["command"]),
    (E + "limits: |", ["memory and priority", "real time"]),
    (D + "limits: |", ["memory and priority", "real time"]),
    (D + "hosts: {a: {address: b, ssh: |}}", ["user and port", "jump host"]),
    (D + "hosts: {a: {address: b, systemd: |}}", ["user", "system"]),
    (E + "alive: |", ["off", "on", "with times"]),
    (E + "alive: {e|}", ["every", "within", "misses", "then", "worker"]),
    (E + "alive: {then: |}", ["restart", "tell"]),
    (D + "alive: |", ["off", "on", "with times"]),
    (E + "after: |", ["list of names"]),
    (E + "enabled: |", ["false", "true"]),
    (P + "endpoints: |", ["endpoint"]),
    (P + "config-as: |", ["argument", "an option"]),
    (D + "groups: |", ["group", "group that acts as one component", "deployment as a group"]),
    (D + "groups:\n  a: |", ["members", "as one component", "another deployment"]),
    (D + "groups:\n  a: {c|}", ["components", "include", "as", "expose", "host", "doc"]),
    (D + "groups:\n  a: {components: |}", ["list of entries"]),
    (D + "groups:\n  a: {expose: |}", ["interface", "interface with a rate", "interface with some methods"]),
    (D + "groups:\n  a: {expose: {Speech: |}}", ["member", "with a rate", "with some methods"]),
    (D + "groups:\n  a: {expose: {Speech: {m|}}}", ["member", "rate", "allow", "doc"]),
    (D + "include: |", ["list of deployments", "deployments with names"]),
]  # fmt: skip
A_NAME = "a name consists of letters, digits, _ and -, and does not start with a digit"
TIME = "a time is milliseconds, such as 500, or has a unit, such as 500 ms or 10 s"
ONE = "an entry has one of component:, program: and process:"
MESSAGES = [
    ("- a", ["1:1 a deployment document is a mapping: deployment: Robot, and its components"]),
    ("doc: x", ["1:1 the key 'deployment' is missing"]),
    ("deployment: a b", ["1:13 deployment: is a name: letters, digits, _ and -, not starting with a digit"]),
    (D + "component: {}", ["2:1 Property component is not allowed."]),
    (D + "hosts: {a b: 10.0.0.2}", [f"2:9 {A_NAME}"]),
    (
        D + "hosts: {a: [10.0.0.2]}",
        [
            "2:12 a host's value is its address, onboard: 10.0.0.2, or a mapping, onboard: {address: 10.0.0.2, "
            "user: robot}"
        ],
    ),
    (
        D + "hosts: {a: {address: b, path: opt}}",
        ["2:31 path: is an absolute path on the host, such as /opt/robot, or {FOLDER HERE: FOLDER THERE}"],
    ),
    (
        D + "hosts: {a: {address: b, path: {.: opt}}}",
        ["2:35 a folder on a host is an absolute path, such as /opt/robot"],
    ),
    (D + "hosts: {a: {address: b, ssh: {port: 0}}}", ["2:37 a port is a whole number from 1 to 65535"]),
    (D + "limits: {memory: 512}", ["2:18 memory: is a size with a unit, such as 512 MiB"]),
    (D + "limits: {realtime: 100}", ["2:20 realtime: is a priority from 1 to 99 (first)"]),
    (D + "limits: {cores: 1-}", ["2:17 cores: are numbers of cores, such as 0-1 or 0,2"]),
    (D + "hosts: {a: {user: me}}", ["2:9 the key 'address' is missing"]),
    (D + "services: {s: icestorm}", ["2:15 a service is {icestorm: {host: onboard, port: 9999}}"]),
    (D + "services: {s: {icestorm: {port: 0}}}", ["2:33 a port is a whole number from 1 to 65535"]),
    (D + "services: {s: {icestorm: {publish: x}}}", ["2:36 a port is a whole number from 1 to 65535"]),
    (D + "ports: 12000", ["2:8 ports: is a range of TCP ports, such as {from: 12000, to: 12999}"]),
    (D + "ports: {from: 1}", ["2:1 the key 'to' is missing"]),
    (D + "ports: {to: 1}", ["2:1 the key 'from' is missing"]),
    (
        D + "ports: {from: 1, to: 1.5}",
        ["2:22 a port is a whole number from 1 to 65535"],
    ),
    (
        D + "components: [a]",
        ["2:13 components: is a mapping of names to entries, such as speech: {component: ../speech/speech.cdsl.yaml}"],
    ),
    (
        D + "components: {a: b}",
        ["2:17 an entry is a mapping, such as {component: ../speech/speech.cdsl.yaml, host: onboard}"],
    ),
    (D + "components: {a: {host: b}}", ["2:14 the key 'component' is missing (or 'program', or 'process')"]),
    (D + "components: {a: {component: b, program: c}}", [f"2:17 {ONE}"]),
    (
        D + "components: {a: {process: b, port: 1}}",
        ["2:30 a second name of a process has only endpoints:; all other keys belong to the first name"],
    ),
    (
        D + "components: {a: {program: b, set: {c: 1}}}",
        ["2:30 this key is for components; a program has args:, config: and endpoints:"],
    ),
    (E + "prot: 1", ["5:5 Property prot is not allowed."]),
    (E + "port: 70000", ["5:11 a port is a whole number from 1 to 65535"]),
    (
        E + "ports: 10001",
        ["5:12 ports: is a mapping of interfaces to ports, such as {Speech: 10001, CommonBehavior: 10002}"],
    ),
    (E + "args: -f", ['5:11 args: is a list of texts, such as [simulation.xml, -f, "100"]']),
    (
        E + "connect: {A: [b]}",
        [
            "5:18 a connection is an entry, such as mouth or mouth.Mouth, or a proxy in quotes, such as "
            '"mouth:tcp -h 10.0.0.9 -p 10002"'
        ],
    ),
    (E + "restart: no", []),
    (E + "alive: off", []),
    (E + "alive: {worker: off, every: 500, misses: 1}", []),
    (
        E + "alive: 5 s",
        ["5:12 alive: is on or off, or a mapping, such as {every: 5 s, within: 2 s, misses: 2, then: restart}"],
    ),
    (E + "alive: {worker: long}", ["5:21 worker: is a time, such as 60 s, or off"]),
    (E + "alive: {then: wait}", ["5:19 then: is restart or tell"]),
    (E + "alive: {misses: 0}", ["5:21 misses: is a whole number, at least 1"]),
    (E + "alive: {every: 0 s}", ["5:20 a time is milliseconds, such as 500, or has a unit, such as 500 ms or 10 s"]),
    (
        E + "restart: sometimes",
        [
            "5:14 restart: is no, on-failure or always, or a mapping, such as {policy: on-failure, delay: 1 s, tries: 5, "
            "within: 1 min}"
        ],
    ),
    (
        E + "ready: 10 sec",
        [
            "5:12 ready: is a time, such as 10 s, or a condition: {port: 10003, within: 10 s}, {ping: …}, {command: […]} or "
            "{log: …}"
        ],
    ),
    (E + "ready: {within: soon}", [f"5:21 {TIME}"]),
    (E + "instances: 0", ["5:16 instances: is a whole number from 1 to 10000"]),
    (E + "enabled: yes", ["5:14 enabled: is true or false"]),
    (D + "groups: {a: [b]}", ["2:13 a group is a mapping, such as {components: [speech, mouth], as: face.cdsl.yaml}"]),
    (D + "groups: {a: {components: [b], expose: {C: {rate: 1}}}}", ["2:40 the key 'member' is missing"]),
    (
        D + "groups: {a: {components: [b], expose: {C: {member: b, rate: 0}}}}",
        ["2:61 rate: is a number of calls a second, above 0"],
    ),
    (
        D + "include: arm",
        ["2:10 include: is a list of deployments, [arm.ddsl.yaml], or a mapping with names, {left: arm.ddsl.yaml}"],
    ),
]
HOVERS = [
    ("deploy|ment: A", "Deployment"),
    (D + "do|c: x", "Documentation"),
    (D + "x-m|ine: 1", "Extension"),
    (D + "hos|ts: {a: b}", "Hosts"),
    (D + "hosts: {aa|: b}", "Host's description"),
    (D + "hosts: {aa|: {address: b}}", "Host's description"),
    (D + "hosts: {a: {addr|ess: b}}", "Address"),
    (D + "hosts: {a: {address: b, us|er: c}}", "User"),
    (D + "serv|ices: {s: {icestorm: }}", "Services"),
    (D + "services: {ss|: {icestorm: }}", "Service"),
    (D + "services: {s: {ice|storm: {port: 1}}}", "IceStorm"),
    (D + "services: {s: {icestorm: {po|rt: 1}}}", "IceStorm's port"),
    (D + "services: {s: {icestorm: {pub|lish: 1}}}", "Publishers' port"),
    (D + "po|rts: {from: 1, to: 2}", "Port range"),
    (D + "ports: {fr|om: 1, to: 2}", "First port"),
    (D + "ports: {from: 1, t|o: 2}", "Last port"),
    (D + "services: {s: {icestorm: {sha|red: true}}}", "Shared"),
    (D + "compo|nents: {a: {program: b}}", "Components"),
    (D + "components: {aa|: {program: b}}", "Entry"),
    (E + "do|c: x", "Documentation"),
    (D + "components: {a: {compo|nent: b}}", "Component"),
    (D + "components: {a: {prog|ram: b}}", "Program"),
    (D + "components: {a: {proc|ess: b}}", "Process"),
    (E + "exec|utable: x", "Executable"),
    (E + "ar|gs: [x]", "Arguments"),
    (E + "args: [xx|]", "Argument"),
    (E + "cw|d: x", "Working folder"),
    (E + "en|v: {A: b}", "Environment"),
    (E + "env: {AA|: b}", "Variable"),
    (E + "env: {A: {en|v: b}}", "Variable from outside"),
    (E + "env: {A: {fi|le: b}}", "File"),
    (E + "ho|st: x", "Host"),
    (E + "po|rt: 1", "Port"),
    (E + "por|ts: {A: 1}", "Ports"),
    (E + "ports: {AA|: 1}", "Port of an interface"),
    (E + "conf|ig: x", "Configuration"),
    (E + "config|-as: argument", "How the configuration is passed"),
    (E + "conn|ect: {A: b}", "Connect"),
    (E + "connect: {AA|: b}", "Target"),
    (E + "top|ics: {A: b}", "Topics"),
    (E + "topics: {AA|: b}", "Topic's name"),
    (E + "se|t: {a: 1}", "Set"),
    (E + "endp|oints: {A: b}", "Endpoints"),
    (E + "endpoints: {AA|: b}", "Endpoint"),
    (E + "rest|art: no", "Restart"),
    (E + "rest|art: {tries: 1}", "Restart"),
    (E + "restart: {pol|icy: no}", "Policy"),
    (E + "restart: {del|ay: 1 s}", "Delay"),
    (E + "restart: {tr|ies: 1}", "Tries"),
    (E + "restart: {with|in: 1 s}", "Within"),
    (E + "ro|le: task", "Role"),
    (E + "rea|dy: 1 s", "Ready"),
    (E + "rea|dy: {log: a}", "Ready"),
    (E + "ready: {with|in: 1 s}", "Time limit"),
    (E + "ready: {po|rt: 1}", "Port of readiness"),
    (E + "ready: {pi|ng: a}", "Proxy of readiness"),
    (E + "ready: {comm|and: [a]}", "Command"),
    (E + "ready: {lo|g: a}", "Line of the log"),
    (E + "lis|ten: any", "Listen"),
    (D + "hosts: {a: {address: b, lis|ten: [address, c]}}", "Listen"),
    (D + "con|trol: open", "Control"),
    (D + "secu|rity: tls", "Security"),
    (E + "ali|ve: off", "Alive"),
    (D + "ali|ve: {misses: 1}", "Alive"),
    (E + "alive: {ev|ery: 1 s}", "Every"),
    (E + "alive: {with|in: 1 s}", "Time for an answer"),
    (E + "alive: {mis|ses: 1}", "Misses"),
    (E + "alive: {th|en: tell}", "Then"),
    (E + "alive: {work|er: off}", "Worker"),
    (E + "lim|its: {nice: 1}", "Limits"),
    (E + "limits: {mem|ory: 1 GiB}", "Memory"),
    (E + "limits: {cp|u: 50 %}", "CPU"),
    (E + "limits: {cor|es: 0}", "Cores"),
    (E + "limits: {ni|ce: 1}", "Niceness"),
    (E + "limits: {real|time: 1}", "Real-time priority"),
    (E + "limits: {cor|e: off}", "Core dumps"),
    (E + "limits: {fil|es: 100}", "Open files"),
    (D + "hosts: {a: {pa|th: /a}}", "Path on the host"),
    (D + "hosts: {a: {path: {.: /a|a}}}", "Folder on the host"),
    (D + "hosts: {a: {pyth|on: python3}}", "Python"),
    (D + "hosts: {a: {syst|emd: user}}", "Manager of systemd"),
    (D + "hosts: {a: {ss|h: {port: 1}}}", "SSH"),
    (D + "hosts: {a: {ssh: {us|er: a}}}", "User"),
    (D + "hosts: {a: {ssh: {po|rt: 1}}}", "Port of ssh"),
    (D + "hosts: {a: {ssh: {ident|ity: a}}}", "Identity"),
    (D + "hosts: {a: {ssh: {known|-hosts: a}}}", "Known hosts"),
    (D + "hosts: {a: {ssh: {ju|mp: a}}}", "Jump host"),
    (E + "aft|er: [b]", "After"),
    (E + "after: [bb|]", "Name of an entry"),
    (E + "enab|led: true", "Enabled"),
    (E + "inst|ances: 1", "Instances"),
    (D + "gro|ups: {a: {components: [b]}}", "Groups"),
    (D + "groups: {aa|: {components: [b]}}", "Group"),
    (D + "groups: {a: {compo|nents: [b]}}", "Members"),
    (D + "groups: {a: {components: [bb|]}}", "Member"),
    (D + "groups: {a: {a|s: b, components: [b]}}", "As"),
    (D + "groups: {a: {ho|st: b, include: b}}", "Host of the members"),
    (D + "groups: {a: {incl|ude: b}}", "Included deployment"),
    (D + "groups: {a: {components: [b], exp|ose: {C: b}}}", "Expose"),
    (D + "groups: {a: {components: [b], expose: {CC|: b}}}", "Exposed interface"),
    (D + "groups: {a: {components: [b], expose: {C: {member: b, ra|te: 1}}}}", "Rate"),
    (D + "groups: {a: {components: [b], expose: {C: {member: b, all|ow: [d]}}}}", "Allow"),
    (D + "groups: {a: {components: [b], expose: {C: {member: b, allow: [dd|]}}}}", "Method"),
    (D + "incl|ude: [a]", "Include"),
    (D + "include: [aa|]", "Included deployment"),
]


@pytest.mark.parametrize(("text", "labels"), COMPLETIONS)
def test_a_deployment_is_completed(editor: Workbench, text: str, labels: list[str]) -> None:
    proposals = editor.complete("ddsl", text)
    assert [proposal.label for proposal in proposals] == labels
    assert_can_stand_there("ddsl", text, proposals)


def test_one_message_for_each_fault(editor: Workbench) -> None:
    assert editor.messages("ddsl", [text for text, _ in MESSAGES]) == [messages for _, messages in MESSAGES]


def test_a_right_document_has_none(editor: Workbench) -> None:
    text = (Path(__file__).parent / "documents" / "robot.ddsl.yaml").read_text(encoding="utf-8")
    assert editor.messages("ddsl", [text]) == [[]]


@pytest.fixture(scope="module")
def texts() -> dict[str, set[str]]:
    """The Markdown of each construct, by its title."""
    found: dict[str, set[str]] = {}

    def collect(part: Any) -> None:
        if isinstance(part, dict):
            if isinstance(part.get("title"), str):
                found.setdefault(part["title"], set()).add(part["markdownDescription"])
            for value in part.values():
                collect(value)
        elif isinstance(part, list):
            for value in part:
                collect(value)

    collect(json.loads(schema_text("ddsl")))
    return found


@pytest.mark.parametrize(("text", "title"), HOVERS, ids=lambda value: repr(value))
def test_the_construct_explains_itself(editor: Workbench, texts: dict[str, set[str]], text: str, title: str) -> None:
    shown = editor.hover("ddsl", text)
    [expected] = texts[title]
    assert shown.startswith(f"#### {title}\n\n{expected}\n"), shown
    assert shown.count(expected) == 1


def test_every_construct_is_here(texts: dict[str, set[str]]) -> None:
    assert texts.keys() - {"DDSL document"} == {title for _, title in HOVERS}
