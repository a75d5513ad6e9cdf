"""Constraints: their results for values, wrong constraints, and the locations and words of their diagnostics."""

from __future__ import annotations

import pytest

from in_memory import analysed, pdsl, refused, said

PARAMETERS = (
    "n: {type: int, default: 1}, x: {type: float, default: 0.5}, on: {type: bool, default: true}, "
    "t: {type: string, default: a}, mode: {type: Mode, default: slow}, ls: {list: int, default: [1, 2]}, "
    "m: {map: float, default: {}}, motors: {list: Motor, default: []}, "
    "first: {type: Motor, default: {name: a, max: 2}}, g: {group: {low: {type: int, default: 1}}}"
)
TYPES = "Mode: {enum: [slow, fast]}, Motor: {struct: {name: string, max: float}}"
LISTED = "use comparisons, arithmetic, and, or, not, in, and the functions that docs/pdsl.md lists"


def constrained(*constraints: str, parameters: str = PARAMETERS, types: str = TYPES) -> dict[str, str]:
    quoted = ", ".join("'" + constraint.replace("'", "''") + "'" for constraint in constraints)
    return pdsl(parameters, types, f"constraints: [{quoted}]\n")


@pytest.mark.parametrize(
    ("constraint", "rest", "message", "hint"),
    [
        ('n', 'n', 'a constraint must be true or false, and this is a number', 'compare it: … > 0'),
        ('ls', 'ls', 'a constraint must be true or false, and this is a list', 'compare it: … > 0'),
        ('first', 'first', 'a constraint must be true or false, and this is a Motor', 'compare it: … > 0'),
        ('g', 'g', 'a constraint must be true or false, and this is a group', 'compare it: … > 0'),
        ('mode', 'mode', 'a constraint must be true or false, and this is one of Mode', 'compare it: … > 0'),
        ('t + 1 == 2', 't + 1 == 2', "'+' needs a number here, and this is text", ''),
        ('on + 1 == 2', 'on + 1 == 2', "'+' needs a number here, and this is true or false", ''),
        ('1 - ls == 2', 'ls == 2', "'-' needs a number here, and this is a list", ''),
        ('-t == 1', 't == 1', "'-' needs a number here, and this is text", ''),
        ('not n', 'n', "'not' needs true or false here, and this is a number", ''),
        ('not n == 1 and t', 't', "'and' needs true or false here, and this is text", ''),
        ('n and on', 'n and on', "'and' needs true or false here, and this is a number", ''),
        ('on or t', 't', "'or' needs true or false here, and this is text", ''),
        ('n == t', 't', "'==' cannot compare a number with text", ''),
        ('n == on', 'on', "'==' cannot compare a number with true or false", ''),
        ('on == t', 't', "'==' cannot compare true or false with text", ''),
        ('ls == 1', '1', "'==' cannot compare a list with a number", ''),
        ('ls == ls', 'ls', "'==' cannot compare a list with a list", ''),
        ('mode == 1', '1', "'==' cannot compare one of Mode with a number", ''),
        ('mode == "slo"', '"slo"', "unknown enumerator 'slo' of Mode", "did you mean 'slow'?"),
        ('"turbo" == mode', '"turbo" == mode', "unknown enumerator 'turbo' of Mode", 'there are: slow, fast'),
        ('mode in ["slow", "fsat"]', '"fsat"]', "unknown enumerator 'fsat' of Mode", "did you mean 'fast'?"),
        ('mode in ["slow", 1]', '1]', 'a list cannot contain both text and a number', ''),
        ('n in [1, "a"]', '"a"]', 'a list cannot contain both a number and text', ''),
        ('n in []', '[]', 'an empty list contains nothing to compare with', ''),
        ('n in 3', '3', "'in' needs a list or a map here, and this is a number", ''),
        ('n not in t', 't', "'not in' needs a list or a map here, and this is text", ''),
        ('t in m and 1 in m', 'm', "'in' cannot compare a number with text", ''),
        ('1 in ["a"]', '["a"]', "'in' cannot compare a number with text", ''),
        ('t < t', 't < t', "'<' compares numbers, and this is text", ''),
        ('n < t', 't', "'<' cannot compare a number with text", ''),
        ('mode < mode', 'mode < mode', "'<' compares numbers, and this is one of Mode", ''),
        ('on < on', 'on < on', "'<' compares numbers, and this is true or false", ''),
        ('1 < n < t', 't', "'<' cannot compare a number with text", ''),
        ('n.low == 1', 'low == 1', "a number has no members, so no 'low'", ''),
        ('g.lo == 1', 'lo == 1', "unknown member 'lo'", "did you mean 'low'?"),
        ('first.mxa > 1', 'mxa > 1', "unknown member 'mxa'", "did you mean 'max'?"),
        ('motors.max > 1', 'max > 1', "a list has no members, so no 'max'", "select an element with [0], or loop over the elements with 'for'"),
        ('m.max > 1', 'max > 1', "a map has no members, so no 'max'", ''),
        ('t.max > 1', 'max > 1', "text has no members, so no 'max'", ''),
        ('ls["a"] == 1', '"a"] == 1', 'an element of a list is selected by its number, counted from 0', ''),
        ('ls[x] == 1', 'x] == 1', 'an element of a list is selected by its number, counted from 0', ''),
        ('ls[-1] == 1', '-1] == 1', 'an element of a list is selected by its number, counted from 0', ''),
        ('m[1] > 0', '1] > 0', "'[]' needs text here, and this is a number", ''),
        ('n[0] == 1', 'n[0] == 1', 'a number has no elements', ''),
        ('g[0] == 1', 'g[0] == 1', 'a group has no elements', ''),
        ('len(n) > 1', 'n) > 1', 'len() needs a list or a map here, and this is a number', ''),
        ('len(t) > 1', 't) > 1', 'len() needs a list or a map here, and this is text', ''),
        ('abs(t) > 1', 't) > 1', 'abs() needs a number here, and this is text', ''),
        ('abs(ls) > 1', 'ls) > 1', 'abs() needs a number here, and this is a list', ''),
        ('keys(ls) == 1', 'ls) == 1', 'keys() needs a map here, and this is a list', ''),
        ('values(n) == 1', 'n) == 1', 'values() needs a map here, and this is a number', ''),
        ('keys(m) == 1', '1', "'==' cannot compare a list with a number", ''),
        ('min(t) > 1', 't) > 1', 'min() needs a list here, and this is text', ''),
        ('min(motors) > 1', 'motors) > 1', 'min() needs numbers here, and this is a Motor', ''),
        ('min(n, t) > 1', 't) > 1', "'min()' needs a number here, and this is text", ''),
        ('max(n, on) > 1', 'on) > 1', "'max()' needs a number here, and this is true or false", ''),
        ('sum(t) > 1', 't) > 1', 'sum() needs a list here, and this is text', ''),
        ('sum(o.name for o in motors) > 1', 'name for o in motors) > 1', 'sum() needs numbers here, and this is text', ''),
        ('all(ls)', 'ls)', 'all() needs true or false here, and this is a number', ''),
        ('any(o.max for o in motors)', 'max for o in motors)', 'any() needs true or false here, and this is a number', ''),
        ('all(n)', 'n)', 'all() needs a list here, and this is a number', ''),
        ('unique(motors)', 'motors)', 'unique() needs plain values here, and this is a Motor', ''),
        ('unique(n)', 'n)', 'unique() needs a list here, and this is a number', ''),
        ('unique(o for o in motors)', 'o for o in motors)', 'unique() needs plain values here, and this is a Motor', ''),
        ('has(1)', 'has(1)', 'has() needs the name of a parameter, member or element', ''),
        ('has(n + 1)', 'has(n + 1)', 'has() needs the name of a parameter, member or element', ''),
        ('has(nn)', 'nn)', "unknown parameter 'nn'", "did you mean 'n'?"),
        ('has(g.lo)', 'lo)', "unknown member 'lo'", "did you mean 'low'?"),
        ('all(o > 1 for o in m)', 'm)', "'for' needs a list here, and this is a map", 'use keys(…) or values(…) of the map'),
        ('all(o > 1 for o in n)', 'n)', "'for' needs a list here, and this is a number", ''),
        ('all(o > 1 for o in ls if o)', 'o)', "'if' needs true or false here, and this is a number", ''),
        ('all(p > 1 for o in ls)', 'p > 1 for o in ls)', "unknown parameter 'p'", 'there are: o, n, x, on, t, mode, ls, m, motors, first, g, period'),
        ('all(o.mxa > 1 for o in motors)', 'mxa > 1 for o in motors)', "unknown member 'mxa'", "did you mean 'max'?"),
        ('nn > 1', 'nn > 1', "unknown parameter 'nn'", "did you mean 'n'?"),
        ('N > 1', 'N > 1', "unknown parameter 'N'", "did you mean 'n'?"),
        ('n ** 2 > 1', 'n ** 2 > 1', 'powers are not supported', LISTED),
        ('n // 2 > 1', 'n // 2 > 1', "'//' is not supported", LISTED),
        ('n is 1', 'is 1', 'this is not an expression', ''),
        ('n > None', 'None', "unknown parameter 'None'", "did you mean 'on'?"),
        ('n > 1j', '1j', 'this value is not supported', LISTED),
        ('foo(n) > 1', 'foo(n) > 1', "unknown function 'foo'", 'there are: len, min, max, abs, sum, all, any, unique, has, keys, values'),
        ('mni(ls) > 1', 'mni(ls) > 1', "unknown function 'mni'", "did you mean 'min'?"),
        ('len() > 1', 'len() > 1', 'len() needs one argument', ''),
        ('len(ls, ls) > 1', 'len(ls, ls) > 1', 'len() needs one argument', ''),
        ('abs(n, n) > 1', 'abs(n, n) > 1', 'abs() needs one argument', ''),
        ('min(n, o for o in ls) > 1', 'o for o in ls) > 1', 'this is not an expression', ''),
        ('len(o for o in ls) > 1', '(o for o in ls) > 1', "len() does not accept 'for'", 'min, max, sum, all, any, unique do'),
        ('all(o > 1 for o in ls if o > 0 if o > 2)', '(o > 1 for o in ls if o > 0 if o > 2)', "only one 'for' and one 'if' are supported here", 'nest a second all() or any()'),
        ('all(o > p for o in ls for p in ls)', '(o > p for o in ls for p in ls)', "only one 'for' and one 'if' are supported here", 'nest a second all() or any()'),
        ('all(o > p for o, p in ls)', 'o, p in ls)', "'for' needs one variable", ''),
        ('(o > 1 for o in ls)', '(o > 1 for o in ls)', "'for' is supported only inside all(), any(), sum(), min(), max() and unique()", LISTED),
        ('[o > 1 for o in ls]', '[o > 1 for o in ls]', "'for' is supported only inside all(), any(), sum(), min(), max() and unique()", LISTED),
        ('n if on else x', 'n if on else x', 'this is not an expression', ''),
        ('ls[0:1] == 1', 'ls[0:1] == 1', 'only one element of a list or map can be selected', LISTED),
        ('ls[0, 1] == 1', 'ls[0, 1] == 1', 'only one element of a list or map can be selected', LISTED),
        ('g.low() > 1', 'g.low() > 1', "only the functions of constraints can be called", LISTED),
        ('t.upper() == "A"', 't.upper() == "A"', "only the functions of constraints can be called", LISTED),
        ('lambda: 1', ': 1', 'this is not an expression', ''),
        ('n > 1 && on', '&& on', "'&&' is not an operator", "write 'and'"),
        ('n > 1 || on', '|| on', "'||' is not an operator", "write 'or'"),
        ('!on', '!on', "'!' is not an operator", "write 'not'"),
        ('n = 1', '= 1', "'=' is not an operator", "write '=='"),
        ('n >', 'n >', 'this is not an expression', ''),
        ('(n > 1', '(n > 1', 'this is not an expression', ''),
        ('n > 1)', ')', 'this is not an expression', ''),
        ('"a = b', '= b', "'=' is not an operator", "write '=='"),
        ('t == "x = y" && on', '&& on', "'&&' is not an operator", "write 'and'"),
        ('n >> 1', 'n >> 1', 'this is not supported in a constraint', LISTED),
        ('{n}', '{n}', 'this is not supported in a constraint', LISTED),
        ('f"{n}" == t', 'f"{n}" == t', 'this is not supported in a constraint', LISTED),
        ('len(ls, key=1) > 1', 'len(ls, key=1) > 1', "only the functions of constraints can be called", LISTED),
        ('ls[*ls] == 1', 'ls[*ls] == 1', 'only one element of a list or map can be selected', LISTED),
        ('n <> 1', '<> 1', 'this is not an expression', ''),
    ],
)  # fmt: skip
def test_a_wrong_part_is_rejected_at_its_start(constraint: str, rest: str, message: str, hint: str) -> None:
    (found,) = analysed(constrained(constraint), "c.pdsl.yaml").diagnostics
    begins = found.span.column - 1 - len("constraints: ['")
    assert (found.code, constraint[begins:], found.message, str(found.hint)) == ("RC3119", rest, message, hint)


