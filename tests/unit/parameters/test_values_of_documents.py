"""Values as documents give them: which fit their parameters, and what is said, at which place, of those that do not."""

from __future__ import annotations

from functools import cache

import pytest

from in_memory import ROOT, pdsl, program, refused, said
from parameters import tree
from robocomp_yaml.parameters.types import Parameters
from verdicts import verdicts

PARAMETERS = (
    "n: {type: int, range: [0, 9], default: 1}, x: {type: float, unit: m, range: {above: 0}, "
    "default: 1}, big: {type: long, default: 0}, dbl: {type: double, default: 0}, "
    "on: {type: bool, default: true}, t: {type: string, pattern: '[a-z]+', default: a}, "
    "free: {type: string, default: a}, one: {type: string, values: [p, q], default: p}, "
    "mode: {type: Mode, default: slow}, few: {type: int, values: [1, 2], default: 1}, "
    "ls: {list: int, size: [1, 3], unique: true, default: [1]}, ll: {list: {list: int}, default: []}, "
    "m: {map: {type: float, unit: s}, size: {to: 2}, default: {}}, motors: {list: Motor, default: []}, "
    "first: {type: Motor, default: {name: a, max: 2}}, g: {group: {low: {type: int, default: 1}, "
    "in: {group: {deep: {type: int, default: 1}}}}}, "
    "pin: {type: int, secret: true, range: [1000, 9999], optional: true}, "
    "password: {type: string, optional: true}, keys: {list: string, secret: true, optional: true}, "
    "need: int"
)
TYPES = (
    "Mode: {enum: [slow, fast]}, Motor: {struct: {name: string, max: {type: float, unit: A}, "
    "tag: {type: string, optional: true}}}"
)
DOCUMENTS = pdsl(PARAMETERS, TYPES)

FITTING = [
    'n: 2.0', 'n: null', 'big: 9223372036854775807', 't: null', 't: {env: X}', 'few: 1.0', 'pin: {env: PIN}', 'password: hunter2', 'keys: [a, a]', "n: 0", "n: 9", "x: 0.001", "x: 3.4028234663852886e38",
    "big: -9223372036854775808", "one: q", "mode: fast", "ls: [3]", "ls: [1, 2, 3]", "m: {}", "m: {a: 1, b: 2.5}",
    "ll: [[], [1, 2]]", "motors: [{name: a, max: 1}, {name: a, max: 1}]", "first: {name: a, max: 1, tag: t}",
    "free: {file: a/b}", "g: {}", "g: {in: {}}", "on: {env: ON}", "ls: [{env: X}]",
    "motors: [{name: {env: X}, max: {env: Y}}]", "m: {a: {file: f}}",
]  # fmt: skip

