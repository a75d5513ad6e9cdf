"""Limits of parameters: allowed values, limits of a type and a parameter together, and limits without effect."""

from __future__ import annotations

import pytest

from in_memory import fitting, pdsl, refused, said, wrong

NUMBERS = "0, 1, 2, 3, 4, 5, 6"
TYPES = {
    "Few": "{type: int, range: [2, 4]}",
    "Open": "{type: int, range: {above: 1, below: 4}}",
    "Low": "{type: int, range: {from: 3}}",
    "Chosen": "{type: int, values: [1, 3, 5]}",
}


def which_fit(spec: str, candidates: str, types: str = "", *, between: str = ", ") -> str:
    """The candidates that a parameter can have."""
    values = [f"a: {one}" for one in candidates.split(between)]
    return between.join(one.removeprefix("a: ") for one in fitting(pdsl(f"a: {spec}", types), values))


@pytest.mark.parametrize(
    ("spec", "fit"),
    [
        ("{type: int}", NUMBERS),
        ("{type: int, range: [2, 4]}", "2, 3, 4"),
        ("{type: int, range: [5, 5]}", "5"),
        ("{type: float, range: [5, 5]}", "5"),
        ("{type: int, range: {from: 4}}", "4, 5, 6"),
        ("{type: int, range: {above: 4}}", "5, 6"),
        ("{type: int, range: {to: 1}}", "0, 1"),
        ("{type: int, range: {below: 1}}", "0"),
        ("{type: int, range: {above: 1, below: 3}}", "2"),
        ("{type: int, range: {above: 1, to: 2}}", "2"),
        ("{type: int, range: {from: 2, below: 3}}", "2"),
        ("{type: int, values: [1, 5]}", "1, 5"),
        ("{type: double, values: [1, 5]}", "1, 5"),
        ("{type: int, range: [2, 5], values: [5, 2]}", "2, 5"),
        # The limits of a type and those of the parameter hold together.
        ("{type: Few, range: [3, 9]}", "3, 4"),
        ("{type: Few, range: [0, 2]}", "2"),
        ("{type: Few, range: [0, 9]}", "2, 3, 4"),
        ("{type: Few, range: {above: 2}}", "3, 4"),
        ("{type: Few, range: {below: 4}}", "2, 3"),
        ("{type: Few, range: {from: 2, to: 4}}", "2, 3, 4"),
        ("{type: Open, range: [1, 4]}", "2, 3"),
        ("{type: Open, range: [2, 3]}", "2, 3"),
        ("{type: Open, range: {to: 2}}", "2"),
        ("{type: Low, range: {to: 4}}", "3, 4"),
        ("{type: Chosen, range: [2, 9]}", "3, 5"),
        ("{type: Chosen, values: [3]}", "3"),
        ("{type: Few, values: [3]}", "3"),
        ("Few", "2, 3, 4"),
    ],
)
def test_which_numbers_fit(spec: str, fit: str) -> None:
    named = next((name for name in TYPES if name in spec), "")
    assert which_fit(spec, NUMBERS, f"{named}: {TYPES[named]}" if named else "") == fit


@pytest.mark.parametrize(
    ("spec", "fit"),
    [
        ("{type: float, range: {above: 0, below: 1}}", "0.01, 0.5, 0.99"),
        ("{type: float, range: [0, 1]}", "0, 0.01, 0.5, 0.99, 1, 1.0"),
        ("{type: float, range: {above: 0.5}}", "0.99, 1, 1.0"),
        ("{type: double, values: [0.5, 1]}", "0.5, 1, 1.0"),
        ("{type: int, range: [0, 1.0]}", "0, 1, 1.0"),
        ("{type: int}", "0, 1, 1.0"),
    ],
)
def test_which_numbers_with_a_fraction_fit(spec: str, fit: str) -> None:
    assert which_fit(spec, "0, 0.01, 0.5, 0.99, 1, 1.0") == fit


@pytest.mark.parametrize(
    ("spec", "fit"),
    [
        ("Speed", "stop, slow, fast, full"),
        ("{type: Speed, range: [slow, fast]}", "slow, fast"),
        ("{type: Speed, range: [slow, slow]}", "slow"),
        ("{type: Speed, range: {above: slow}}", "fast, full"),
        ("{type: Speed, range: {from: fast}}", "fast, full"),
        ("{type: Speed, range: {below: fast}}", "stop, slow"),
        ("{type: Speed, range: {to: fast}}", "stop, slow, fast"),
        ("{type: Speed, range: {above: stop, below: full}}", "slow, fast"),
        ("{type: Speed, values: [full, stop]}", "stop, full"),
        ("{type: Speed, range: [slow, full], values: [full]}", "full"),
    ],
)
def test_which_enumerators_fit(spec: str, fit: str) -> None:
    assert which_fit(spec, "stop, slow, fast, full, 1", "Speed: {enum: [stop, slow, fast, full]}") == fit


