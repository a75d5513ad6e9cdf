"""A first document of values holds values that fit: their types, their limits, and what holds between them."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from in_memory import pdsl
from robocomp_yaml.api.values import Values, write_new
from robocomp_yaml.diag.diagnostic import has_errors

TYPES = (
    "Mode: {enum: [slow, fast, off]}, "
    "M: {struct: {name: string, low: int, high: {type: int, default: 1}, tag: {type: string, optional: true}}}"
)
UNUSED = {"rcyaml.yaml": "lint: {RC3107: 'off'}\n"}


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def first_values(parameters: str, constraints: str) -> tuple[str, bool, str]:
    """What `config new` writes, as `config show` says it, whether it fits, and its text."""
    listed = [each.replace("'", "''") for each in constraints.split(", ") if each]
    more = f"constraints: [{', '.join(f'{chr(39)}{each}{chr(39)}' for each in listed)}]\n"
    write_tree(Path(), {**pdsl(parameters, TYPES, more if listed else ""), **UNUSED})
    written = Values(write_new("c.cdsl.yaml"))
    shown = [] if has_errors(written.diagnostics) else written.rows()
    values = "; ".join(f"{row.path} = {row.text}" for row in shown if not row.path.startswith("period"))
    return values, not has_errors(written.diagnostics), Path(written.file).read_text()


@pytest.mark.parametrize(
    ("parameters", "constraints", "values"),
    [
        ('a: int, b: int', 'a < b', 'a = 0; b = 1'),
        ('a: int, b: int, c: int', 'a < b, b < c', 'a = 0; b = 1; c = 2'),
        ('a: int', 'a > 10', 'a = 11'),
        ('a: {type: int, range: {above: 4}}', '', 'a = 5'),
        ('a: {type: int, range: {below: -4}}', '', 'a = -5'),
        ('a: {type: float, range: {below: -4}}', '', 'a = -5'),
        ('a: {type: float, range: {above: 1, below: 2}}', '', 'a = 1.5'),
        ('a: {type: float, range: {above: 7}}', '', 'a = 8'),
        ('a: {type: int, range: [-9, -3]}', '', 'a = -9'),
        ('a: {type: int, range: {above: -9, to: -3}}', '', 'a = -3'),
        ('a: {type: int, range: [-3, 3]}', '', 'a = 0'),
        ('a: {type: float, range: [0, 1]}', 'a * 2 == 1', 'a = 0.5'),
        ('a: float', 'a * 2 == 5', 'a = 2.5'),
        ('a: int, b: float', 'a == b + 2', 'a = 0; b = -2'),
        ('t: string', "t == 'abc'", 't = abc'),
        ('t: string, u: string', 't != u', 't = text; u = text2'),
        ('t: {type: string, values: [x, y, z]}, u: {type: string, values: [x, y]}', 't != u', 't = x; u = "y"'),
        ("t: {type: string, pattern: '[a-c][0-9]'}, u: {type: string, pattern: '[a-c][0-9]'}", 't != u', 't = a0; u = a1'),
        ('mode: Mode', "mode != 'slow'", 'mode = fast'),
        ("mode: {type: Mode, range: [fast, 'off']}, other: Mode", "mode != other, other != 'slow'", 'mode = fast; other = "off"'),
        ('on: bool, off: bool', 'on != off', 'on = false; off = true'),
        ('on: bool, n: int', 'not on or n > 3, on', 'on = true; n = 4'),
        ('ls: {list: int}', 'len(ls) == 3', 'ls[0] = 0; ls[1] = 0; ls[2] = 0'),
        ('ls: {list: int, unique: true, size: 3}', '', 'ls[0] = 0; ls[1] = 1; ls[2] = -1'),
        ('ls: {list: int}', 'len(ls) == 3, unique(ls), all(x > 2 for x in ls)', 'ls[0] = 3; ls[1] = 4; ls[2] = 5'),
        ('ls: {list: int, size: [2, 5]}', 'ls[1] > ls[0]', 'ls[0] = 0; ls[1] = 1'),
        ('ls: {list: {list: int, size: 2}, size: 2}', 'ls[1][0] > 3', 'ls[0][0] = 0; ls[0][1] = 0; ls[1][0] = 4; ls[1][1] = 0'),
        ('m: {map: int}', "'left' in m", 'm.left = 0'),
        ('m: {map: int, size: 2}', 'all(v > 4 for v in values(m))', 'm.name = 5; m.name1 = 5'),
        ('m: {map: {list: int, size: 2}}', 'len(m) == 2', 'm.name[0] = 0; m.name[1] = 0; m.name1[0] = 0; m.name1[1] = 0'),
        ('a: {type: int, default: 5}, b: int', 'b > a', 'a = 5; b = 6'),
        ('motors: {list: M}', 'len(motors) == 2, unique(m.name for m in motors), all(m.low < m.high for m in motors)', 'motors[0].name = text; motors[0].low = 0; motors[0].high = 1; motors[1].name = text2; motors[1].low = 0; motors[1].high = 1'),
        ('first: M, second: M', 'first.low < second.low, first.name != second.name', 'first.name = text; first.low = 0; first.high = 1; second.name = text2; second.low = 1; second.high = 1'),
        ('g: {group: {a: int, h: {group: {b: int}}}}', 'g.a > g.h.b', 'g.a = 0; g.h.b = -1'),
        ('from: {type: int, as: start}, to: {type: int, as: end}', 'start < end', 'from = 0; to = 1'),
        ('pin: {type: int, secret: true}, n: int', 'pin > 3, n > 3', 'pin = {env: PIN}; n = 4'),
        ('password: string, apiKey: {list: string, size: 2, secret: true}, 2nd-token: {type: string, as: token}', '', 'password = {env: PASSWORD}; apiKey[0] = {env: API_KEY_0}; apiKey[1] = {env: API_KEY_1}; 2nd-token = {env: SECRET_2ND_TOKEN}'),
        ('a: int, b: int', 'a + b == 7, a - b == 1', 'a = 4; b = 3'),
        ('a: int', 'a % 4 == 3, a > 9', 'a = 99'),
    ],
)  # fmt: skip
def test_they_fit(parameters: str, constraints: str, values: str) -> None:
    assert first_values(parameters, constraints)[:2] == (values, True)


def test_where_nothing_is_found_that_fits_a_person_is_asked() -> None:
    shown, fits, text = first_values("a: int", "a > 5, a < 5")
    assert (shown, fits) == ("", False)
    assert "  # no example satisfies the constraints: set a value\n  # a:\n" in text