MISFITS = [
    ('n: 10', 'RC3303', '10', 'n is 10, and must be from 0 to 9', ''),
    ('n: -1', 'RC3303', '-1', 'n is -1, and must be from 0 to 9', ''),
    ('n: 1.5', 'RC3302', '1.5', 'n must be a whole number, and is 1.5', ''),
    ('n: x', 'RC3302', 'x', "n must be a whole number, and is the text 'x'", ''),
    ('n: "3"', 'RC3302', '"3"', "n must be a whole number, and is the text '3'", 'write it without quotes: 3'),
    ('n: true', 'RC3302', 'true', 'n must be a whole number, and is true', ''),
    ('n: [1]', 'RC3302', '[1]', 'n must be a whole number, and is a list', ''),
    ('n: {a: 1}', 'RC3302', '{a: 1}', 'n must be a whole number, and is a mapping', ''),
    ('n: 99999999999', 'RC3303', '99999999999', 'n is 99999999999, and must be from 0 to 9', ''),
    ('x: 0', 'RC3303', '0', 'x is 0 m, and must be above 0 m', ''),
    ('x: "0.5"', 'RC3302', '"0.5"', "x must be a number (m), and is the text '0.5'", 'write it without quotes: 0.5'),
    ('x: .inf', 'RC3302', '.inf', 'x must be a number (m), and is .inf', ''),
    ('x: 1e39', 'RC3303', '1e39', 'x is 1e39 m, and must be from -3.4028234663852886e+38 to 3.4028234663852886e+38 (float)', ''),
    ('x: 1e999', 'RC3302', '1e999', 'x must be a number (m), and is 1e999', ''),
    ('big: 9223372036854775808', 'RC3303', '9223372036854775808', 'big is 9223372036854775808, and must be from -9223372036854775808 to 9223372036854775807 (long)', ''),
    ('dbl: 1e400', 'RC3302', '1e400', 'dbl must be a number, and is 1e400', ''),
    ('on: yes', 'RC3302', 'yes', "on must be true or false, and is the text 'yes'", 'write true'),
    ('on: 1', 'RC3302', '1', 'on must be true or false, and is 1', ''),
    ('on: "true"', 'RC3302', '"true"', "on must be true or false, and is the text 'true'", 'write it without quotes: true'),
    ("on: 'no'", 'RC3302', "'no'", "on must be true or false, and is the text 'no'", 'write false'),
    ('t: A1', 'RC3304', 'A1', "t is 'A1', and must match [a-z]+", ''),
    ('t: 7', 'RC3302', '7', 't must be text, and is 7', 'text needs quotes here: "7"'),
    ('t: true', 'RC3302', 'true', 't must be text, and is true', 'text needs quotes here: "true"'),
    ('t: ""', 'RC3304', '""', "t is '', and must match [a-z]+", ''),
    ('t: {env: 7UP}', 'RC3309', '7UP', 't does not name an environment variable', "a variable's name has letters, digits and underscores, and does not start with a digit"),
    ('t: {env: X, file: y}', 'RC3309', 'file', "t cannot have 'file' beside 'env'", ''),
    ('t: {file: ""}', 'RC3309', '""', 't does not name a file', 'file: is the path of a file that is read when the component starts'),
    ('t: {nev: X}', 'RC3302', '{nev: X}', 't must be text, and is a mapping', ''),
    ('one: r', 'RC3303', 'r', "one is 'r', and must be one of p, q", ''),
    ('one: P', 'RC3303', 'P', "one is 'P', and must be one of p, q", "did you mean 'p'?"),
    ('mode: fats', 'RC3303', 'fats', "mode is 'fats', and must be one of slow, fast", "did you mean 'fast'?"),
    ('mode: 1', 'RC3302', '1', 'mode must be one of slow, fast, and is 1', ''),
    ('mode: FAST', 'RC3303', 'FAST', "mode is 'FAST', and must be one of slow, fast", "did you mean 'fast'?"),
    ('few: 3', 'RC3303', '3', 'few is 3, and must be one of 1, 2', ''),
    ('ls: []', 'RC3305', '[]', 'ls has 0 elements, and must have 1 to 3', ''),
    ('ls: [1, 2, 3, 4]', 'RC3305', '[1, 2, 3, 4]', 'ls has 4 elements, and must have 1 to 3', ''),
    ('ls: [1, 1]', 'RC3306', '1', 'ls contains 1 twice', ''),
    ('ls: [1, 1.0]', 'RC3306', '1.0', 'ls contains 1.0 twice', ''),
    ('ls: [1, x]', 'RC3302', 'x', "ls[1] must be a whole number, and is the text 'x'", ''),
    ('ls: 1', 'RC3302', '1', 'ls must be a list, and is 1', ''),
    ('ls: {a: 1}', 'RC3302', '{a: 1}', 'ls must be a list, and is a mapping', ''),
    ('ll: [[1], 2]', 'RC3302', '2', 'll[1] must be a list, and is 2', ''),
    ('ll: [[1], [x]]', 'RC3302', 'x', "ll[1][0] must be a whole number, and is the text 'x'", ''),
    ('m: {a: 1, b: 2, c: 3}', 'RC3305', '{a: 1, b: 2, c: 3}', 'm has 3 elements, and must have at most 2', ''),
    ('m: {a: x}', 'RC3302', 'x', "m.a must be a number (s), and is the text 'x'", ''),
    ('m: [1]', 'RC3302', '[1]', 'm must be a mapping of names to values, and is a list', ''),
    ('m: 1', 'RC3302', '1', 'm must be a mapping of names to values, and is 1', ''),
    ('motors: [{name: a}]', 'RC3307', '{name: a}', 'motors[0].max has no value, and no default', 'set it to a number (A)'),
    ('motors: [{name: a, max: 1, tga: x}]', 'RC3301', 'tga', "unknown parameter 'motors[0].tga'", "did you mean 'tag'?"),
    ('motors: {name: a, max: 1}', 'RC3302', '{name: a, max: 1}', 'motors must be a list, and is a mapping', ''),
    ('first: {name: a}', 'RC3307', 'first', 'first.max has no value, and no default', 'set it to a number (A)'),
    ('first: [a, 1]', 'RC3302', '[a, 1]', 'first must be a mapping of name, max, tag, and is a list', ''),
    ('first: a', 'RC3302', 'a', "first must be a mapping of name, max, tag, and is the text 'a'", ''),
    ('g: {low: x}', 'RC3302', 'x', "g.low must be a whole number, and is the text 'x'", ''),
    ('g: {lwo: 1}', 'RC3301', 'lwo', "unknown parameter 'g.lwo'", "did you mean 'low'?"),
    ('g: 1', 'RC3302', '1', 'g must be a mapping of low, in, and is 1', ''),
    ('g: [1]', 'RC3302', '[1]', 'g must be a mapping of low, in, and is a list', ''),
    ('g: {in: {deep: x}}', 'RC3302', 'x', "g.in.deep must be a whole number, and is the text 'x'", ''),
    ('g.low: 2', 'RC3301', 'g.low', 'unknown parameter \'["g.low"]\'', 'known keys: n, x, big, dbl, on, t, free, one, mode, few, ls, ll, m, motors, first, g, pin, password, keys, period'),
    ('nn: 1', 'RC3301', 'nn', "unknown parameter 'nn'", "did you mean 'n'?"),
    ('N: 1', 'RC3301', 'N', "unknown parameter 'N'", "did you mean 'n'?"),
    ('pin: 1', 'RC3303', '1', 'pin is ***, and must be from 1000 to 9999', ''),
    ('pin: x', 'RC3302', 'x', 'pin must be a whole number, and is the text ***', ''),
    ('password: 12', 'RC3302', '12', 'password must be text, and is ***', ''),
]  # fmt: skip