@pytest.mark.parametrize(
    ("spec", "fit"),
    [
        ("string", "'', a, b1, ab"),
        ("{type: string, pattern: '[a-z]'}", "a"),
        ("{type: string, pattern: '[a-z][0-9]?'}", "a, b1"),
        ("{type: string, values: [b1, '']}", "'', b1"),
        ("{type: string, pattern: '[a-z]+', values: [ab]}", "ab"),
    ],
)
def test_which_texts_fit(spec: str, fit: str) -> None:
    assert which_fit(spec, "'', a, b1, ab") == fit


LISTS = "[]; [1]; [1, 2]; [1, 1]; [1, 2, 3]"


@pytest.mark.parametrize(
    ("spec", "fit"),
    [
        ("{list: int}", LISTS),
        ("{list: int, size: 2}", "[1, 2]; [1, 1]"),
        ("{list: int, size: 0}", "[]"),
        ("{list: int, size: [1, 2]}", "[1]; [1, 2]; [1, 1]"),
        ("{list: int, size: {from: 2}}", "[1, 2]; [1, 1]; [1, 2, 3]"),
        ("{list: int, size: {to: 1}}", "[]; [1]"),
        ("{list: int, unique: true}", "[]; [1]; [1, 2]; [1, 2, 3]"),
        ("{list: int, unique: false}", LISTS),
        ("{list: {type: int, range: [1, 2]}, size: 2, unique: true}", "[1, 2]"),
        ("{list: {type: int, values: [1, 2]}, size: 2, unique: true}", "[1, 2]"),
        ("{type: Some, size: {to: 1}}", "[1]"),
        ("{type: Some, size: {from: 2}}", "[1, 2]; [1, 1]"),
        ("{type: Some, size: [0, 9]}", "[1]; [1, 2]; [1, 1]"),
    ],
)
def test_which_lists_fit(spec: str, fit: str) -> None:
    types = "Some: {list: int, size: [1, 2]}" if "Some" in spec else ""
    assert which_fit(spec, LISTS, types, between="; ") == fit


@pytest.mark.parametrize(
    ("spec", "fit"),
    [
        ("{map: int}", "{}; {x: 1}; {x: 1, y: 1}"),
        ("{map: int, size: 1}", "{x: 1}"),
        ("{map: {type: int, range: [2, 3]}}", "{}"),
    ],
)
def test_which_maps_fit(spec: str, fit: str) -> None:
    assert which_fit(spec, "{}; {x: 1}; {x: 1, y: 1}", between="; ") == fit


MISFIT, EMPTY, UNREACHABLE = "RC3108", "RC3109", "RC3110"


