"""Values documents as properties: connections, dialects, legacy spellings, and what no property can hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from parameters import as_dict
from robocomp_yaml.parameters.layers.effective import effective
from robocomp_yaml.parameters.writing.properties import properties
from robocomp_yaml.pipeline import analyse

PDSL = """\
component: c.cdsl.yaml
types:
  Motor: {struct: {name: string, id: {type: int, default: 0}, tag: {type: string, optional: true}}}
  Tag: {struct: {from: int, to: int, size: {type: float, default: 1}}}
parameters:
  device: {type: string, default: /dev/x}
  speed: {type: float, default: 0.5}
  n: {type: int, default: 3}
  on: {type: bool, default: true}
  note: {type: string, optional: true}
  names: {list: string, default: [a]}
  motors: {list: Motor, default: []}
  tags: {list: Tag, default: []}
  cams: {list: Motor, default: []}
  excluded: {list: {list: string}, default: []}
  plain: {list: Motor, default: []}
  offsets: {map: float, default: {}}
legacy:
  device: Bus.Device
  period.compute: Period.Compute
  motors: {key: "Bus.M{i}", first: 1, columns: [name, id], separator: ",", count: Bus.Count}
  tags: {key: "ID:{from}-{to}", columns: [size]}
  cams: {fields: {name: "name_{i}", id: "id_{i}"}}
  excluded: {key: Excluded, separators: [";", ","], trailing: true}
