"""Proxies and endpoints in documents: those that Ice would reject are reported, at the wrong word."""

from __future__ import annotations

from collections.abc import Callable

import pytest

Check = Callable[..., list[dict[str, object]]]
TREE = {
    "Lamp.idsl.yaml": "module: RoboCompLamp\ninterfaces: {Lamp: {methods: {on: }}}\n",
    "hall/hall.cdsl.yaml": "component: HallComp\nlanguage: python\nimports: [../Lamp]\nrequires: [Lamp]\n",
}  # fmt: skip


def deployed(diagnostics: Check, entry: str) -> list[tuple[str, str, str]]:
    """Codes, the text of the document at each location, and hints."""
    text = f"deployment: Hall\ncomponents:\n  {entry}\n"
    found = diagnostics({**TREE, "hall.ddsl.yaml": text}, "hall.ddsl.yaml")
    lines = text.splitlines()
    told: list[tuple[str, str, str]] = []
    for one in found:
        line, column, end = (int(str(one[key])) for key in ("line", "column", "end_column"))
        if one["code"] != "RC4403":
            told.append((str(one["code"]), lines[line - 1][column - 1 : end - 1], str(one["hint"])))
    return told


@pytest.mark.parametrize(
    ("proxy", "code", "where"),
    [
        ("lamp left", "RC4015", "left"),
        ('"lamp left"', "RC4015", "left"),
        ("'lamp:tcp -p 1 -t soon'", "RC4015", "soon"),
        ('"lamp:tcp\\t-p x"', "RC4015", '"lamp:tcp\\t-p x"'),
        ('"lamp @ "', "RC4015", "@"),
        ("'\"lamp:tcp -p 1'", "RC4015", '"lamp:tcp -p 1'),
        ("'\"\"'", "RC4015", '""'),
        ('"lamp:tcp -p 1:upd -p 2"', "RC4016", "upd"),
    ],
)
def test_a_proxy_that_ice_rejects(diagnostics: Check, proxy: str, code: str, where: str) -> None:
    (found,) = deployed(diagnostics, f"hall: {{component: hall, connect: {{Lamp: {proxy}}}}}")
    assert found[:2] == (code, where)


@pytest.mark.parametrize("proxy", ['"lamp -o @ Hall"', "lamp:ws -h h -p 1 -r /x", '"\'a lamp\':tcp -h \\"::1\\" -p 1"'])
def test_a_proxy_that_ice_accepts(diagnostics: Check, proxy: str) -> None:
    assert deployed(diagnostics, f"hall: {{component: hall, connect: {{Lamp: {proxy}}}}}") == []


def test_an_unknown_name_is_not_a_proxy(diagnostics: Check) -> None:
    (found,) = deployed(diagnostics, "hall: {component: hall, connect: {Lamp: lamp/left}}")
    assert found[0] == "RC4205"


def test_the_hint_for_a_program_names_keys_for_any_text(diagnostics: Check) -> None:
    args = 'args: ["lamp left", "tcp -q"], env: {LAMP: "lamp left"}'
    assert deployed(diagnostics, f"viewer: {{program: sh, {args}}}") == []
    (found,) = deployed(diagnostics, "viewer: {program: sh, connect: {Lamp: lamp left}}")
    assert "`args:` or `env:`" in found[2]


def test_for_instances_the_location_is_the_whole_text(diagnostics: Check) -> None:
    entry = 'hall{i}: {component: hall, instances: 3, connect: {Lamp: "lamp{i}:tcp -p 1 -q"}}'
    (found,) = deployed(diagnostics, entry)
    assert found[:2] == ("RC4015", '"lamp{i}:tcp -p 1 -q"')


@pytest.mark.parametrize(
    ("text", "where"), [("tcp -p 1 -x", "-x"), ("tpc -p 1", "tpc"), ("udp", "udp"), ('"tcp -p 1::tcp"', ":")]
)
def test_an_endpoint_that_ice_rejects(diagnostics: Check, text: str, where: str) -> None:
    (found,) = deployed(diagnostics, f"viewer: {{program: sh, endpoints: {{Lamp: {text}}}}}")
    assert found[:2] == ("RC4301", where)


@pytest.mark.parametrize(
    "values",
    ["endpoints: {CommonBehavior: tcp -q 1}", 'proxies: {Lamp: "lamp left"}', "proxies: {Lamp: {proxy: 'lamp:tpc'}}",
     'topics: {manager: "IceStorm/Topic/Manager"}'],
)  # fmt: skip
def test_values_documents(diagnostics: Check, values: str) -> None:
    text = f"component: ../hall.cdsl.yaml\n{values}\n"
    (found,) = diagnostics({**TREE, "hall/etc/config.yaml": text}, "hall")
    assert (found["code"], found["severity"], found["line"]) == ("RC0208", "error", 2)
    migrated = f"{text}legacy: {{file: config}}\n"
    (found,) = diagnostics({**TREE, "hall/etc/config.yaml": migrated}, "hall")
    assert (found["code"], found["severity"]) == ("RC0208", "warning")
