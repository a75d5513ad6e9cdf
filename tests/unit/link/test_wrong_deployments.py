"""Errors in deployments: groups, names, hosts, includes, components and configurations."""

from __future__ import annotations

import pytest

from deployments import deployed
from in_memory import COMPONENT, Said, said
from robocomp_yaml.link import deployment_documents

NOT_BUILT = {"rcyaml.yaml": "lint: {RC4403: 'off', RC4201: 'off'}\n"}
ARM = "deployment: Arm\ncomponents: {elbow: {component: mouth}}\n"
TWO = "components: {speech: {component: speech}, mouth: {component: mouth}}\n"


def wrong(text: str, others: dict[str, str]) -> list[Said]:
    documents = {**deployed(text, **others), **NOT_BUILT}
    return said({name: str(content) for name, content in documents.items()}, "robot.ddsl.yaml")


@pytest.mark.parametrize(
    ("text", "others"),
    [
        ('groups: {arm: {include: arm.ddsl.yaml, expose: {Mouth: elbow}}}\n', {'arm.ddsl.yaml': ARM}),
        ('components: {speech: {component: speech, after: [mouth]}, mouth: {component: mouth}}\n', {}),
        (TWO + 'groups: {g: {components: [mouth]}}\n', {}),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\ngroups: {g: {include: arm.ddsl.yaml, host: b}}\n', {'arm.ddsl.yaml': ARM}),
        ('hosts: {a: 10.0.0.1}\ninclude: [arm.ddsl.yaml]\n', {'arm.ddsl.yaml': ARM}),
        ('include: {l: arm.ddsl.yaml, r: arm.ddsl.yaml}\n', {'arm.ddsl.yaml': ARM}),
    ],
)  # fmt: skip
def test_right_deployments(text: str, others: dict[str, str]) -> None:
    assert wrong(text, others) == []


