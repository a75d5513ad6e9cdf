"""TOML configs: their tables, and values that equal those of `tomllib`."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]

CONFIG = """\
# RSHELIOS=0
model = 1
address = "10.0.0.1"

# decimals with "."
rx = 0.10  # the x
big = 1_000
hex = 0xFF

[Endpoints]
# served
Lidar3D = "tcp -p 11990" # FILTER"
JoystickPrefix = ""

[Proxies]
TopicManager = "IceStorm/TopicManager:default -p 9999"
Lidar3D = "lidar3d:tcp -h localhost -p 11988"
CameraPubPrefix = "zed"

[Period]
Compute = 50
Emergency = 500

[Ice]
Warn.Connections = "0"
MessageSizeMax = 20004800

[ViewAgent]
2d = true
'a key' = 'C:\\x'

[Filter.Deep]
extrinsic = [0.0, -0.075, 1.5]
accepted = [   # labels
  "chair",     # any
  "table",
]
text = \"\"\"
two
lines\"\"\"
point = {x = 1, y = 2}

[[Motors]]
name = "a"
[[Motors]]
name = "b"
zero = 0.5
"""


def test_tables_become_sections_and_parameters(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"etc/config.toml": CONFIG.replace('text = """\ntwo\nlines"""\n', "")})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0, result.output
    text = (tmp_path / "etc/config.toml.config.yaml").read_text().split("\n", 1)[1]
    assert (
        text
        == """\
component: config.toml.pdsl.yaml
parameters:
  # RSHELIOS=0
  model: 1
  address: 10.0.0.1

  # decimals with "."
  rx: 0.10  # the x
  big: 1000
  hex: 255
  period:
    compute: 50
    emergency: 500
  ViewAgent:
    2d: true
    a_key: C:\\x
  Filter:
    Deep:
      extrinsic: [0.0, -0.075, 1.5]
      accepted:  # labels
        - chair  # any
        - table
      point:
        x: 1
        y: 2
  Motors:
    - {name: a}
    - {name: b, zero: 0.5}
endpoints:
  # served
  Lidar3D: tcp -p 11990  # FILTER"
proxies:
  Lidar3D: lidar3d:tcp -h localhost -p 11988
topics:
  manager: IceStorm/TopicManager:default -p 9999
  prefix:
    CameraPub: zed
ice:
  Warn.Connections: "0"
  MessageSizeMax: 20004800
properties:
  Endpoints.JoystickPrefix: '""'
legacy: {file: config.toml, dialect: toml}
"""
    )
    assert rcyaml("check", ".").exit_code == 0
    exported = rcyaml("config", "export", "--as", "toml", "etc/config.toml.config.yaml")
    assert exported.exit_code == 0, exported.output
    again, meant = tomllib.loads(exported.stdout), tomllib.loads((tmp_path / "etc/config.toml").read_text())
    assert again == meant


@pytest.mark.parametrize(("text", "code"), [
    ("a = 1\na = 2\n[T]\n", "RC5003"), ("[T]\nx = \n", "RC5003"), ("[T]\nx = nope\n", "RC5003"),
    ("a = " + "[" * 400 + "]" * 400 + "\n", "RC5003"),
    ("[project]\nname = 'x'\n", "RC5004"), ("# nothing\n", "RC5002"),
])  # fmt: skip
def test_files_that_are_not_configs_are_rejected(rcyaml: Run, tmp_path: Path, text: str, code: str) -> None:
    write_tree(tmp_path, {"config.toml": text})
    result = rcyaml("migrate", "config.toml")
    assert result.exit_code == 1 and f"error[{code}]" in result.output, result.output
    assert [path.name for path in tmp_path.rglob("*.yaml")] == []


def test_a_number_among_texts_is_reported(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"config.toml": "[T]\nmixed = [1, 'a']\n"})
    result = rcyaml("migrate", "config.toml")
    assert result.exit_code == 0 and "RC5028" in result.output
    assert 'mixed: ["1", a]\n' in (tmp_path / "config.toml.config.yaml").read_text()


def test_dates_and_infinities_are_reported(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"config.toml": "[T]\nday = 2024-01-31\nmost = inf\n"})
    result = rcyaml("migrate", "config.toml")
    assert result.exit_code == 0 and result.output.count("RC5005") == 2
    assert "day: 2024-01-31\n    most: inf\n" in (tmp_path / "config.toml.config.yaml").read_text()
    assert rcyaml("check", ".").exit_code == 0
