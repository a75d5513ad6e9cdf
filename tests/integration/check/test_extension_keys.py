"""Keys `x-…` are the user's own in all mappings of all kinds of documents, except in mappings of names."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from parameters import as_dict
from robocomp_yaml.parameters.layers.effective import effective
from robocomp_yaml.parameters.writing.properties import properties
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.source.yaml_text import flow

DOCUMENTS: dict[str, dict[str, Any]] = {
    "rcyaml.yaml": {"interfaces": ["."], "lint": {"RC2003": "warning"}},
    "Speech.idsl.yaml": {
        "module": "RoboCompSpeech",
        "constants": {"most": {"type": "int", "value": 100}},
        "types": {
            "Language": {"enum": {"spanish": 0, "english": {"value": 5}}}, "Words": {"sequence": "string"},
            "Utterance": {"struct": {"text": "string", "speed": {"type": "float", "default": 1.0}}},
            "Lexicon": {"map": {"key": "string", "value": "Utterance"}},
        },
        "exceptions": {"Broken": {"struct": {"what": "string"}}},
        "interfaces": {"Speech": {"methods": {
            "say": {"in": {"text": {"type": "string"}}, "out": {"n": "int"}, "returns": "bool", "throws": ["Broken"]},
        }}},
        "topics": {"SpeechEvents": {"methods": {"spoken": {"in": {"text": "string"}}}}},
    },
    "speech.cdsl.yaml": {
        "component": "SpeechComp", "language": {"name": "cpp", "standard": 20}, "imports": ["Speech"],
        "implements": ["Speech"],
        "requires": [{"Other": "Speech"}, {"Third": {"interface": "Speech", "absent": "ignore"}}],
        "publishes": ["SpeechEvents"], "parameters": "speech.pdsl.yaml",
        "statemachine": {
            "initial": "start", "final": "stop",
            "states": {"work": {"initial": "sense", "states": {"sense": {}, "act": {}},
                                "transitions": {"sense": "act"}}},
            "transitions": {"start": "work", "work": ["work", {"to": "stop", "event": "end"}]},
        },
        "gui": {"toolkit": "qt", "base": "QWidget"},
        "uses": {"libraries": [{"cmake": "OpenCV", "version": ">=4"}]},
    },
    "speech.pdsl.yaml": {
        "component": "speech.cdsl.yaml",
        "types": {
            "Mode": {"enum": {"slow": {"doc": "Slow."}, "fast": {}}},
            "Motor": {"struct": {"name": "string", "vel": {"type": "float", "range": {"from": 0, "below": 2}, "default": 1}}},
        },
        "parameters": {
            "mode": {"type": "Mode", "default": "slow"}, "motors": {"list": {"type": "Motor"}, "size": {"from": 0}},
            "cams": {"list": "Motor", "default": []}, "one": {"type": "Motor", "default": {"name": "a"}},
            "offsets": {"map": "float", "default": {"left": 1}}, "Yolo": {"group": {"gpu": {"type": "bool", "default": True}}},
            "token": {"type": "string", "optional": True},
        },
        "constraints": [{"that": "len(motors) > 0", "else": "no motor"}],
        "legacy": {"mode": "Mode", "motors": {"key": "M{i}", "columns": ["name", "vel"]},
                   "cams": {"fields": {"name": "name_{i}", "vel": "vel_{i}"}}},
    },
    "etc/config.yaml": {
        "component": "../speech.cdsl.yaml",
        "parameters": {"mode": "fast", "motors": [{"name": "a"}], "one": {"name": "b", "vel": 1}, "offsets": {"left": 2},
                       "Yolo": {"gpu": False}, "token": {"env": "TOKEN"}},
        "endpoints": {"Speech": "tcp -p 10010"},
        "proxies": {"Other": "speech:tcp -p 10011", "Third": {"proxy": "speech:tcp -p 10012", "key": "third"}},
        "topics": {"manager": "a:default -p 1", "prefix": {"SpeechEvents": "lab"}, "name": {"SpeechEvents": "E"}},
        "ice": {"Warn.Connections": "0"}, "properties": {"a b": "1"}, "legacy": {"exact": {"mode": "fast"}},
    },
    "robot.ddsl.yaml": {
        "deployment": "Robot", "hosts": {"here": {"address": "localhost"}},
        "services": {"storm": {"icestorm": {"host": "here", "port": 9999}}},
        "components": {
            "speech": {
                "component": "speech.cdsl.yaml", "host": "here", "ports": {"Speech": 10001}, "config": "etc/config.yaml",
                "connect": {"Other": "other", "Third": "other"}, "topics": {"SpeechEvents": "robot/SpeechEvents"},
                "set": {"mode": "slow"}, "ready": {"port": 10001, "within": "10 s"},
            },
            "other": {"program": "true", "host": "here", "env": {"A": "b"}, "endpoints": {"Speech": "tcp -p 10020"}},
        },
        "groups": {"both": {"components": ["speech", "other"]}},
    },
}  # fmt: skip
# The mappings in which each key is a name.
OF_NAMES = {
    "speech.cdsl.yaml: requires.0",
    "speech.cdsl.yaml: requires.1",
    "speech.pdsl.yaml: parameters.offsets.default",
    "speech.pdsl.yaml: parameters.one.default",
    "etc/config.yaml: parameters.offsets",
    "etc/config.yaml: parameters.token",
    "etc/config.yaml: ice",
    "etc/config.yaml: properties",
    "etc/config.yaml: legacy.exact",
}
Result = tuple[list[str], dict[str, str]]
EXTENSION = {"a": [1, {"b": None}]}


def _mappings(data: Any, path: str = "") -> Iterator[str]:
    if isinstance(data, dict):
        yield path
        for key, value in data.items():
            yield from _mappings(value, f"{path}.{key}".lstrip("."))
    elif isinstance(data, list):
        for place, item in enumerate(data):
            yield from _mappings(item, f"{path}.{place}")


def _extended(data: Any, path: str, at: str = "") -> Any:
    """The data with an extension in the mapping at a path."""
    if isinstance(data, dict):
        made = {key: _extended(value, path, f"{at}.{key}".lstrip(".")) for key, value in data.items()}
        return {**made, "x-note": EXTENSION} if path == at else made
    return [_extended(item, path, f"{at}.{n}") for n, item in enumerate(data)] if isinstance(data, list) else data


def _result(folder: Path, documents: dict[str, dict[str, Any]]) -> Result:
    """The diagnostics, and the properties of the component."""
    write_tree(folder, {name: flow(data) + "\n" for name, data in documents.items()})
    analysis = analyse([str(folder)])
    faults = [f"{d.code} {d.message}" for d in analysis.diagnostics]
    values = analysis.program.values.get(str(folder / "etc" / "config.yaml"))
    if values is None or values.parameters is None:
        return faults, {}
    found, _ = effective(values)
    return faults, as_dict(properties(values, found)[0]) if found is not None else {}


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Result:
    result = _result(tmp_path_factory.mktemp("plain"), DOCUMENTS)
    assert result[0] == [] and result[1]["Speech.Endpoints"] == "tcp -p 10010"
    return result


CASES = [f"{name}: {path}" for name, data in DOCUMENTS.items() for path in _mappings(data)]


@pytest.mark.parametrize("case", [case for case in CASES if case not in OF_NAMES])
def test_an_extension_changes_nothing(case: str, plain: Result, tmp_path: Path) -> None:
    name, path = case.split(": ", 1)
    assert _result(tmp_path, {**DOCUMENTS, name: _extended(DOCUMENTS[name], path)}) == plain


@pytest.mark.parametrize("case", sorted(OF_NAMES))
def test_a_name_may_start_with_x(case: str, tmp_path: Path) -> None:
    name, path = case.split(": ", 1)
    extended = {**DOCUMENTS, name: _extended(DOCUMENTS[name], path)}
    assert _result(tmp_path, extended)[0], "it is no text, no number, and not what should stand there"