@pytest.mark.parametrize(
    ("text", "others", "code", "at", "message", "hint"),
    [
        (TWO + 'groups: {g: {components: [mouth], as: speech}}\n', {}, 'RC4010', 'speech', "no member of the group 'g' serves 'Speech'", 'add a member that implements it'),
        (TWO + 'groups: {g: {components: [speech], as: speech, expose: {Speach: speech}}}\n', {}, 'RC4007', 'Speach', "component SpeechComp has no interface 'Speach'", "did you mean 'Speech'?"),
        (TWO + 'groups: {g: {components: [speech, mouth], as: speech, expose: {Speech: mouth}}}\n', {}, 'RC4010', 'mouth', "no member of the group 'g' serves 'Speech'", "'mouth' serves Mouth"),
        (TWO + 'groups: {g: {components: [mouth], expose: {Mouth: speech}}}\n', {}, 'RC4005', 'speech', "the group 'g' names 'speech', which is unknown", 'it is not a member of the group'),
        (TWO + 'groups: {g: {components: [mouth], expose: {Mouth: muoth}}}\n', {}, 'RC4005', 'muoth', "the group 'g' names 'muoth', which is unknown", "did you mean 'mouth'?"),
        (TWO + 'groups: {g: {components: [mouth], expose: {Speech: mouth}}}\n', {}, 'RC4010', 'mouth', "no member of the group 'g' serves 'Speech'", "'mouth' serves Mouth"),
        (TWO + 'groups: {g: {components: [mouth], expose: {Lips: mouth.Mouth, Other: mouth.Nothing}}}\n', {}, 'RC4010', 'mouth.Nothing', "no member of the group 'g' serves 'Other'", "'mouth.Nothing' serves Mouth"),
        (TWO + 'groups: {g: {components: [mouth], expose: {Mouth: {member: mouth, allow: [moveTo, moveto]}}}}\n', {}, 'RC4012', 'moveto', "interface 'Mouth' has no method 'moveto'", "'moveTo' is already present"),
        (TWO + 'groups: {g: {components: [mouth], expose: {Mouth: {member: mouth, allow: [jump]}}}}\n', {}, 'RC4012', 'jump', "interface 'Mouth' has no method 'jump'", 'it has moveTo'),
        (TWO + 'groups: {g: {components: [muoth]}}\n', {}, 'RC4005', 'muoth', "the group 'g' names 'muoth', which is unknown", "did you mean 'mouth'?"),
        (TWO + 'groups: {g: {components: [storm]}}\nservices: {storm: {icestorm: {}}}\n', {}, 'RC4005', 'storm', "the group 'g' names 'storm', which is unknown", 'a service cannot be a member of a group'),
        (TWO + 'groups: {g: {components: [h]}, h: {components: [g]}}\n', {}, 'RC4013', 'g', "the group 'g' contains itself", ''),
        (TWO + 'groups: {g: {components: [g]}}\n', {}, 'RC4013', 'g', "the group 'g' contains itself", ''),
        (TWO + 'groups: {mouth: {components: [speech]}}\n', {}, 'RC4001', 'mouth', "'mouth' names two things of this deployment", ''),
        ('components: {a: {component: speech}, b: {component: speech}}\ngroups: {g: {components: [a, b], as: speech}}\n', {}, 'RC4011', 'speech', "several members of the group 'g' serve 'Speech': a, b", 'add `expose: {Speech: a}`, or another member'),
        ('components: {p: {program: sh}}\ngroups: {g: {components: [p], expose: {Laser: p}}}\n', {}, 'RC4010', 'p', "no member of the group 'g' serves 'Laser'", "'p' serves nothing"),
        ('groups: {arm: {include: arm.ddsl.yaml, expose: {Mouth: elbw}}}\n', {'arm.ddsl.yaml': ARM}, 'RC4005', 'elbw', "the group 'arm' names 'elbw', which is unknown", "did you mean 'arm.elbow'?"),
        ('groups: {arm: {include: amr.ddsl.yaml}}\n', {'arm.ddsl.yaml': ARM}, 'RC4105', 'amr.ddsl.yaml', "the included deployment 'amr.ddsl.yaml' is missing", "did you mean 'arm.ddsl.yaml'?"),
        ('components: {speech: {component: speech, after: [muoth]}, mouth: {component: mouth}}\n', {}, 'RC4005', 'muoth', "`after:` names 'muoth', which is unknown", "did you mean 'mouth'?"),
        ("components: {speech: {component: speech, after: ['mouth{i}']}, mouth: {component: mouth}}\n", {}, 'RC4005', "'mouth{i}'", "`after:` names 'mouth{i}', which is unknown", 'only an entry with `instances:` replaces {i}'),
        ('components: {speech: {component: speech, after: [mouth.Mouth]}, mouth: {component: mouth}}\n', {}, 'RC4005', 'mouth.Mouth', "`after:` names 'mouth.Mouth', which is unknown", "did you mean 'mouth'?"),
        ('components: {mouth: {component: mouth}, m: {process: muoth}}\n', {}, 'RC4005', 'muoth', "`process:` names 'muoth', which is unknown", "did you mean 'mouth'?"),
        ('components: {mouth: {component: mouth}, m: {process: mouth}, n: {process: m}}\n', {}, 'RC4006', 'm', "'m' is itself a second name: only a process can have a second name", ''),
        ("components: {'m{i}': {component: mouth, instances: 2}, n: {process: 'm{i}'}}\n", {}, 'RC4006', "'m{i}'", "'m{i}' is an entry with instances: only a process can have a second name", ''),
        ('components: {mouth: {component: mouth}, n: {process: g}}\ngroups: {g: {components: [mouth]}}\n', {}, 'RC4006', 'g', "'g' is a group: only a process can have a second name", ''),
        ('components: {n: {process: storm}}\nservices: {storm: {icestorm: {}}}\n', {}, 'RC4006', 'storm', "'storm' is a service: only a process can have a second name", ''),
        ('components: {mouth: {component: mouth, connect: {Speech: mouth}}}\n', {}, 'RC4007', 'Speech', "component MouthComp has no proxy 'Speech'", ''),
        ('components: {mouth: {component: mouth, ports: {Muoth: 1}}}\n', {}, 'RC4007', 'Muoth', "component MouthComp has no interface 'Muoth'", "did you mean 'Mouth'?"),
        ('components: {mouth: {component: mouth, endpoints: {Muoth: tcp -p 1}}}\n', {}, 'RC4007', 'Muoth', "component MouthComp has no interface 'Muoth'", "did you mean 'Mouth'?"),
        ('components: {mouth: {component: mouth, topics: {Heard: x}}}\n', {}, 'RC4007', 'Heard', "component MouthComp has no topic 'Heard'", ''),
        ("components: {mouth: {component: mouth, ready: {log: '('}}}\n", {}, 'RC4014', "'('", "'(' is not a regular expression: missing ), unterminated subpattern at position 0", ''),
        ("components: {mouth: {component: mouth, executable: '{config}'}}\n", {}, 'RC4017', "'{config}'", "'{config}' cannot be a program: {config} is the path of a configuration, which only arguments can contain", 'name the program that reads it, such as `program: python3, args: ["{config}"]`'),
        ("components: {p: {program: '{config}'}}\n", {}, 'RC4017', "'{config}'", "'{config}' cannot be a program: {config} is the path of a configuration, which only arguments can contain", 'name the program that reads it, such as `program: python3, args: ["{config}"]`'),
        ('components: {mouth: {component: mouth, instances: 2}}\n', {}, 'RC4008', '2', "'mouth' has instances, but no {i} in its name to distinguish them", "rename it to 'mouth{i}'"),
        ("components: {'m{i}': {component: mouth}}\n", {}, 'RC4009', "'m{i}'", "'m{i}' has {i} in its name, but no number of instances", 'add `instances:`'),
        ('components: {storm: {component: mouth}}\nservices: {storm: {icestorm: {}}}\n', {}, 'RC4001', 'storm', "'storm' names two things of this deployment", ''),
        ("components: {'m{i}': {component: mouth, instances: 2}, m1: {component: mouth}}\n", {}, 'RC4001', 'm1', "'m1' names two things of this deployment", ''),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\ncomponents: {mouth: {component: mouth}}\n', {}, 'RC4003', 'mouth', "'mouth' has no host, and this deployment has several", 'add `host: a`, or another host'),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\ncomponents: {mouth: {component: mouth, host: c}}\n', {}, 'RC4002', 'c', "unknown host 'c'", 'the hosts are a, b'),
        ('hosts: {onboard: 10.0.0.1, b: 10.0.0.2}\ncomponents: {mouth: {component: mouth, host: onbord}}\n', {}, 'RC4002', 'onbord', "unknown host 'onbord'", "did you mean 'onboard'?"),
        ('components: {mouth: {component: mouth, host: here}}\n', {}, 'RC4002', 'here', "unknown host 'here'", '`hosts:` defines hosts; without it, all processes run on this machine'),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\nservices: {storm: {icestorm: {}}}\n', {}, 'RC4003', 'storm', "'storm' has no host, and this deployment has several", 'add `host: a`, or another host'),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\ngroups: {g: {include: arm.ddsl.yaml}}\n', {'arm.ddsl.yaml': ARM}, 'RC4003', 'arm.ddsl.yaml', "'g' has no host, and this deployment has several", 'write `groups: {g: {include: arm.ddsl.yaml, host: a}}`, or `hosts:` in arm.ddsl.yaml'),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\ninclude: [arm.ddsl.yaml]\n', {'arm.ddsl.yaml': ARM}, 'RC4003', 'arm.ddsl.yaml', "'arm.ddsl.yaml' has no host, and this deployment has several", 'write `groups: {arm: {include: arm.ddsl.yaml, host: a}}`, or `hosts:` in arm.ddsl.yaml'),
        ('hosts: {a: 10.0.0.1, b: 10.0.0.2}\ngroups: {g: {include: arm.ddsl.yaml, host: c}}\n', {'arm.ddsl.yaml': ARM}, 'RC4002', 'c', "unknown host 'c'", 'the hosts are a, b'),
        ('hosts: {a: 10.0.0.1}\ninclude: [arm.ddsl.yaml]\n', {'arm.ddsl.yaml': ARM + 'hosts: {a: 10.0.0.2}\n'}, 'RC4004', '10.0.0.2', "host 'a' is 10.0.0.2 in arm.ddsl.yaml, and 10.0.0.1 elsewhere in this deployment", 'rename one of the two hosts'),
        ('hosts: {a: {address: 10.0.0.1, user: x}}\ninclude: [arm.ddsl.yaml]\n', {'arm.ddsl.yaml': ARM + 'hosts: {a: 10.0.0.1}\n'}, 'RC4004', '10.0.0.1', "host 'a' is 10.0.0.1 in arm.ddsl.yaml, and x@10.0.0.1 elsewhere in this deployment", 'rename one of the two hosts'),
        ('include: [arm.ddsl.yaml, arm.ddsl.yaml]\n', {'arm.ddsl.yaml': ARM}, 'RC4107', 'arm.ddsl.yaml', "'arm.ddsl.yaml' is included twice in one name space", ''),
        ('include: [robot.ddsl.yaml]\n', {}, 'RC4106', 'robot.ddsl.yaml', "'robot.ddsl.yaml' includes this document: robot.ddsl.yaml → robot.ddsl.yaml", 'remove one of these includes'),
        ('include: [arm.ddsl.yaml]\n', {'arm.ddsl.yaml': ARM + 'include: [robot.ddsl.yaml]\n'}, 'RC4106', 'arm.ddsl.yaml', "'arm.ddsl.yaml' includes this document: arm.ddsl.yaml → robot.ddsl.yaml → arm.ddsl.yaml", 'remove one of these includes'),
        ('include: [arm.ddsl.yaml]\ncomponents: {elbow: {component: mouth}}\n', {'arm.ddsl.yaml': ARM}, 'RC4001', 'elbow', "'elbow' names two things of this deployment", ''),
        ('include: [arm]\n', {'arm.ddsl.yaml': ARM}, 'RC4105', 'arm', "the included deployment 'arm' is missing", ''),
        ('include: [speech/speech.cdsl.yaml]\n', {}, 'RC4105', 'speech/speech.cdsl.yaml', "the included deployment 'speech/speech.cdsl.yaml' is missing", ''),
        ('include: [nothing]\n', {}, 'RC4105', 'nothing', "the included deployment 'nothing' is missing", ''),
        ('components: {m: {component: muoth}}\n', {}, 'RC4101', 'muoth', "there is no component at 'muoth'", "did you mean 'mouth'?"),
        ('components: {m: {component: mouth/muoth.cdsl.yaml}}\n', {}, 'RC4101', 'mouth/muoth.cdsl.yaml', "there is no component at 'mouth/muoth.cdsl.yaml'", "did you mean 'mouth.cdsl.yaml'?"),
        ('components: {m: {component: Face.idsl.yaml}}\n', {}, 'RC4101', 'Face.idsl.yaml', "there is no component at 'Face.idsl.yaml'", ''),
        ('components: {m: {component: arm.ddsl.yaml}}\n', {'arm.ddsl.yaml': ARM}, 'RC4101', 'arm.ddsl.yaml', "there is no component at 'arm.ddsl.yaml'", ''),
        ('components: {m: {component: nowhere/x}}\n', {}, 'RC4101', 'nowhere/x', "there is no component at 'nowhere/x'", "the folder 'nowhere' does not exist"),
        ('components: {m: {component: both}}\n', {'both/a.cdsl.yaml': 'component: C\nlanguage: python\n', 'both/b.cdsl.yaml': 'component: C\nlanguage: python\n'}, 'RC4102', 'both', "'both' contains several components", 'name both/a.cdsl.yaml or both/b.cdsl.yaml'),
        ('components: {m: {component: empty}}\n', {'empty/x.txt': ''}, 'RC4101', 'empty', "there is no component at 'empty'", ''),
        ('components: {m: {component: mouth, config: my.config.yaml}}\n', {}, 'RC4103', 'my.config.yaml', "configuration 'my.config.yaml' is missing: no mouth/my.config.yaml and no my.config.yaml", ''),
        ('components: {m: {component: mouth, config: my.config.yaml}}\n', {'mouth/my.confg.yaml': '', 'mouth/your.config.yaml': 'component: mouth.cdsl.yaml\n'}, 'RC4103', 'my.config.yaml', "configuration 'my.config.yaml' is missing: no mouth/my.config.yaml and no my.config.yaml", "did you mean 'my.confg.yaml'?"),
        ('components: {m: {component: mouth, config: etc/config}}\n', {}, 'RC4103', 'etc/config', "configuration 'etc/config' is missing: no mouth/etc/config and no etc/config", "the folder 'mouth/etc' does not exist"),
        ('components: {m: {component: mouth, config: ../speech/x.config.yaml}}\n', {'speech/x.config.yaml': 'component: speech.cdsl.yaml\n'}, 'RC4104', '../speech/x.config.yaml', 'these are values of component SpeechComp, not of MouthComp', 'a component cannot use the values of another one: see `component:` in that document'),
        ('components: {m: {component: mouth, set: {period.compute: 0}}}\n', {}, 'RC3303', '0', 'period.compute is 0 ms, and must be at least 1 ms', ''),
        ('components: {m: {component: mouth, set: {nothing: 0}}}\n', {}, 'RC3301', 'nothing', "unknown parameter 'nothing'", 'known keys: period'),
        ('components: {m: {component: mouth, set: {Ice.MessageSizeMax: 3}}}\n', {}, 'RC3301', 'Ice.MessageSizeMax', "unknown parameter 'Ice'", 'it is a property of Ice: write `ice: {MessageSizeMax: …}` in a values document'),
        ('components: {m: {component: mouth, set: {Ice: {Warn: {Connections: 1}}}}}\n', {}, 'RC3301', 'Ice', "unknown parameter 'Ice'", 'it is a property of Ice: write `ice: {Warn.Connections: …}` in a values document'),
        ('components: {m: {component: mouth, set: {Ice: 3}}}\n', {}, 'RC3301', 'Ice', "unknown parameter 'Ice'", 'known keys: period'),
        ('components: {m: {component: mouth, set: {IceSSL.CAs: ca.pem}}}\n', {}, 'RC3301', 'IceSSL.CAs', "unknown parameter 'IceSSL'", 'it is a property of Ice: write `properties: {IceSSL.CAs: …}` in a values document'),
        ('components: {m: {component: mouth, set: {Mouth.Endpoints: tcp}}}\n', {}, 'RC3301', 'Mouth.Endpoints', "unknown parameter 'Mouth'", 'it is not a parameter: write `endpoints: {Mouth: …}` in a values document, or `ports: {Mouth: …}` in a deployment'),
        ('components: {m: {component: mouth, set: {SpeechProxy: x}}}\n', {}, 'RC3301', 'SpeechProxy', "unknown parameter 'SpeechProxy'", 'it is not a parameter: write `proxies: {Speech: …}` in a values document, or `connect: {Speech: …}` in a deployment'),
        ('components: {m: {component: mouth, set: {TopicManager.Proxy: x}}}\n', {}, 'RC3301', 'TopicManager.Proxy', "unknown parameter 'TopicManager'", 'it is not a parameter: write `topics: {manager: …}` in a values document'),
        ('components: {m: {component: mouth, set: {period.compute: x}}}\n', {}, 'RC3302', 'x', "period.compute must be a whole number (ms), and is the text 'x'", ''),
    ],
)  # fmt: skip
def test_wrong_deployments(text: str, others: dict[str, str], code: str, at: str, message: str, hint: str) -> None:
    assert [one[:4] for one in wrong(text, others)] == [(code, at, message, hint)]


