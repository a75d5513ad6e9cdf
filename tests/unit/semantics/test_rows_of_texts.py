"""Rows of columns and nested lists in one property, and properties whose names have holes."""

from __future__ import annotations

from typing import Any

import pytest

from robocomp_yaml.semantics import rows, spellings

COLUMNS = ("name", "gain", "tag")


def row(text: str, separator: str = ",") -> rows.Row:
    """Of a text, a number, and an optional text."""
    return rows.row(text, separator, COLUMNS, lambda name: name == "tag", lambda name: name != "gain")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a, 1 ,\tt", {"name": "a", "gain": "1", "tag": "t"}),
        ("a,1", {"name": "a", "gain": "1"}),
        ("a,1,", {"name": "a", "gain": "1"}),
        (",,t", {"name": "", "tag": "t"}),
        ("a", None),
        ("a,1,t,", None),
    ],
)
def test_columns(text: str, expected: rows.Row) -> None:
    assert row(text) == expected


def test_a_separator_of_blanks_stands_for_any_run_of_them() -> None:
    assert row("  a \t 1   t ", " ") == {"name": "a", "gain": "1", "tag": "t"}
    assert row("a ;1;t", " ; ") == {"name": "a", "gain": "1", "tag": "t"}


NESTED: list[tuple[Any, str, bool]] = [
    ([["a", "b"], ["c"]], "a,b;c", False),
    ([["a"], ["b"]], "a;b;", True),
    ([], "", False),
    ([["a", ""]], "a,", False),
]


@pytest.mark.parametrize(("parts", "text", "trailing"), NESTED)
def test_nested_lists_are_written_and_read(parts: Any, text: str, trailing: bool) -> None:
    assert rows.joined(parts, (";", ","), trailing) == text
    assert rows.nested(text, (";", ","), 2, trailing) == parts


def test_the_last_separator_alone_is_an_empty_list() -> None:
    assert rows.nested("; ", (";",), 1, True) == []
    assert rows.nested(";", (";", ","), 2, True) == [[]]
    assert rows.nested("a;", (";",), 1, False) == ["a", ""]


def test_holes_are_filled_and_read_back() -> None:
    key = "ID:{from}-{to}.{i}"
    assert spellings.placeholders(key) == ("from", "to", "i")
    filled = spellings.filled(key, {"from": "a", "to": "b-c", "i": "12"})
    read = spellings.pattern(key).match(filled)
    assert read is not None and read.groups() == ("a", "b-c", "12")
    assert spellings.pattern(key).match("ID:a-b.x") is None, "a row has a number"
    assert spellings.filled("M{i}-{name}", {"i": "0"}) == "M0-{name}"


@pytest.mark.parametrize(
    ("key", "quotes"),
    [
        ("Endpoints.X", True),
        ("Proxies.X", True),
        ("Proxies.XPrefix", False),
        ("Period.Compute", True),
        ("X.Endpoints", False),
    ],
)
def test_keys_of_files_with_quotes(key: str, quotes: bool) -> None:
    assert spellings.quotes_texts(["a", key]) == quotes