def test_a_constraint_that_is_too_long_or_too_deep_is_rejected() -> None:
    for constraint, message in (
        ("n > 1" + " " * 2000, "an expression has at most 2000 characters"),
        ("-" * 60 + "n > 1", "this expression is nested too deeply"),
    ):
        (found,) = analysed(constrained(constraint), "c.pdsl.yaml").diagnostics
        assert found.message == message
    assert not analysed(constrained("-" * 40 + "n != 0"), "c.pdsl.yaml").diagnostics
    assert not analysed(constrained("n > 0" + " " * (2000 - len("n > 0"))), "c.pdsl.yaml").diagnostics


def test_locations_after_letters_that_are_not_ascii() -> None:
    (found,) = analysed(constrained('t == "ñandú" and nn > 1'), "c.pdsl.yaml").diagnostics
    assert found.span.column - 1 - len("constraints: ['") == len('t == "ñandú" and ')


VALUES = "low: int, high: int, part: float, on: bool, name: string, mode: Mode, ls: {list: int}, m: {map: float}, " + (
    "motors: {list: Motor}, note: {type: string, optional: true}, is: {type: int, default: 3}"
)
GIVEN = "low: 2, high: 5, part: 0.5, on: true, name: arm, mode: fast, ls: [3, 1, 2], m: {x: 1.5, y: 2.5}, " + (
    "motors: [{name: a, max: 1}, {name: b, max: 2}]"
)


