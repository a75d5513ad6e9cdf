"""Hostile texts in every field of a deployment: `check` rejects them, or they change the structure of no artefact.

The structure is what a reader of the artefact finds: elements and attributes of XML, keys of YAML, sections and
directives of units, statements of graphs. That of a text counts which has nothing special in it.
"""

from __future__ import annotations

import copy
import json
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from ruamel.yaml import YAML

from conftest import write_tree
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.emit import exports
from robocomp_yaml.emit.graphs import of_network
from robocomp_yaml.emit.graphs.forms import draw
from robocomp_yaml.emit.xml_text import _name
from robocomp_yaml.network.network import Network
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source import properties
from robocomp_yaml.source.yaml_text import flow

HOSTILE = (
    "a\nExecStartPre=/bin/false", "a\n[Service]\nUser=root", "a\n\n", "a\rb", "a\0b", "a\vb\fc", "a\x1b[31mb", "a\x7fb",
    "a\x85b", "a\u2028b", "a\tb\t", " a ", "a\\", '"; a', "'a'\"b\"", "</option><option>", "]]>&amp;<!--", "${a}$b$$",
    "%i%%", "# a: [b, {c}]", "-a", "+a", "@a", "{config}", "a;b|c>d\"[x]", "\ufffea", "é" * 200, "a/" * 2500, "a b\\n",
)  # fmt: skip
HARMLESS = "harmless"
SHARE = 1 if "RCYAML_CASES" in os.environ else 4
"""A field is tested with every n-th text, and the next field with others."""

IDSL = (
    "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
    "topics:\n  News:\n    methods:\n      told: {in: {what: string}}\n"
)
SPEECH = "component: SpeechComp\nlanguage: python\nimports: [../Speech]\nimplements: [Speech]\npublishes: [News]\n"
TREE = {
    "Speech.idsl.yaml": IDSL, "speech/speech.cdsl.yaml": SPEECH, "conf": "A=1\n", "speech/conf": "A=1\n",
    "ear/ear.cdsl.yaml": "component: EarComp\nlanguage: python\nimports: [../Speech]\nrequires: [Speech]\n",
    "arm.ddsl.yaml": "deployment: Arm\ncomponents:\n  elbow: {program: sleep, args: [1]}\n",
}  # fmt: skip
DEPLOYMENT: dict[str, Any] = {
    "deployment": "Head",
    "doc": "About it.",
    "hosts": {"here": {"address": "127.0.0.1", "user": "robot", "doc": "About it."}},
    "services": {"storm": {"icestorm": {"host": "here", "port": 9999}}},
    "components": {
        "speech": {
            "component": "speech", "executable": "bin/x", "args": ["one"], "cwd": "speech", "config": "conf",
            "config-as": "--Ice.Config", "env": {"A": "v", "B": {"env": "HOME"}}, "topics": {"News": "robot/News"},
            "ready": {"log": "up"}, "after": ["storm"], "doc": "About it.",
            "x-rcmanager": {"xpos": "1", "a": {"b": "c"}},
        },
        "ear": {"component": "ear", "connect": {"Speech": "speech:tcp -h 10.0.0.9 -p 10002"}},
        "ear2": {"component": "ear", "connect": {"Speech": "face"}, "endpoints": {"CommonBehavior": "tcp -p 10005"}},
        "laser": {
            "program": "bin/laser", "args": ["-f", "{config}"], "cwd": "speech", "config": "conf", "env": {"Z": "w"},
            "endpoints": {"Laser": "tcp -p 10003"}, "ready": {"command": ["test", "-e", "x"]},
        },
        "other": {"process": "laser", "endpoints": {"Other": "tcp -p 10006"}},
        "tool": {"program": "sleep", "args": ["1"], "ready": {"command": "test -e x"}},
        "many{i}": {"program": "sleep", "args": ["{i}"], "instances": 2, "cwd": "speech"},
    },
    "groups": {
        "face": {"components": ["speech"], "expose": {"Speech": {"member": "speech", "rate": 5, "allow": ["say"]}}},
        "ears": {"components": ["ear"], "as": "ear", "host": "here"},
    },
    "include": {"arm": "arm.ddsl.yaml"},
    "x-rcmanager": {"general": {"k": "v"}, "more": "w"},
}  # fmt: skip


MEANT = {(" a ", "Speech"), ("{config}", 0)}
"""A proxy that is resolved, and a configuration for a program: these have another meaning than other texts."""


def places(data: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], bool]]:
    """The paths of all texts: values, and keys (True)."""
    for step, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        if isinstance(data, dict):
            yield (*path, step), True
        if isinstance(value, dict | list):
            yield from places(value, (*path, step))
        else:
            yield (*path, step), False