@pytest.mark.parametrize(
    ("text", "others", "related"),
    [
        (TWO + "groups: {mouth: {components: [speech]}}\n", {}, [("the first definition", "mouth")]),
        ("components: {a: {component: speech}, b: {component: speech}}\ngroups: {g: {components: [a, b], as: speech}}\n", {},
         [("the member 'a'", "a"), ("the member 'b'", "b")]),
        (TWO + "groups: {g: {components: [mouth], expose: {Mouth: {member: mouth, allow: [jump]}}}}\n", {}, [("the interface", "Mouth")]),
        (TWO + "groups: {g: {components: [mouth], as: speech}}\n", {}, [("the group offers it", "Speech")]),
        ("hosts: {a: 10.0.0.1}\ninclude: [arm.ddsl.yaml]\n", {"arm.ddsl.yaml": ARM + "hosts: {a: 10.0.0.2}\n"},
         [("the other host", "10.0.0.1"), ("the include", "arm.ddsl.yaml")]),
        ("components: {mouth: {component: mouth, ports: {Muoth: 1}}}\n", {}, [("the component", "MouthComp")]),
    ],
)  # fmt: skip
def test_related_locations(text: str, others: dict[str, str], related: list[tuple[str, str]]) -> None:
    (found,) = wrong(text, others)
    assert list(found.related) == related