@pytest.mark.parametrize(
    "constraint",
    [
        "low < high", "low <= 2", "high > low", "high >= 5", "low == 2", "low != 3", "low < 3 < high", "1 < low <= 2",
        "low + high == 7", "high - low == 3", "low * high == 10", "high / low == 2.5", "high % low == 1",
        "-high % 3 == 1", "-low == -2", "+low == 2", "low + 1 < high * 2", "part * 2 == 1", "high / 5 == 1",
        "on", "not (not on)", "on and low == 2", "on or low == 3", "low == 3 or on", "not (low == 3 and on)",
        "on == true", "on != false", "on and true",
        'name == "arm"', 'name != "leg"', 'name in ["leg", "arm"]', 'name not in ["leg"]', 'mode == "fast"',
        'mode in ["fast"]', "low in [1, 2]", "low in ls", "high not in ls", '"x" in m', '"z" not in m', "low in (1, 2)",
        "ls[0] == 3", "ls[2] == 2", 'm["x"] == 1.5', "motors[1].max == 2", 'motors[0].name == "a"',
        "len(ls) == 3", "len(m) == 2", "min(ls) == 1", "max(ls) == 3", "sum(ls) == 6", "abs(low - high) == 3",
        "min(low, high) == 2", "max(low, high, 9) == 9", "abs(-part) == 0.5", "sum(values(m)) == 4",
        'all(k in ["x", "y"] for k in keys(m))', 'any(k == "y" for k in keys(m))',
        "all(one > 0 for one in ls)", "any(one > 2 for one in ls)", "all(one > 1 for one in ls if one != 1)",
        "sum(one for one in ls if one > 1) == 5", "max(o.max for o in motors) == 2", "unique(ls)",
        "unique(o.name for o in motors)", "all(any(o.max == one for o in motors) for one in [1, 2])",
        "not has(note) and low == 2", "is + low == 5", "period.compute == 50 * low",
    ],
)  # fmt: skip
def test_constraints_that_hold(constraint: str) -> None:
    """The negation of each is reported."""
    documents = constrained(constraint, f"not ({constraint})", parameters=VALUES)
    assert refused(documents, GIVEN) == [f"this must hold: not ({constraint})"]


