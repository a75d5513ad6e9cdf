"""Ice property files: entries, their places, and what cannot be written."""

from __future__ import annotations

import pytest

from robocomp_yaml.source import properties


def test_entries_have_their_place_and_the_last_one_counts() -> None:
    read = properties.read("# c\n  a = 1 # one\n\na=2\nb=x\nb=\nnot an entry\n")
    assert [(e.key, e.value, e.line, e.column) for e in read.entries] == [
        ("a", "1", 2, 3),
        ("a", "2", 4, 1),
        ("b", "x", 5, 1),
        ("b", "", 6, 1),
    ]
    assert read.invalid == (7,)
    assert read.values == {"a": "2"}
    assert read.last["a"].line == 4


def test_escapes_and_comments() -> None:
    assert properties.read(r"a\=b=x\#y = z#c" + "\n").values == {"a=b": "x#y = z"}
    assert properties.read('a="x # y"').values == {"a": '"x'}
    assert properties.read("a=b\\\nc=\\n").values == {"a": "b\\", "c": "\\n"}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("a", " x "),
        ("a", "  "),
        ("a=b#c\\", "=#\\"),
        ("Ice.Default", "a b"),
        ("a b", "c\td"),
    ],
)
def test_what_is_written_is_read_back(key: str, value: str) -> None:
    assert properties.read(properties.entry_line(key, value)).values == {key: value}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("", "x"),
        ("a", ""),
        (" a", "x"),
        ("a", "x\n"),
        ("a", "x\t"),
        ("a\0", "x"),
    ],
)
def test_what_cannot_be_written_is_refused(key: str, value: str) -> None:
    with pytest.raises(ValueError, match="property"):
        properties.entry_line(key, value)


def test_lines_have_their_places() -> None:
    text = "# c\n\n  a\\== x\\#y # one\nno entry # two\n\\#\n = 1\n"
    lines = properties.read(text).lines
    assert [(line.number, text[line.start : line.stop], text[line.stop : line.end]) for line in lines] == [
        (1, "", "# c"),
        (3, "  a\\== x\\#y ", "# one"),
        (4, "no entry ", "# two"),
        (5, "\\#", ""),
        (6, " = 1", ""),
    ]
    assert [text[line.entry.at : line.stop] for line in lines if line.entry] == [" x\\#y "]
    assert [line.number for line in lines if line.is_invalid] == [4, 5, 6]