def test_a_folder_with_several_components() -> None:
    others = {"both/a.cdsl.yaml": COMPONENT, "both/b.cdsl.yaml": COMPONENT}
    (found,) = wrong("components: {m: {component: both}}\n", others)
    for meant in found.hint.removeprefix("name ").split(" or "):
        assert wrong(f"components: {{m: {{component: {meant}}}}}\n", others) == []


def test_each_instance_has_its_own_component_and_configuration() -> None:
    text = "components: {'m{i}': {component: 'mouth{i}', instances: 2, config: 'c{i}.config.yaml'}}\n"
    mouths = {f"mouth{i}/m.cdsl.yaml": COMPONENT.replace(": C", f": C{i}") for i in (0, 1)}
    values = {f"mouth{i}/c{i}.config.yaml": "component: m.cdsl.yaml\n" for i in (0, 1)}
    assert wrong(text, {**mouths, **values}) == []
    (found,) = wrong(text, {**mouths, **{name: it for name, it in values.items() if "1" not in name}})
    assert (found.code, found.at) == ("RC4103", "'c{i}.config.yaml'") and "'c1.config.yaml'" in found.message
    (found,) = wrong(text, {name: it for name, it in {**mouths, **values}.items() if name != "mouth1/m.cdsl.yaml"})
    assert (found.code, found.at) == ("RC4101", "'mouth{i}'") and "'mouth1'" in found.message