"""


def of(folder: Path, text: str, **layers: str) -> tuple[dict[str, str], list[str]]:
    """The properties of a document, and what is wrong with it."""
    write_tree(
        folder,
        {
            "c.cdsl.yaml": "component: C\nlanguage: python\n",
            "c.pdsl.yaml": PDSL,
            "x.config.yaml": "component: c.cdsl.yaml\n" + text,
            **{f"{name}.config.yaml": content for name, content in layers.items()},
        },
    )
    path = str(folder / "x.config.yaml")
    analysis = analyse([path])
    values = analysis.program.values[path]
    found, _ = effective(values)
    assert found is not None, analysis.diagnostics
    errors = [f"{d.span.line}: {d.message}" for d in analysis.diagnostics if d.severity == "error"]
    return as_dict(properties(values, found)[0]), errors


def given(folder: Path, parameters: str) -> dict[str, str]:
    """What a legacy file has of these parameters: only what is set."""
    held, errors = of(folder, f"legacy: {{file: config}}\nparameters: {parameters}\n")
    assert errors == []
    return held


@pytest.mark.parametrize(
    ("parameters", "expected"),
    [
        ("{device: a b#}", {"Bus.Device": "a b#"}),
        ("{period: {compute: 20}}", {"Period.Compute": "20"}),
        ("{motors: [{name: a, id: 7}, {name: b}]}", {"Bus.M1": "a,7", "Bus.M2": "b,0", "Bus.Count": "2"}),
        ("{tags: [{from: 0, to: 10, size: 100.}]}", {"ID:0-10": "100."}),
        ("{cams: [{name: a, id: 1}, {name: b}]}", {"name_0": "a", "id_0": "1", "name_1": "b", "id_1": "0"}),
        ("{excluded: [[a, b], [c]]}", {"Excluded": "a,b;c;"}),
        ("{names: [x, '']}", {"names.size": "2", "names.0": "x"}),
        (
            "{plain: [{name: a, tag: t}]}",
            {"plain.size": "1", "plain.0.name": "a", "plain.0.id": "0", "plain.0.tag": "t"},
        ),
        (
            "{offsets: {a.b: 1, keys: 2, '': 3}}",
            {
                "offsets.keys": "a%2Eb %6Beys %",
                "offsets.a%2Eb": "1",
                "offsets.%6Beys": "2",
                "offsets.%": "3",
            },
        ),
        ("{speed: .9, on: True}", {"speed": ".9", "on": "True"}),
        ("{speed: 2000., n: 7.0}", {"speed": "2000.", "n": "7"}),
        ("{speed: 0x10, n: 0x10}", {"speed": "16", "n": "16"}),
        ("{note: {env: NOTE}}", {"note": "${env:NOTE}"}),
    ],
)
def test_spellings(tmp_path: Path, parameters: str, expected: dict[str, str]) -> None:
    assert given(tmp_path, parameters) == expected


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ('device: "a\\nb"', "device cannot be a property of Ice: it contains a line end"),
        ('device: "a\\0b"', "device cannot be a property of Ice: it contains a NUL"),
        (
            'note: ""',
            "note cannot be a property of Ice: an empty optional value would be read as a missing one",
        ),
        ('device: ""', "device cannot be a property of Ice: it is empty, but its default is not"),
        ("names: []", "names cannot be a property of Ice: it is empty, but its default is not"),
        ('device: "\\ta"', "device cannot be a property of Ice: it may not start or end with a tab"),
        (
            'device: "${env:X}"',
            "device cannot be a property of Ice: it would be read as a reference to the environment",
        ),
        (
            'motors: [{name: "a,b"}]',
            "motors[0] cannot be a property of Ice: its row, 'a,b,0', would be read differently",
        ),
        ("motors: [{name: a, tag: t}]", "motors[0].tag cannot be a property of Ice: its rows have no column for it"),
        ('excluded: [["a;b"]]', "excluded cannot be a property of Ice: its separators cannot spell 'a;b;'"),
        (
            'plain: [{name: a, tag: ""}]',
            "plain[0].tag cannot be a property of Ice: an empty optional value would be read as a missing one",
        ),
        # By Period.Compute, components take the file for one that has its texts in quotes.
        ("device: '\"a\"'", "device cannot be a property of Ice: its quotes would be removed when it is read"),
        (
            "motors: [{name: '\"a\"'}]",
            "motors[0].name cannot be a property of Ice: its quotes would be removed when it is read",
        ),
        (
            "tags: [{from: 1, to: 2}, {from: 1, to: 2}]",
            "tags[1] cannot be a property of Ice: another row already uses the property ID:1-2",
        ),
    ],
)
def test_what_no_property_can_hold_is_told_at_its_line(tmp_path: Path, line: str, fault: str) -> None:
    _, errors = of(tmp_path, f"parameters:\n  speed: 1\n  {line}\n")
    assert errors == [f"4: {fault}"]


CONNECTIONS = """\
endpoints: {CommonBehavior: tcp -p 1}
proxies: {Mouth: "mouth:tcp -p 2", Head: {proxy: "head:tcp -p 3", key: head}}
topics: {manager: "IceStorm/TopicManager:default -p 9999", prefix: {Heard: lab, Said: ""}, name: {Logger: LoggerTopic}}
ice: {Warn.Connections: 0, MessageSizeMax: "2000"}
properties: {"x y": 1.50}
"""


def test_classic_connections(tmp_path: Path) -> None:
    held, _ = of(tmp_path, "legacy: {file: config}\n" + CONNECTIONS)
    assert held == {
        "CommonBehavior.Endpoints": "tcp -p 1",
        "MouthProxy": "mouth:tcp -p 2",
        "head": "head:tcp -p 3",
        "TopicManager.Proxy": "IceStorm/TopicManager:default -p 9999",
        "Proxies.HeardPrefix": "lab",
        "Logger": "LoggerTopic",
        "Ice.Warn.Connections": "0",
        "Ice.MessageSizeMax": "2000",
        "x y": "1.50",
    }


def test_flat_toml_connections(tmp_path: Path) -> None:
    text = "legacy: {file: config, dialect: flat-toml}\nparameters: {device: a, note: '', speed: .5}\n" + CONNECTIONS
    held, errors = of(tmp_path, text)
    assert errors == []
    assert held == {
        "Endpoints.CommonBehavior": '"tcp -p 1"',
        "Proxies.Mouth": '"mouth:tcp -p 2"',
        "head": '"head:tcp -p 3"',
        "Proxies.TopicManager": '"IceStorm/TopicManager:default -p 9999"',
        "Proxies.HeardPrefix": '"lab"',
        "Proxies.SaidPrefix": '""',
        "Logger": '"LoggerTopic"',
        "Ice.Warn.Connections": "0",
        "Ice.MessageSizeMax": '"2000"',
        "x y": "1.50",
        "Bus.Device": '"a"',
        "note": '""',
        "speed": ".5",
    }


def test_an_exact_spelling_is_used_while_it_means_the_value(tmp_path: Path) -> None:
    exact = 'exact: {Bus.M1: "a,\\t 7", Bus.M2: "b,8", n: "007", speed: "1.0"}'
    text = (
        f"legacy: {{file: config, {exact}}}\nparameters: {{motors: [{{name: a, id: 7}}, {{name: b, id: 9}}], n: 7}}\n"
    )
    held, errors = of(tmp_path, text)
    assert errors == []
    assert held == {"Bus.M1": "a,\t 7", "Bus.M2": "b,9", "Bus.Count": "2", "n": "007"}


def test_two_halves_of_a_configuration_are_joined(tmp_path: Path) -> None:
    held, _ = of(
        tmp_path,
        "legacy: {file: specific_config, after: generic.config.yaml}\nparameters: {n: 1}\n",
        generic="parameters: {n: 9, speed: 2}\nice: {Trace.Network: 1}\n",
    )
    assert held == {"n": "1", "speed": "2", "Ice.Trace.Network": "1"}


def test_all_effective_values_without_a_legacy_file(tmp_path: Path) -> None:
    held, _ = of(tmp_path, "parameters: {n: 1}\n")
    assert held == {
        "Bus.Device": "/dev/x",
        "speed": "0.5",
        "n": "1",
        "on": "true",
        "names.size": "1",
        "names.0": "a",
        "Bus.Count": "0",
        "plain.size": "0",
        "Period.Compute": "100",
        "period.emergency": "500",
    }