@pytest.mark.parametrize(
    ("values", "holds"),
    [
        ("low: 1, high: 2", True),
        ("low: 2, high: 2", False),
        ("low: 3", False),
        ("high: 0", False),
        ("", True),
    ],
)
def test_a_constraint_is_about_set_values_and_defaults(values: str, holds: bool) -> None:
    parameters = "low: {type: int, default: 1}, high: {type: int, default: 2}"
    more = "constraints: [{that: low < high, else: low must be below high}]\n"
    assert refused(pdsl(parameters, more=more), values) == ([] if holds else ["low must be below high"])


def test_defaults_that_violate_a_constraint() -> None:
    documents = pdsl("low: {type: int, default: 3}, high: {type: int, default: 2}", more="constraints: [low < high]\n")
    (found,) = analysed(documents, "c.pdsl.yaml").diagnostics
    assert (found.code, found.message) == ("RC3120", "the defaults break this constraint: this must hold: low < high")


@pytest.mark.parametrize("constraint", ["high / low > 1", "high % low == 0", "ls[5] == 1", 'm["z"] > 0', "min(ls) > 0"])
def test_a_constraint_that_cannot_be_computed_does_not_hold(constraint: str) -> None:
    documents = constrained(constraint, parameters="low: int, high: int, ls: {list: int}, m: {map: int}", types="")
    assert len(refused(documents, "low: 0, high: 4, ls: [], m: {}")) == 1