def test_what_fits_and_what_does_not() -> None:
    """Each in a document of its own, and all in one analysis."""
    expected = {values: [] for values in FITTING} | {values: [said] for values, *said in MISFITS}
    texts = [f"component: c.cdsl.yaml\nparameters: {{need: 1, {values}}}\n" for values in expected]
    files = {f"v{number}.config.yaml": text for number, text in enumerate(texts)}
    found = said({**DOCUMENTS, **files})
    got = [[list(one[:4]) for one in found if one.file == file] for file in files]
    assert dict(zip(expected, got, strict=True)) == expected


@pytest.mark.parametrize("layer", ["extends: [base.config.yaml]\n", ""])
def test_what_is_required_is_given_by_the_document_or_one_that_it_extends(layer: str) -> None:
    text = f"component: c.cdsl.yaml\n{layer}parameters: {{n: 2}}\n"
    base = {"base.config.yaml": "parameters: {need: 1}\n"} if layer else {}
    found = said({**DOCUMENTS, **base, "c.config.yaml": text}, "c.config.yaml")
    expected = (
        [] if layer else [("RC3307", "parameters", "need has no value, and no default", "set it to a whole number")]
    )
    assert [one[:4] for one in found] == expected


def test_a_layer_alone_needs_not_be_complete_but_right() -> None:
    base = {"base.config.yaml": "component: c.cdsl.yaml\nparameters: {n: 10, first: {max: 2}}\n"}
    top = {
        "c.config.yaml": "component: c.cdsl.yaml\nextends: [base.config.yaml]\nparameters: {need: 1, first: {name: b}}\n"
    }
    found = said({**DOCUMENTS, **base, **top})
    assert [(one.file, one.at, one.message) for one in found] == [
        ("base.config.yaml", "10", "n is 10, and must be from 0 to 9")
    ]


def test_lists_of_a_later_layer_take_the_place_of_earlier_ones_and_mappings_join() -> None:
    """So nothing is wrong with a list or a map as they come to be, and something is with the other ones."""
    base = "component: c.cdsl.yaml\nparameters: {need: 1, ls: [1, 2, 3], m: {a: 1, b: 2}}\n"

    def over(values: str) -> list[str]:
        top = f"component: c.cdsl.yaml\nextends: [base.config.yaml]\nparameters: {{{values}}}\n"
        return [
            one.message for one in said({**DOCUMENTS, "base.config.yaml": base, "c.config.yaml": top}, "c.config.yaml")
        ]

    assert over("ls: [4]") == [] and over("m: {b: 5}") == []
    assert over("m: {c: 3}") == ["m has 3 elements, and must have at most 2"]