@pytest.mark.parametrize(
    ("spec", "types", "code", "at", "message"),
    [
        # Limits that no value fulfils
        ("{type: int, range: [3, 2]}", "", EMPTY, "[3, 2]", "no number is from 3 to 2"),
        ("{type: int, range: {above: 3, below: 4}}", "", EMPTY, "{above: 3, below: 4}", "no number is above 3 and below 4"),
        ("{type: float, range: {above: 3, to: 3}}", "", EMPTY, "{above: 3, to: 3}", "no number is above 3 and at most 3"),
        ("{type: float, range: {from: 3, below: 3}}", "", EMPTY, "{from: 3, below: 3}", "no number is at least 3 and below 3"),
        ("{type: T, range: [0, 3]}", "T: {type: int, range: [4, 9]}", EMPTY, "[0, 3]", "no number is from 0 to 3 and, as its type requires, from 4 to 9"),
        ("{type: T, range: {above: 3}}", "T: {type: int, range: {below: 4}}", EMPTY, "{above: 3}", "no number is above 3 and, as its type requires, below 4"),
        ("{type: T, range: [4, 5]}", "T: {type: int, values: [2, 3]}", EMPTY, "[4, 5]", "no value of its type is from 4 to 5"),
        ("{type: E, range: [c, a]}", "E: {enum: [a, b, c]}", EMPTY, "[c, a]", "no enumerator of E is in this range"),
        ("{type: E, range: {above: c}}", "E: {enum: [a, b, c]}", EMPTY, "{above: c}", "no enumerator of E is in this range"),
        ("{type: E, range: {below: a}}", "E: {enum: [a, b, c]}", EMPTY, "{below: a}", "no enumerator of E is in this range"),
        ("{list: int, size: [3, 2]}", "", EMPTY, "[3, 2]", "at least 3 and at most 2 elements"),
        ("{map: int, size: {from: 3, to: 2}}", "", EMPTY, "{from: 3, to: 2}", "at least 3 and at most 2 elements"),
        ("{type: T, size: 2}", "T: {list: int, size: [3, 4]}", EMPTY, "2", "at least 3 and at most 2 elements"),
        ("{type: T, size: 5}", "T: {list: int, size: [3, 4]}", EMPTY, "5", "at least 5 and at most 4 elements"),
        ("{list: {type: int, values: [1, 2]}, size: 3, unique: true}", "", EMPTY, "true", "3 different elements need more than 2 values"),
        ("{list: bool, size: {from: 3}, unique: true}", "", EMPTY, "true", "3 different elements need more than 2 values"),
        ("{list: E, size: 4, unique: true}", "E: {enum: [a, b, c]}", EMPTY, "true", "4 different elements need more than 3 values"),
        # Limits of which a part is never reached
        ("{type: int, range: [0, 1e10]}", "", UNREACHABLE, "1e10", "1e10 is out of range: int is from -2147483648 to 2147483647"),
        ("{type: int, range: {from: -2147483649}}", "", UNREACHABLE, "-2147483649", "-2147483649 is out of range: int is from -2147483648 to 2147483647"),
        ("{type: int, values: [2147483648]}", "", UNREACHABLE, "2147483648", "2147483648 is out of range: int is from -2147483648 to 2147483647"),
        ("{type: int, values: [1, 1]}", "", UNREACHABLE, "1", "'1' appears twice"),
        ("{type: int, values: [1, 1.5]}", "", UNREACHABLE, "1.5", "'1.5' is not a whole number"),
        ("{type: int, values: [1, x]}", "", UNREACHABLE, "x", "'x' is not a whole number"),
        ("{type: float, values: [1, x]}", "", UNREACHABLE, "x", "'x' is not a number"),
        ("{type: string, values: [x, 1]}", "", UNREACHABLE, "1", "'1' is not text"),
        ("{type: int, range: [2, 3], values: [2, 4]}", "", UNREACHABLE, "4", "4 is out of range: it must be from 2 to 3"),
        ("{type: T, values: [1, 2]}", "T: {type: int, range: [2, 3]}", UNREACHABLE, "1", "1 is out of range: it must be from 2 to 3"),
        ("{type: T, values: [1, 2]}", "T: {type: int, values: [2, 3]}", UNREACHABLE, "1", "'1' is not a value of its type"),
        ("{type: T, values: [x, 7]}", "T: {type: string, pattern: x}", UNREACHABLE, "7", "'7' is not text"),
        ("{type: T, values: [x, y]}", "T: {type: string, pattern: x}", UNREACHABLE, "y", "'y' does not match the pattern"),
        ("{type: T, pattern: x}", "T: {type: string, values: [x, y]}", UNREACHABLE, "y", "'y' does not match the pattern"),
        ("{type: E, range: [a, b], values: [a, c]}", "E: {enum: [a, b, c]}", UNREACHABLE, "c", "'c' is outside the range"),
        # Limits that say nothing
        ("{type: bool, range: [0, 1]}", "", MISFIT, "[0, 1]", "'range' does not apply to a value that is true or false"),
        ("{type: string, range: [0, 1]}", "", MISFIT, "[0, 1]", "'range' does not apply to a value that is text"),
        ("{list: int, range: [0, 1]}", "", MISFIT, "[0, 1]", "'range' does not apply to a value that is a list"),
        ("{type: bool, values: [1]}", "", MISFIT, "[1]", "'values' does not apply to a value that is true or false"),
        ("{map: int, values: [1]}", "", MISFIT, "[1]", "'values' does not apply to a value that is a mapping of names to values"),
        ("{type: int, pattern: x}", "", MISFIT, "x", "'pattern' does not apply to a value that is a whole number"),
        ("{type: float, size: 2}", "", MISFIT, "2", "'size' does not apply to a value that is a number"),
        ("{type: string, unit: m}", "", MISFIT, "m", "'unit' does not apply to a value that is text"),
        ("{type: E, unit: m}", "E: {enum: [a, b]}", MISFIT, "m", "'unit' does not apply to a value that is one of a, b"),
        ("{list: string, unit: m}", "", MISFIT, "m", "'unit' does not apply to a value that is text"),
        ("{type: P, size: 2}", "P: {struct: {x: int}}", MISFIT, "2", "'size' does not apply to a value that is a group"),
        ("{group: {x: int}, range: [1, 2]}", "", MISFIT, "[1, 2]", "'range' does not apply to a value that is a group"),
        ("{type: int, unique: true}", "", MISFIT, "true", "'unique' applies only to lists of plain values"),
        ("{list: {list: int}, unique: true}", "", MISFIT, "true", "'unique' applies only to lists of plain values"),
        ("{map: int, unique: true}", "", MISFIT, "true", "'unique' applies only to lists of plain values"),
        # Limits that are none
        ("{type: int, range: [0.5, 1]}", "", MISFIT, "0.5", "'range' of whole numbers needs whole limits"),
        ("{type: float, range: [x, 1]}", "", MISFIT, "x", "'range' needs numbers, not 'x'"),
        ("{type: float, range: {from: 1, above: 1}}", "", MISFIT, "{from: 1, above: 1}", "'range' cannot have both 'from' and 'above'"),
        ("{type: float, range: {to: 1, below: 1}}", "", MISFIT, "{to: 1, below: 1}", "'range' cannot have both 'to' and 'below'"),
        ("{type: E, range: {from: a, above: a}}", "E: {enum: [a, b]}", MISFIT, "{from: a, above: a}", "'range' cannot have both 'from' and 'above'"),
        ("{type: float, range: {}}", "", MISFIT, "{}", "'range' has no limit"),
        ("{type: E, range: [a, d]}", "E: {enum: [a, b]}", MISFIT, "d", "'range' names unknown enumerator 'd' of E"),
        ("{type: E, values: [a, d]}", "E: {enum: [a, b]}", MISFIT, "d", "'values' names unknown enumerator 'd' of E"),
        ("{type: T, pattern: x}", "T: {type: string, pattern: y}", MISFIT, "x", "'pattern' is already set by the type"),
    ],
)  # fmt: skip
def test_contradictory_limits(spec: str, types: str, code: str, at: str, message: str) -> None:
    message = f"nothing fits: {message}" if code == EMPTY else message
    assert wrong(f"a: {spec}", types) == [(code, at, message)]


