"""Doc comments of Slice."""

from __future__ import annotations

import pytest

from robocomp_yaml.emit.slice import literal, quoted
from robocomp_yaml.emit.slice_comment import WIDTH, comment
from robocomp_yaml.model.interface import Literal


def test_no_text() -> None:
    assert comment("") == comment(" \n ") == comment("", tags=[("@return", "")]) == []


def test_one_line() -> None:
    assert comment("Says things.", "  ") == ["  /** Says things. */"]


@pytest.mark.parametrize(
    ("doc", "unit", "text"),
    [
        ("", "m", "Unit: m."),
        ("How far.", "m", "How far. Unit: m."),
        ("How far", "m", "How far. Unit: m."),
        ("How far?", "", "How far?"),
    ],
)
def test_a_unit(doc: str, unit: str, text: str) -> None:
    assert comment(doc, unit=unit) == [f"/** {text} */"]


def test_paragraphs_lists_and_tags() -> None:
    lines = comment("First.\n\n- one\n  more\n", tags=[("@param a", "How\nfar."), ("@return", "")])
    assert lines == ["/**", " * First.", " *", " * - one", " *   more", " *", " * @param a How far.", " */"]


def test_a_list_item_continues_below_its_text() -> None:
    lines = comment("10. " + "word " * 40)
    assert [line[:8] for line in lines[1:3]] == [" * 10. w", " *     w"]


def test_long_lines_are_broken_between_words() -> None:
    lines = comment("  " + "word " * 60, "    ")
    assert all(len(line) <= WIDTH for line in lines)
    assert sum(line.count("word") for line in lines) == 60
    assert all(line.startswith("     *   word") for line in lines[1:-1])


def test_a_word_too_long_for_the_preprocessor_is_split() -> None:
    lines = comment("x" * 100_000)
    assert max(len(line) for line in lines) < 20_000
    assert sum(line.count("x") for line in lines) == 100_000


@pytest.mark.parametrize(
    ("doc", "text"),
    [
        ("a */ b /* c", "a * / b / * c"),
        ("*/*", "* / *"),
        ('"""', "'''"),
        ("\\u", "\\\\u"),
        ("\\", "\\\\."),
        ("a\x00b\x1b", "ab"),
        ("a\tb", "a    b"),
        ("\ud800é", "é"),
    ],
)
def test_harmful_sequences_are_replaced(doc: str, text: str) -> None:
    assert comment(doc) == [f"/** {text} */"]


@pytest.mark.parametrize(
    ("type_", "value", "lexeme", "text"),
    [
        ("bool", True, "True", "true"),
        ("bool", False, "FALSE", "false"),
        ("int", 5, "+5", "+5"),
        ("int", 31, "0x1F", "31"),
        ("float", 2000.0, "2000.", "2000."),
        ("float", 0.9, ".9", ".9"),
        ("float", 1e6, "1e6", "1000000"),
        ("double", 1e6, "1e6", "1e6"),
        ("double", 1234567.0, "1234567.", "1234567"),
        ("float", 1.5e-7, "1.5e-7", "1.5e-7"),
        ("double", 10**19, "10000000000000000000", "10000000000000000000.0"),
        ("double", 3, "3", "3"),
        ("double", 0.5, "odd", "0.5"),
        ("string", "5", "5", '"5"'),
    ],
)
def test_literals(type_: str, value: bool | int | float | str, lexeme: str, text: str) -> None:
    assert literal(Literal(value, lexeme), type_) == text


def test_strings_are_escaped() -> None:
    assert quoted('"\\\n\t\r\x01\x7fé??/') == '"\\"\\\\\\n\\t\\r\\001\\177é?\\?/"'
