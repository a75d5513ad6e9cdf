"""Diagnostics of connections whose other end is wrong, ambiguous or missing."""

from __future__ import annotations

import pytest

from deployments import deployed
from in_memory import Said, said


def wrong(text: str, others: dict[str, str]) -> list[Said]:
    documents = {name: str(content) for name, content in deployed(text, **others).items()}
    return said({**documents, "rcyaml.yaml": "lint: {RC4403: 'off'}\n"}, "robot.ddsl.yaml")


@pytest.mark.parametrize(
    ("text", "others"),
    [
        ('components:\n  p: {program: sh, connect: {Mouth: mouth}}\n  mouth: {component: mouth}\n', {}),
        ('components:\n  speech: {component: speech}\n  mouth: {component: mouth, enabled: false}\n', {'speech': 'requires: [Mouth: {interface: Mouth, absent: ignore}]\n'}),
        ('components:\n  speech: {component: speech, connect: {Mouth: g.Lips}}\n  mouth: {component: mouth}\ngroups: {g: {components: [mouth], expose: {Lips: mouth.Mouth}}}\n', {}),
        ('components:\n  a: {component: speech, topics: {Heard: x}}\nservices: {storm: {icestorm: {}}}\n', {'speech': 'publishes: [Heard]\n'}),
        ('security: tls\ncomponents:\n  p: {program: sh}\n  mouth: {component: mouth}\n', {}),
    ],
)  # fmt: skip
def test_nothing_is_wrong(text: str, others: dict[str, str]) -> None:
    assert wrong(text, others) == []


@pytest.mark.parametrize(
    ("text", "others", "code", "at", "message", "hint"),
    [
        ('security: tls\ncomponents:\n  p: {program: sh, endpoints: {Laser: tcp -p 10003}}\n', {}, 'RC4114', 'p', "'p' stays plain under `security: tls`: it is a program, and rcyaml does not know how it reads certificates", ''),
        ('components:\n  speech: {component: speech, connect: {Mouth: g}}\n  mouth: {component: mouth}\n  other: {component: mouth}\ngroups: {g: {components: [mouth, other]}}\n', {}, 'RC4202', 'g', "'speech' requires Mouth as Mouth, which several processes serve: mouth, other", 'write `connect: {Mouth: mouth}`, or another one'),
        ('components:\n  speech: {component: speech, connect: {Mouth: mouth}}\n  mouth: {component: mouth, enabled: false}\n', {}, 'RC4207', 'mouth', "'speech' requires Mouth from 'mouth', which is not enabled", ''),
        ('components:\n  speech: {component: speech, connect: {Mouth: p}}\n  p: {program: sh, endpoints: {Laser: tcp -p 5}}\n', {}, 'RC4204', 'p', "'p' does not serve Mouth", 'it serves Laser'),
        ('components:\n  speech: {component: speech, connect: {Mouth: p}}\n  p: {program: sh}\n', {}, 'RC4204', 'p', "'p' does not serve Mouth", 'it serves nothing'),
        ('components:\n  speech: {component: speech, connect: {Mouth: speech}}\n', {}, 'RC4204', 'speech', "'speech' does not serve Mouth", 'it serves Speech, CommonBehavior'),
        ("components:\n  speech: {component: speech, connect: {Mouth: 'm{i}'}}\n  'm{i}': {component: mouth, instances: 2}\n", {}, 'RC4202', "'m{i}'", "'speech' requires Mouth as Mouth, which several processes serve: m0, m1", 'write `connect: {Mouth: m0}`, or another one'),
        ('components:\n  p: {program: sh, connect: {Lips: mouth}}\n  mouth: {component: mouth}\n', {}, 'RC4204', 'mouth', "'mouth' does not serve Lips", 'it serves Mouth, CommonBehavior'),
        ('components:\n  p: {program: sh, connect: {Lips: mouth.Lips}}\n  mouth: {component: mouth}\n', {}, 'RC4204', 'mouth.Lips', "'mouth.Lips' does not serve Lips", 'it serves Mouth, CommonBehavior'),
        ("components:\n  p: {program: sh, connect: {Lips: 'mouth:tcp -q 5'}}\n", {}, 'RC4015', '-q', "'mouth:tcp -q 5' is not a proxy: tcp has no option '-q', only -h, -p, -t, -z and --sourceAddress", 'write it in the syntax of Ice: `"lips:tcp -h HOST -p PORT"`; for any other text to a program that does not use Ice, use `args:` or `env:`'),
        ('components:\n  speech: {component: speech, connect: {Mouth: storm}}\nservices: {storm: {icestorm: {}}}\n', {}, 'RC4204', 'storm', "'storm' does not serve Mouth", 'it is an IceStorm, which carries topics'),
        ('components:\n  speech: {component: speech}\n', {'speech': 'requires: [Mouth: {interface: Mouth, absent: fail}]\n'}, 'RC4201', 'speech', "'speech' requires Mouth, which nothing in this deployment serves", 'add a component that implements Mouth, or name its proxy: `connect: {Mouth: "mouth:tcp -h HOST -p PORT"}`'),
        ('components:\n  speech: {component: speech, connect: {Mouth: g.Lip}}\n  mouth: {component: mouth}\ngroups: {g: {components: [mouth], expose: {Lips: mouth.Mouth}}}\n', {}, 'RC4204', 'g.Lip', "'g.Lip' does not serve Mouth", 'it serves Lips'),
        ('components:\n  a: {component: speech}\n  b: {component: speech}\n', {'speech': 'publishes: [Heard]\n'}, 'RC4208', 'a', "'a' publishes Heard, and there is no IceStorm to carry it", "add an IceStorm: `services: {storm: {icestorm: {}}}`; 'b' needs it, too"),
    ],
)  # fmt: skip
def test_what_is_wrong(text: str, others: dict[str, str], code: str, at: str, message: str, hint: str) -> None:
    assert [one[:4] for one in wrong(text, others)] == [(code, at, message, hint)]
