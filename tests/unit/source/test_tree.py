"""YAML text as positioned nodes: the dialect, places, and what is refused."""

from __future__ import annotations

import math

import pytest

from robocomp_yaml.source.nodes import core
from robocomp_yaml.source.text import MAX_SCALAR
from robocomp_yaml.source.tree import Mapping, parse


def data(text: str) -> object:
    tree, diagnostics = parse("x.yaml", text)
    assert diagnostics == []
    assert tree is not None
    return tree.data


def codes(text: str) -> list[tuple[str, int, int]]:
    tree, diagnostics = parse("x.yaml", text)
    assert tree is None
    return [(d.code, d.span.line, d.span.column) for d in diagnostics]


@pytest.mark.parametrize(
    ("spelled", "value"),
    [
        ("on", "on"), ("yes", "yes"), ("No", "No"), ("12:30", "12:30"), ("1_000", "1_000"), ("2011-11-21", "2011-11-21"),
        ("1e3", 1000.0), (".9", 0.9), ("2000.", 2000.0), ("-0.5e-2", -0.005), ("+7", 7), ("0", 0), ("0x1F", 31),
        ("0o17", 15), ("0b1", "0b1"), ("True", True), ("FALSE", False), ("tRUE", "tRUE"), ("~", None), ("Null", None),
        ("", None), (".inf", math.inf), ("-.Inf", -math.inf), ('"5"', "5"), ("'on'", "on"), ("- 3", [3]), ("0x", "0x"),
        ("<<", "<<"), ("=", "="), ("1.2.3", "1.2.3"), ("--", "--"),
    ],
)  # fmt: skip
def test_plain_scalars_follow_the_core_schema(spelled: str, value: object) -> None:
    assert data(f"key: {spelled}\n" if not spelled.startswith("- ") else f"key:\n{spelled}\n") == {"key": value}


def test_nan_is_a_float() -> None:
    value = data("key: .nan")
    assert isinstance(value, dict) and math.isnan(value["key"])


def test_keys_are_text_as_spelled() -> None:
    assert data("{on: 1, 2d: 2, 007: 3, true: 4, '': 5}") == {"on": 1, "2d": 2, "007": 3, "true": 4, "": 5}


def test_lexemes_and_places() -> None:
    tree, _ = parse("x.yaml", "gain: .90\nnámes: {first: [a, 'b']}\n")
    assert isinstance(tree, Mapping)
    gain = tree.entries["gain"][1]
    assert (gain.lexeme, gain.quoted) == (".90", False)  # type: ignore[attr-defined]
    assert (gain.span.line, gain.span.column, gain.span.end_column) == (1, 7, 10)
    first, listed = tree.entries["námes"][1].entries["first"]  # type: ignore[attr-defined]
    assert (first.span.line, first.span.column) == (2, 9)
    assert [(n.lexeme, n.quoted, n.span.column) for n in listed.items] == [("a", False, 17), ("b", True, 20)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a: 1\nb: 2\na: 3\n", [("RC0103", 3, 1)]),
        ("a: {é: 1, é: 2}\n", [("RC0103", 1, 11)]),
        ("a: 012\nb: -007\n", [("RC0107", 1, 4), ("RC0107", 2, 4)]),
        ("a: {b:1}\n", [("RC0108", 1, 5)]),
        ("a: {b: 1, c::}\n", [("RC0108", 1, 11)]),
        ("a: !!str 5\n", [("RC0109", 1, 4)]),
        ("a: !mine {b: 1}\n", [("RC0109", 1, 4)]),
        ("? [a]\n: b\n", [("RC0110", 1, 3)]),
        ("a: 1\n---\nb: 2\n", [("RC0104", 2, 1)]),
        ("a:\n\tb: 1\n", [("RC0101", 2, 1)]),
        ("a: [1, 2\n", [("RC0101", 1, 9)]),
        ("a: 'x\n", [("RC0101", 1, 4)]),
        ("a: b: c\n", [("RC0101", 1, 5)]),
        ("a: @x\n", [("RC0101", 1, 4)]),
        ("a: *b\n", [("RC0101", 1, 4)]),
        ('a: "\\uDCE9"\n', [("RC0003", 1, 4)]),
        ('"\\uDCE9": 1\n', [("RC0003", 1, 1)]),
        ("", [("RC0102", 1, 1)]),
        ("# nothing\n", [("RC0102", 1, 1)]),
        ("a: &x [*x]\n", [("RC0105", 1, 4)]),
    ],
)
def test_what_is_refused(text: str, expected: list[tuple[str, int, int]]) -> None:
    assert codes(text) == expected