def test_an_include_in_an_include_needs_its_host_too() -> None:
    part = "deployment: Part\ngroups: {inner: {include: arm.ddsl.yaml}}\n"
    text = "hosts: {a: 10.0.0.1, b: 10.0.0.2}\ngroups: {outer: {include: part.ddsl.yaml}}\n"
    (found,) = wrong(text, {"part.ddsl.yaml": part, "arm.ddsl.yaml": ARM})
    assert (
        found.message == "'outer.inner' has no host, and this deployment has several"
        and "inner: {include: arm.ddsl.yaml" in found.hint
    )


def test_hints_name_nothing_that_a_group_already_exposes() -> None:
    (found,) = wrong(
        TWO + "groups: {g: {components: [speech], as: speech, expose: {Speech: speech, Speach: speech}}}\n", {}
    )
    assert (found.at, found.hint) == ("Speach", "'Speech' is already present")


@pytest.mark.parametrize(("limit", "most"), [("MAX_DEPTH", 3), ("MAX_INSTANCES", 6)])
def test_deployments_are_as_large_as_they_may_be(limit: str, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three documents that include the next one, with two processes each."""
    documents = {
        f"d{n}.ddsl.yaml": f"deployment: D{n}\ninclude: [d{n + 1}.ddsl.yaml]\n"
        f"components: {{'p{n}_{{i}}': {{program: sh, instances: 2}}}}\n"
        for n in range(3)
    }
    documents["d2.ddsl.yaml"] = documents["d2.ddsl.yaml"].replace("include: [d3.ddsl.yaml]\n", "")
    for allowed, expected in ((most, []), (most - 1, ["RC4108"])):
        monkeypatch.setattr(deployment_documents, limit, allowed)
        assert [one.code for one in said(documents, "d0.ddsl.yaml") if one.code == "RC4108"] == expected