@cache
def _parameters() -> Parameters:
    component = program(DOCUMENTS).components[f"{ROOT}/c.cdsl.yaml"]
    assert component.parameters is not None
    return component.parameters.parameters


@pytest.mark.parametrize("values", [one for one in (*FITTING, *(row[0] for row in MISFITS)) if "null" not in one])
def test_all_judges_say_the_same(values: str) -> None:
    """Ours, Cerberus, JSON Schema twice, and what components are generated with."""
    said = verdicts(_parameters(), tree(f"{{need: 1, {values}}}").data)
    assert set(said.values()) == {values in FITTING}, said


@pytest.mark.parametrize(
    ("values", "places"),
    [
        ("n:\n  a: 1\nneed: 1", [("n", "n must be a whole number, and is a mapping")]),
        ("ls:\n- 1\n- 2\n- 3\n- 4\nneed: 1", [("ls", "ls has 4 elements, and must have 1 to 3")]),
        ("m:\n  a: 1\n  b: 2\n  c: 3\nneed: 1", [("m", "m has 3 elements, and must have at most 2")]),
        ("m:\n- 1\n- 2\nneed: 1", [("m", "m must be a mapping of names to values, and is a list")]),
        ("ls:\n  a: 1\n  b: 2\nneed: 1", [("ls", "ls must be a list, and is a mapping")]),
        ("first:\n- a\n- b\nneed: 1", [("first", "first must be a mapping of name, max, tag, and is a list")]),
        ("g:\n- a\n- b\nneed: 1", [("g", "g must be a mapping of low, in, and is a list")]),
        ("m:\n  a:\n  - 1\n  - 2\nneed: 1", [("a", "m.a must be a number (s), and is a list")]),
        ("first:\n  name: a\n  max:\n    x: 1\nneed: 1", [("max", "first.max must be a number (A), and is a mapping")]),
        ("one: |\n  r\n  s\nneed: 1", [("one", "one is 'r\\ns\\n', and must be one of p, q")]),
        ("m: {a: null, b: x}\nneed: 1", [("x", "m.b must be a number (s), and is the text 'x'")]),
        ("m: {a: x, b: null, c: y}\nneed: 1", [
            ("x", "m.a must be a number (s), and is the text 'x'"), ("y", "m.c must be a number (s), and is the text 'y'"),
        ]),
        ("x-mine: {a: 1}\nneed: 1", []),
        ("need: null", [("parameters", "need has no value, and no default")]),
        ("motors: [{name: a, max: null}]\nneed: 1", [("{name: a, max: null}", "motors[0].max has no value, and no default")]),
        ("ll: [[1], null]\nneed: 1", [("null", "ll[1] must be a list, and is empty")]),
    ],
)  # fmt: skip
def test_what_fills_lines_is_told_at_its_key(values: str, places: list[tuple[str, str]]) -> None:
    inside = "\n".join(f"  {line}" for line in values.splitlines())
    text = f"component: c.cdsl.yaml\nparameters:\n{inside}\n"
    found = said({**DOCUMENTS, "c.config.yaml": text}, "c.config.yaml")
    assert [(one.at, one.message) for one in found] == places


@pytest.mark.parametrize(
    ("values", "missing"),
    [
        ("a: [{x: null}]", ["a[0].x"]),
        ("a: [{x: 1, y: null, z: null}]", []),
        ("a: [{x: 1}, {x: null, y: 1}]", ["a[1].x"]),
        ("m: {k: [{x: null}]}", ["m.k[0].x"]),
        ("l: [[{x: null}]]", ["l[0][0].x"]),
        ("d: [{in: {x: null}}]", ["d[0].in.x"]),
        ("d: [{in: null}]", ["d[0].in"]),
        ("s: {in: null}", ["s.in"]),
        ("s: null", []),
    ],
)
def test_null_is_as_good_as_nothing_also_inside_of_lists(values: str, missing: list[str]) -> None:
    """So that a default holds, and what has none has no value: a component would not start with it."""
    documents = pdsl(
        "a: {list: T, default: []}, m: {map: {list: T}, default: {}}, l: {list: {list: T}, default: []}, "
        "d: {list: D, default: []}, s: {type: D, default: {in: {x: 1}}}",
        "T: {struct: {x: int, y: {type: int, default: 2}, z: {type: int, optional: true}}}, D: {struct: {in: T}}",
    )
    assert refused(documents, values) == [f"{path} has no value, and no default" for path in missing]