def test_yaml_1_2_allows_colons_in_flow_scalars() -> None:
    assert data("{proxy: lidar3d:tcp -h localhost, url: http://x/y}") == {
        "proxy": "lidar3d:tcp -h localhost",
        "url": "http://x/y",
    }


def test_an_alias_bomb_is_bounded() -> None:
    bomb = "a: &a [x, x, x, x, x, x, x, x, x, x]\n"
    for level in "bcdefghi":
        before = chr(ord(level) - 1)
        bomb += f"{level}: &{level} [{', '.join(f'*{before}' for _ in range(10))}]\n"
    said = codes(bomb)
    assert [code for code, _, _ in said] == ["RC0105"]


def test_some_aliases_are_fine() -> None:
    assert data("a: &a {x: 1}\nb: *a\nc: [*a, *a]\n") == {"a": {"x": 1}, "b": {"x": 1}, "c": [{"x": 1}, {"x": 1}]}


@pytest.mark.parametrize("depth", [150, 5_000])
@pytest.mark.parametrize(("opening", "closing"), [("[", "]"), ("{a: ", "}"), ("- ", "")])
def test_deep_nesting_is_refused(depth: int, opening: str, closing: str) -> None:
    assert [code for code, _, _ in codes(opening * depth + "1" + closing * depth)] == ["RC0106"]


def test_many_brackets_side_by_side_are_not_deep() -> None:
    assert data("a: [" + "[1], " * 500 + "]") == {"a": [[1]] * 500}


def test_an_enormous_scalar_is_refused() -> None:
    assert codes(f"doc: '{'a' * (MAX_SCALAR + 1)}'") == [("RC0004", 1, 6)]


@pytest.mark.parametrize("char", ["\x85", "\u2028", "\u2029"])
def test_what_ended_lines_in_yaml_1_1_is_part_of_its_line(char: str) -> None:
    """An editor shows `# a…b: 1` as one line, a comment; so it is one."""
    text = f"# a{char}b: 1\nc: x{char}y\nd: 'x{char}y'  # \ue000\ne: \"{char}\"\n"
    root, faults = parse("x.yaml", text)
    assert root is not None and faults == []
    assert root.data == {"c": f"x{char}y", "d": f"x{char}y", "e": char}
    assert isinstance(root, Mapping) and root.entries["e"][0].span.line == 4
    _, (fault,) = parse("x.yaml", f"a: {char}\nb: [\n")
    assert fault.span.line == 2


@pytest.mark.parametrize("text", ["a: 1", "a:\n  b: 1", "a:\r  - b", "- {a: 1}\n-"])
def test_a_last_line_without_an_end_is_the_last_one(text: str) -> None:
    root, _ = parse("x.yaml", text)
    assert root is not None
    lines = text.replace("\r", "\n").split("\n")
    assert (root.span.end_line, root.span.end_column) == (len(lines), len(lines[-1]) + 1)


@pytest.mark.parametrize(
    ("text", "value"),
    [("0x1F", 31), ("0o17", 15), *((text, text) for text in ("0x1_F", "0x", "0o8", "0x\u0661\u0662", "0o\u0667"))],
)
def test_numbers_in_other_bases_have_their_digits_alone(text: str, value: object) -> None:
    """Python's `int` also reads underlines, and the digits of other scripts."""
    assert core(text) == value