@pytest.mark.parametrize(
    "constraint", ["all(one > 9 for one in ls)", "not any(one > 0 for one in ls)", "unique(ls)", "sum(ls) == 0"]
)
def test_quantifiers_over_nothing(constraint: str) -> None:
    assert refused(constrained(constraint, parameters="ls: {list: int}", types=""), "ls: []") == []


@pytest.mark.parametrize(
    ("values", "holds"), [("", True), ("note: x", False), ("note: {env: NOTE}", True), ("note: x, names: [x]", True)]
)
def test_a_constraint_on_whether_a_value_is_set(values: str, holds: bool) -> None:
    """The value of a reference is known only when the component runs."""
    parameters = "note: {type: string, optional: true}, names: {list: string, default: []}"
    documents = pdsl(
        parameters, more="constraints: [{that: not has(note) or note in names, else: a note has a name}]\n"
    )
    assert refused(documents, values) == ([] if holds else ["a note has a name"])


def test_a_constraint_uses_names_in_code() -> None:
    documents = pdsl(
        "from: {type: int, as: start, default: 1}, g: {group: {a-b: {type: int, as: ab, default: 2}}}",
        more="constraints: [start < g.ab]\n",
    )
    assert refused(documents, "from: 1") == []
    assert refused(documents, "from: 2") == ["this must hold: start < g.ab"]


OPTIONAL = (
    "user: {type: string, optional: true}, key: {type: string, optional: true}, ls: {list: string, default: [a]}, "
    "low: int, r: {list: int}, first: {type: T, optional: true}, need: T"
)
T = "T: {struct: {x: int, tag: {type: string, optional: true}}}"


@pytest.mark.parametrize(
    ("constraint", "values", "holds"),
    [
        ("not has(user) or has(key)", "user: bob, key: {env: KEY}", True),
        ("not has(user) or has(key)", "user: bob, key: {file: key}", True),
        ("not has(user) or has(key)", "user: bob", False),
        ("not has(first) or has(first.tag)", "first: {x: 1, tag: {env: X}}", True),
        ("not has(first) or has(first.tag)", "first: {x: 1}", False),
        ("has(ls[0])", "ls: [{env: X}]", True),
        ("has(ls[0])", "ls: []", False),
        ("not has(first.tag)", "", True),
        ("not has(need.tag)", "", True),
        ("has(low)", "", True),
        ("has(r[0])", "", True),
        ("has(need.x)", "", True),
    ],
)
def test_references_and_required_values_count_as_set(constraint: str, values: str, holds: bool) -> None:
    documents = pdsl(OPTIONAL, T, f"constraints: [{constraint!r}]\n")
    given = ", ".join(each for each in ("low: 1, r: [1], need: {x: 1}", values) if each)
    assert refused(documents, given) == ([] if holds else [f"this must hold: {constraint}"])


@pytest.mark.parametrize(
    "constraint",
    [
        "t < n",
        "n.x == 1",
        "n + t == 1",
        "n[0] == 1",
        "len(n) == 1",
        "all(n)",
        "min(t) > 1",
        "-t == 1",
        "n in 3",
        "unique(n)",
    ],
)
def test_a_wrong_constraint_is_reported_once_and_affects_no_values(constraint: str) -> None:
    documents = pdsl("n: int, t: string", more=f"constraints: [{constraint!r}, n > 0]\n")
    text = "component: c.cdsl.yaml\nparameters: {n: 1, t: a}\n"
    assert [one.code for one in said({**documents, "c.config.yaml": text})] == ["RC3119"]
    assert "this must hold: n > 0" in refused(documents, "n: 0, t: a")
