"""One cause gives one diagnostic: parts that depend on a wrong one are not checked."""

from __future__ import annotations

import pytest

from deployments import FACE, component, deployed
from in_memory import said

C = "component: C\nlanguage: python\n"
V = "component: c.cdsl.yaml\n"
TWO = "components: {speech: {component: speech}, mouth: {component: mouth}}\n"


def comp(pdsl: str, values: str = "", **more: str) -> dict[str, str]:
    """A component with its parameters and values; `b__config__yaml` is another document."""
    documents = {"c.cdsl.yaml": C, "c.pdsl.yaml": f"component: c.cdsl.yaml\n{pdsl}"}
    if values:
        documents["c.config.yaml"] = V + values
    return {**documents, **{name.replace("__", "."): text for name, text in more.items()}}


def dep(text: str, **others: str) -> dict[str, str]:
    documents = {name: str(content) for name, content in deployed(text, **others).items()}
    return {**documents, "rcyaml.yaml": "lint: {RC4403: 'off'}\n"}


CASES: dict[str, tuple[tuple[str, str, str], dict[str, str]]] = {
    "a type that is not there, and values of it": (
        ("RC3103", "c.pdsl.yaml", "itn"),
        comp("parameters: {a: itn, b: int}\n", "parameters: {a: x, b: 1}\n"),
    ),
    "a type that holds itself, and values of it": (
        ("RC3104", "c.pdsl.yaml", "T"),
        comp("types: {T: {list: T}}\nparameters: {a: T, b: {list: T}}\n", "parameters: {a: [1], b: 5}\n"),
    ),
    "limits that leave nothing, and values": (
        ("RC3109", "c.pdsl.yaml", "[3, 2]"),
        comp("parameters: {a: {type: int, range: [3, 2]}}\n", "parameters: {a: 9}\n"),
    ),
    "a bad default, and values": (
        ("RC3113", "c.pdsl.yaml", "x"),
        comp("parameters: {a: {type: int, default: x}, b: int}\n", "parameters: {b: 1}\n"),
    ),
    "parameters that are no YAML, and values of them": (
        ("RC0101", "c.pdsl.yaml", ""),
        comp("parameters: [\n", "parameters: {a: x}\n"),
    ),
    "parameters of the wrong shape, and values of them": (
        ("RC0202", "c.pdsl.yaml", "rnage"),
        comp("parameters: {a: {type: int, rnage: [0, 1]}}\n", "parameters: {a: x}\n"),
    ),
    "a component that is no YAML, its parameters and its values": (
        ("RC0101", "c.cdsl.yaml", ""),
        {**comp("parameters: {a: int}\n", "parameters: {a: 1}\n"), "c.cdsl.yaml": "component: [\n"},
    ),
    "a component without a language, its parameters and values": (
        ("RC0203", "c.cdsl.yaml", "component"),
        {**comp("parameters: {a: int}\n", "parameters: {a: 1}\n"), "c.cdsl.yaml": "component: C\n"},
    ),
    "a layer that is not there, and what it may give": (
        ("RC3321", "c.config.yaml", "b.config.yaml"),
        comp("parameters: {a: int}\n", "extends: [b.config.yaml]\nparameters: {}\n"),
    ),
    "a layer that is no YAML, and what it may give": (
        ("RC0101", "b.config.yaml", ""),
        comp("parameters: {a: int}\n", "extends: [b.config.yaml]\nparameters: {}\n", b__config__yaml="parameters: [\n"),
    ),
    "layers in a circle, and what they may give": (
        ("RC3322", "c.config.yaml", "c.config.yaml"),
        comp("parameters: {a: int}\n", "extends: [c.config.yaml]\nparameters: {}\n"),
    ),
    "a bad value, and a constraint over it": (
        ("RC3302", "c.config.yaml", "x"),
        comp("parameters: {a: int, b: int}\nconstraints: [a < b]\n", "parameters: {a: x, b: 1}\n"),
    ),
    "a misspelled parameter, and the one that is meant": (
        ("RC3301", "c.config.yaml", "sped"),
        comp("parameters: {speed: int}\n", "parameters: {sped: 1}\n"),
    ),
    "a misspelled member, and the one that is meant": (
        ("RC3301", "c.config.yaml", "nmae"),
        comp(
            "types: {M: {struct: {name: string}}}\nparameters: {m: M, g: {group: {x: {type: int, default: 1}}}}\n",
            "parameters: {m: {nmae: a}}\n",
        ),
    ),
    "a bad constraint, and values": (
        ("RC3119", "c.pdsl.yaml", "a"),
        comp("parameters: {a: int}\nconstraints: [a <]\n", "parameters: {a: 1}\n"),
    ),
    "a name twice, and values": (
        ("RC3114", "c.pdsl.yaml", "a-b"),
        comp("parameters: {a-b: int, c: int}\n", "parameters: {a-b: 1, c: 2}\n"),
    ),
    "an interface that is no YAML, and who has it": (
        ("RC0101", "Face.idsl.yaml", ""),
        {
            "Face.idsl.yaml": "module: [\n",
            "c.cdsl.yaml": C + "imports: [Face]\nimplements: [Mouth]\nrequires: [Other]\n",
        },
    ),
    "an import that is not there, and who may be in it": (
        ("RC2101", "c.cdsl.yaml", "Face"),
        {"c.cdsl.yaml": C + "imports: [Face]\nimplements: [Mouth]\n"},
    ),
    "an import of a broken import": (
        ("RC0101", "B.idsl.yaml", ""),
        {
            "A.idsl.yaml": "module: RoboCompA\nimports: [B]\ntypes: {P: {struct: {x: B.Q}}}\ninterfaces: {Arm: {methods: {go: {in: {p: P}}}}}\n",
            "B.idsl.yaml": "module: [\n",
            "c.cdsl.yaml": C + "imports: [A]\nimplements: [Arm]\n",
        },
    ),
    "a type that is not there, and who uses it": (
        ("RC1010", "A.idsl.yaml", "itn"),
        {
            "A.idsl.yaml": "module: RoboCompA\ntypes: {P: {struct: {x: itn}}, S: {sequence: P}}\ninterfaces: {Arm: {methods: {go: {in: {p: P, s: S}}}}}\n",
            "c.cdsl.yaml": C + "imports: [A]\nimplements: [Arm]\n",
        },
    ),
    "a component that is not there, and who needs it": (
        ("RC4101", "robot.ddsl.yaml", "muoth"),
        dep(
            "components: {speech: {component: speech, after: [mouth], connect: {Mouth: mouth}}, mouth: {component: muoth, port: 7}}\ngroups: {g: {components: [mouth]}}\n"
        ),
    ),
    "a component of the wrong shape, and who needs it": (
        ("RC0203", "mouth/mouth.cdsl.yaml", "component"),
        {**dep(TWO), "mouth/mouth.cdsl.yaml": "component: MouthComp\n"},
    ),
    "an interface of the wrong shape, and who connects": (
        ("RC0202", "Face.idsl.yaml", "inn"),
        {**dep(TWO), "Face.idsl.yaml": FACE.replace("moveTo: {in", "moveTo: {inn")},
    ),
    "a component with an unknown interface, and who needs it": (
        ("RC2003", "mouth/mouth.cdsl.yaml", "Muoth"),
        {**dep(TWO), "mouth/mouth.cdsl.yaml": component("MouthComp", "implements: [Muoth]\n")},
    ),
    "a configuration that is not there, and its values": (
        ("RC4103", "robot.ddsl.yaml", "no.config.yaml"),
        dep(
            "components: {speech: {component: speech}, mouth: {component: mouth, config: no.config.yaml, set: {period.compute: 5}}}\n"
        ),
    ),
    "an include that is not there, and its names": (
        ("RC4105", "robot.ddsl.yaml", "no.ddsl.yaml"),
        dep("components: {speech: {component: speech, after: [x], connect: {Mouth: y}}}\ninclude: [no.ddsl.yaml]\n"),
    ),
    "an include of the wrong shape, and its names": (
        ("RC0204", "part.ddsl.yaml", "5"),
        dep(
            "components: {speech: {component: speech, after: [x], connect: {Mouth: y}}}\ninclude: [part.ddsl.yaml]\n",
            **{"part.ddsl.yaml": "deployment: P\ncomponents: {x: {program: 5}}\n"},
        ),
    ),
    "a host that is not there, and ports on it": (
        ("RC4002", "robot.ddsl.yaml", "c"),
        dep(
            "hosts: {a: 10.0.0.1, b: 10.0.0.2}\ncomponents: {one: {program: sh, host: c, endpoints: {A: tcp -p 10001}}, two: {program: sh, host: a, endpoints: {B: tcp -p 10001}}}\n"
        ),
    ),
    "a group's member that is not there, and the group": (
        ("RC4005", "robot.ddsl.yaml", "muoth"),
        dep(TWO + "groups: {g: {components: [muoth], expose: {Mouth: muoth}}}\n"),
    ),
    "a group in a circle, and who connects to it": (
        ("RC4013", "robot.ddsl.yaml", "g"),
        dep(
            "components: {speech: {component: speech, connect: {Mouth: g}}, mouth: {component: mouth}}\ngroups: {g: {components: [g, mouth], expose: {Mouth: mouth}}}\n"
        ),
    ),
    "a name twice, and who means it": (
        ("RC4001", "robot.ddsl.yaml", "mouth"),
        dep(
            "components: {speech: {component: speech}, mouth: {component: mouth}}\ngroups: {mouth: {components: [speech]}}\n"
        ),
    ),
    "instances without {i}, and who means them": (
        ("RC4008", "robot.ddsl.yaml", "2"),
        dep(
            "components: {speech: {component: speech, after: [mouth0], connect: {Mouth: mouth0}}, mouth: {component: mouth, instances: 2}}\n"
        ),
    ),
    "a value that does not fit, twice": (
        ("RC3302", "robot.ddsl.yaml", "x"),
        dep("components: {speech: {component: speech}, mouth: {component: mouth, set: {period.compute: x}}}\n"),
    ),
    "a state machine that is no XML": (
        ("RC2202", "m.scxml", "<"),
        {"c.cdsl.yaml": C + "statemachine: m.scxml\n", "m.scxml": "<scxml\n"},
    ),
    "a state machine with an unknown element": (
        ("RC2207", "m.scxml", "<sate"),
        {
            "c.cdsl.yaml": C + "statemachine: m.scxml\n",
            "m.scxml": '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="a"><sate id="a"/><state id="b"><transition event="e" target="a"/></state></scxml>',
        },
    ),
    "a state that is not there": (
        ("RC2221", "c.cdsl.yaml", "x"),
        {"c.cdsl.yaml": C + "statemachine: {initial: a, final: b, transitions: {a: [b, x]}}\n"},
    ),
    "a type that is not there, and values of parameters without a component": (
        ("RC3103", "p.pdsl.yaml", "itn"),
        {
            "p.pdsl.yaml": "parameters: {a: itn}\n",
            "x.config.yaml": "component: p.pdsl.yaml\nparameters: {a: 1, b: 2}\n",
        },
    ),
    "parameters that are no YAML, and a deployment that sets them": (
        ("RC0101", "mouth/mouth.pdsl.yaml", ""),
        dep(
            TWO.replace("mouth}", "mouth, set: {lips: 4}}"),
            **{"mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters: [\n"},
        ),
    ),
    "a limit that leaves nothing, and a deployment that sets it": (
        ("RC3109", "mouth/mouth.pdsl.yaml", "[3, 2]"),
        dep(
            TWO.replace("mouth}", "mouth, set: {lips: 4}}"),
            **{"mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters: {lips: {type: int, range: [3, 2]}}\n"},
        ),
    ),
    "a broken default of a group, and a constraint": (
        ("RC3113", "c.pdsl.yaml", "x"),
        comp(
            "parameters: {g: {group: {a: {type: int, default: x}}}, b: int}\nconstraints: [b > 5]\n",
            "parameters: {b: 1}\n",
        ),
    ),
    "a spelling that cannot be, and values": (
        ("RC3121", "c.pdsl.yaml", "ls"),
        comp("parameters: {ls: {list: string}}\nlegacy: {ls: {key: L}}\n", "parameters: {ls: ['a,b']}\n"),
    ),
}


@pytest.mark.parametrize("cause", CASES)
def test_one_cause_is_reported_once(cause: str) -> None:
    expected, documents = CASES[cause]
    assert [(one.code, one.file, one.at) for one in said(documents)] == [expected]


def test_processes_on_unknown_hosts_have_no_port_conflict() -> None:
    documents = dep(
        "hosts: {onboard: 10.0.0.1, head: 10.0.0.2}\ncomponents:\n  one: {program: sh, host: onbord, endpoints: {A: tcp -p 7}}\n"
        "  two: {program: sh, host: haed, endpoints: {B: tcp -p 7}}\n"
    )
    assert [one.code for one in said(documents)] == ["RC4002", "RC4002"]