def with_text(path: tuple[str | int, ...], is_key: bool, text: str) -> dict[str, Any]:
    data = copy.deepcopy(DEPLOYMENT)
    inner: Any = data
    for step in path[:-1]:
        inner = inner[step]
    if is_key:
        items = [(text if key == path[-1] else key, value) for key, value in inner.items()]
        inner.clear()
        inner.update(items)
    else:
        inner[path[-1]] = text
    return data


def analysed(folder: Path, data: dict[str, Any]) -> Analysis:
    (folder / "head.ddsl.yaml").write_text(flow(data) + "\n", encoding="utf-8")
    return analyse(["head.ddsl.yaml"])


def artefacts(network: Network, analysis: Analysis) -> dict[str, Any]:
    """The structure of all exports of a network; '' for what a form cannot express."""
    found: dict[str, Any] = {}
    for form in exports.forms():
        try:
            files = exports.export(network, form)
        except exports.Unwritable as refused:
            assert str(refused) and refused.name
            found[form] = ""
            continue
        found[form] = {path: READERS[os.path.splitext(path)[1]](text) for path, text in files.items()}
    picture = of_network.picture_of(network, analysis.diagnostics)
    found["json"] = shape(json.loads(draw(picture, "json")))
    found["svg"] = [part.tag for part in ElementTree.fromstring(draw(picture, "svg")).iter() if "tspan" not in part.tag]
    found["dot"] = [re.sub(r'"(?:[^"\\]|\\.)*"', '""', line) for line in draw(picture, "dot").splitlines()]
    found["mermaid"] = [re.sub(r'"[^"]*"', '""', line) for line in draw(picture, "mermaid").splitlines()]
    return found


def shape(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: shape(value) for key, value in data.items()}
    return [shape(item) for item in data] if isinstance(data, list) else type(data).__name__


def in_order(data: Any) -> Any:
    """The same with sorted names."""
    if isinstance(data, dict):
        return {key: in_order(value) for key, value in data.items()}
    if isinstance(data, list):
        return sorted(data) if all(isinstance(item, str) for item in data) else [in_order(item) for item in data]
    return data


def of_xml(text: str) -> Any:
    """Elements with the names of their attributes. A server that a shell or env starts has more options, and other
    variables."""
    parts = ElementTree.fromstring(text).iter()
    return [(part.tag, sorted(part.attrib)) for part in parts if part.tag not in ("option", "env")]


def of_yaml(text: str) -> Any:
    return keys(YAML(typ="safe", pure=True).load(text))


def keys(data: Any) -> Any:
    return {key: keys(value) for key, value in data.items()} if isinstance(data, dict) else type(data).__name__


def of_unit(text: str) -> Any:
    """Sections and directives as systemd reads them: \\n, \\r and NUL end a line, and a backslash continues it."""
    lines = re.split(r"[\n\r\0]", text)
    assert not any(line.endswith("\\") for line in lines)
    return [line.partition("=")[0] for line in lines if not line.startswith(("#", ";"))]


def of_config(text: str) -> Any:
    """A configuration, or the program of a gate."""
    return text.count("\n") if text.startswith('"""') else list(properties.read(text).values)


READERS: dict[str, Callable[[str], Any]] = {
    ".xml": of_xml,
    ".yaml": of_yaml,
    ".service": of_unit,
    ".target": of_unit,
    **dict.fromkeys(("", ".gate", ".elbow"), of_config),
}


def named(value: object) -> str:
    return ".".join(map(str, value)) if isinstance(value, tuple) else "key" if value else "value"


@pytest.mark.parametrize(("path", "is_key"), list(places(DEPLOYMENT)), ids=named)
def test_no_text_breaks_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: tuple[str | int, ...], is_key: bool
) -> None:
    write_tree(tmp_path, TREE)
    monkeypatch.chdir(tmp_path)
    whole = analysed(tmp_path, DEPLOYMENT)
    assert not has_errors(whole.diagnostics), whole.diagnostics
    plain = analysed(tmp_path, with_text(path, is_key, HARMLESS))
    networks = plain if not has_errors(plain.diagnostics) else whole
    head = os.path.realpath("head.ddsl.yaml")
    wanted = artefacts(networks.networks[head], networks)
    own = list(places(DEPLOYMENT)).index((path, is_key))
    for text in HOSTILE[own % SHARE :: SHARE]:
        analysis = analysed(tmp_path, with_text(path, is_key, text))
        network = analysis.networks.get(head)
        if has_errors(analysis.diagnostics):
            for fault in analysis.diagnostics:
                assert fault.span.file
            continue
        assert network is not None
        got = artefacts(network, analysis)
        for form, structure in got.items():
            if is_key and "x-rcmanager" in path:  # its keys are names of elements and attributes
                named = json.dumps(structure).replace(json.dumps(_name(text)), json.dumps(HARMLESS))
                structure, wanted[form] = in_order(json.loads(named)), in_order(json.loads(json.dumps(wanted[form])))
            if (text, path[-1]) not in MEANT:
                assert structure in ("", wanted[form]), (form, text)
