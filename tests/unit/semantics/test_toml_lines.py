"""TOML as properties, without the standard library's reader, which the oldest supported Python does not have."""

from __future__ import annotations

import pytest

from robocomp_yaml.semantics.toml_lines import properties

TEXT = r"""
# a comment = 1
rate = 10 # Hz
say = "one # two"
path = 'C:\dir'
[Proxies]
Arm.Left = "arm:tcp -p 1"
"odd key" = true
[ Deep . "er one" ] # of two parts
list = [1, # one
  2]
rows = [[1, 2],
        [3, 4]]
empty = ""
[[Motor]]
id = 1
[[Motor]]
id = 2
"""


def test_tables_are_part_of_keys() -> None:
    assert properties(TEXT) == {
        "rate": "10",
        "say": '"one # two"',
        "path": '"C:\\dir"',
        "Proxies.Arm.Left": '"arm:tcp -p 1"',
        "Proxies.odd key": "true",
        "Deep.er one.list": "[1, 2]",
        "Deep.er one.rows": "[[1, 2], [3, 4]]",
        "Deep.er one.empty": '""',
        "Motor.0.id": "1",
        "Motor.1.id": "2",
    }


@pytest.mark.parametrize("line", ["a", "= 1", "a =", "a = # 1", "[a", "[]", 'a = "', "a = ["])
def test_a_line_that_is_no_toml_is_skipped(line: str) -> None:
    found = properties(f"first = 1\n{line}\n")
    assert found["first"] == "1" and set(found) <= {"first", "a"}
