"""What a document of parameters comes to: a schema for editors, a first document of values, a config, and documentation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Golden = Callable[[str, Mapping[str, str]], None]

PDSL = """\
component: arm.cdsl.yaml
doc: An arm.
types:
  Mode: {enum: {slow: {doc: Careful.}, fast: , off: }, doc: How fast.}
  Joint:
    doc: One of many.
    struct:
      name: {type: string, pattern: "[a-z][a-z0-9]*", doc: Its name.}
      low: {type: float, unit: rad, range: [-3.14, 3.14]}
      high: {type: float, unit: rad, range: [-3.14, 3.14]}
      tag: {type: string, optional: true}
  Some: {list: {type: int, range: {above: 0}}, size: [1, 3], unique: true}
parameters:
  mode: {type: Mode, default: fast, doc: How it moves.}
  safe: {type: Mode, range: {below: "off"}}
  joints: {list: Joint, size: 2, editable: true, doc: "From the base on.\\nIn order."}
  some: {type: Some, optional: true}
  gripper:
    doc: Its hand.
    group:
      force: {type: double, unit: N, values: [1, 2.5]}
      span: {type: float, unit: mm, range: {above: 0, below: 0.5}}
      "on": {type: bool, as: is_on}
  password: {type: string, optional: true}
  pin: {list: {type: int, range: [1000, 9999]}, secret: true}
  names: {map: string, size: {from: 1, to: 2}}
  low: int
  high: {type: int, range: [5, 100]}
  wait: {type: long, unit: ms, range: {below: 0}}
  device: {type: string, pattern: "/dev/tty[A-Z]{3}[0-9]"}
  sides: {list: Mode, size: 3, unique: true}
  grid: {list: {list: int, size: 2}, size: 2}
  text: {type: string, values: [b, a], default: b}
constraints:
  - low < high
  - low >= 3
  - {that: all(j.low < j.high for j in joints), else: a joint's low must be below its high}
  - unique(j.name for j in joints)
  - len(grid) > 1
"""
CDSL = "component: ArmComp\nlanguage: python\nperiod: 20 ms\n"


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    return write_tree(tmp_path, {"arm/arm.cdsl.yaml": CDSL, "arm/arm.pdsl.yaml": PDSL})


def test_its_first_values_fit_and_say_what_each_is(arm: Path, rcyaml: Callable[..., Result], golden: Golden) -> None:
    assert rcyaml("config", "new", "arm").exit_code == 0
    made = (arm / "arm/etc/config.yaml").read_text(encoding="utf-8")
    checked = rcyaml("config", "check", "arm/etc/config.yaml")
    assert checked.exit_code == 0, checked.output
    shown = rcyaml("config", "show", "arm/etc/config.yaml").stdout
    toml = rcyaml("config", "export", "arm/etc/config.yaml", "--as", "toml").stdout
    golden("parameters/values", {"config.yaml": made, "shown.txt": shown, "config.toml": toml})


def test_what_is_generated_of_them(arm: Path, rcyaml: Callable[..., Result], golden: Golden) -> None:
    compiled = rcyaml("compile", "arm")
    assert compiled.exit_code == 0, compiled.output
    folder = arm / "arm"
    schemas = {path.name: path.read_text(encoding="utf-8") for path in folder.rglob("config.schema.json")}
    lines = (folder / "etc/config").read_text(encoding="utf-8").splitlines()
    own = "\n".join(line for line in lines if "Endpoints" not in line and "Generated" not in line) + "\n"
    pages = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.rglob("parameters.md"))}
    assert schemas and pages
    golden("parameters/made", {"config": own, **schemas, **pages})