@pytest.mark.parametrize(
    ("spec", "types", "hint"),
    [
        ("{type: E, values: [slo]}", "E: {enum: [slow, fast]}", "did you mean 'slow'?"),
        ("{type: E, values: [turbo]}", "E: {enum: [slow, fast]}", "there are: slow, fast"),
        ("{list: P, unique: true}", "P: {struct: {x: int}}", "for records, write a constraint: unique(m.name for m in motors)"),
    ],
)  # fmt: skip
def test_the_hints_at_limits(spec: str, types: str, hint: str) -> None:
    (found,) = said(pdsl(f"a: {spec}", types), "c.pdsl.yaml")
    assert found.hint == hint


@pytest.mark.parametrize(
    ("pattern", "at"),
    [("'a[b'", "["), ('"a(?=b)"', "("), ('"\\\\d[b"', '"\\\\d[b"')],
)
def test_a_pattern_is_rejected_at_the_character(pattern: str, at: str) -> None:
    """The location is exact unless there is an escape before it."""
    text = f"component: c.cdsl.yaml\nparameters:\n  a: {{type: string, pattern: {pattern}}}\n"
    (found,) = said({**pdsl(""), "c.pdsl.yaml": text}, "c.pdsl.yaml")
    assert (found.code, found.at) == ("RC3111", at)


def test_all_faults_in_values_are_reported() -> None:
    found = wrong("a: {type: int, values: [7, 7, x, 8]}")
    assert [(at, message) for _, at, message in found] == [
        ("7", "'7' appears twice"),
        ("x", "'x' is not a whole number"),
    ]
    assert len(wrong("a: {type: E, values: [b, c, a]}", "E: {enum: [a]}")) == 2


def test_a_wrong_limit_has_no_effect() -> None:
    documents = pdsl(
        "a: {type: int, range: [3, 2]}, b: {type: int, values: [x]}, c: {type: E, values: [y]}", "E: {enum: [x]}"
    )
    assert len(refused(documents, "a: 9, b: 8, c: x")) == 3
