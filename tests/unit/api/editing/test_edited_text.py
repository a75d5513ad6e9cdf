"""Steps in a document's text: exactly one value changes, and no comment is lost."""

from __future__ import annotations

import pytest

from robocomp_yaml.api.editing.text import EditedText
from robocomp_yaml.parameters.editing.edit import NotEditable
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source import parts
from robocomp_yaml.source.comments import comments
from robocomp_yaml.source.tree import parse


def edited(text: str) -> EditedText:
    return EditedText("a.yaml", text)


@pytest.mark.parametrize(
    ("text", "steps", "data", "expected"),
    [
        ("a: 1 # one\nb: 2\n", ["a"], 3, "a: 3 # one\nb: 2\n"),
        ("a: {b: 'x'}\n", ["a", "b"], "y", "a: {b: 'y'}\n"),
        ("a: {b: 1}\n", ["a", "c"], "{i}", 'a: {b: 1, c: "{i}"}\n'),
        ("a:\n  b: 1\n  # of b\nd: 2\n", ["a", "c"], "x y", "a:\n  b: 1\n  c: x y\n  # of b\nd: 2\n"),
        ("a:\n", ["a", "b", "c"], 1, "a:\n  b:\n    c: 1\n"),
        ("a: 1\r\n", ["b"], "10.0.0.3", "a: 1\r\nb: 10.0.0.3\r\n"),
        ("a: 1", ["b"], [1, "x"], "a: 1\nb: [1, x]"),
        ("a: ä\nb: 🙂 # 🙂\n", ["b"], "ö", "a: ä\nb: ö # 🙂\n"),
        ("a: yes\n", ["a"], "true", 'a: "true"\n'),
    ],
)  # fmt: skip
def test_a_value_is_set(text: str, steps: list[Step], data: object, expected: str) -> None:
    one = edited(text)
    one.set(steps, data)
    assert one.text == expected


@pytest.mark.parametrize(
    ("text", "steps", "expected"),
    [
        ("a: {b: 1, c: 2, d: 3}\n", ["a", "b"], "a: {c: 2, d: 3}\n"),
        ("a: {b: 1, c: 2, d: 3}\n", ["a", "c"], "a: {b: 1, d: 3}\n"),
        ("a: {b: 1, c: 2}\n", ["a", "c"], "a: {b: 1}\n"),
        ("a: {b: 1, c: 2,}\n", ["a", "c"], "a: {b: 1,}\n"),
        ("a: {b: 1, # one\n  c: 2, # two\n  d: 3}\n", ["a", "c"], "a: {b: 1, # one\n  # two\n  d: 3}\n"),
        ("a: [x, y, z]\n", ["a", 1], "a: [x, z]\n"),
        ("a: [\n  x,\n  y,\n]\n", ["a", 0], "a: [\n  y,\n]\n"),
        ("a:\n  - x # one\n  - y\n", ["a", 0], "a:\n  # one\n  - y\n"),
        ("a:\n  b: 1 # one\n  c: 2\n", ["a", "b"], "a:\n  # one\n  c: 2\n"),
        ("a:\n  b: {x: 1}\nd: 4\n", ["a", "b", "x"], "d: 4\n"),
        ("z: 1\na:\n  - x # only\n", ["a", 0], "z: 1\n# only\n"),
        ("a:\n  b: |\n    # no comment\n    text\n  c: 2\n", ["a", "b"], "a:\n  c: 2\n"),
        ("a:\n  b:\n  c: 2\n", ["a", "b"], "a:\n  c: 2\n"),
        ("a: 1\nb: 2", ["b"], "a: 1\n"),
    ],
)  # fmt: skip
def test_an_element_is_removed(text: str, steps: list[Step], expected: str) -> None:
    one = edited(text)
    one.remove(steps)
    assert one.text == expected


def test_an_element_is_removed_with_its_comments() -> None:
    one = edited("a:\n  # above\n  b: # b\n    c: 1 # c\n    # deeper\n  # the next one\n  d: 2\n")
    one.remove(["a", "b"], with_comments=True)
    assert one.text == "a:\n  # above\n  # the next one\n  d: 2\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a: {b: 1, c: 2}\n", 'a: {"x{i}": 1, c: 2}\n'),
        ("a:\n  b: 1 # one\n", "a:\n  x{i}: 1 # one\n"),
        ("a:\n  'b': 1\n", "a:\n  'x{i}': 1\n"),
    ],
)
def test_a_key_is_renamed(text: str, expected: str) -> None:
    one = edited(text)
    one.rename(["a", "b"], "x{i}")
    assert one.text == expected


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("x: &x {b: 1, c: 2}\na: *x\n", ["a", "b"]),
        ("x: &x 1\na: {b: *x, c: 2}\n", ["a", "b"]),
        ("a: {b: &b 1, c: *b}\n", ["a", "b"]),
    ],
)  # fmt: skip
def test_what_would_affect_more_is_rejected(text: str, steps: list[Step]) -> None:
    one = edited(text)
    with pytest.raises(NotEditable):
        one.remove(steps)
    assert one.text == text


def test_a_value_with_comments_in_it_is_not_replaced() -> None:
    one = edited("a: [x, # the first\n    y]\n")
    with pytest.raises(NotEditable, match="the first"):
        one.set(["a"], ["z"])


def test_comments_are_those_of_yaml() -> None:
    text = "# top\na: 'no # comment'\nb: x#y # yes\nc: |\n  # text\nd: \"#\" # end"
    root, _ = parse("a.yaml", text)
    assert root is not None
    assert [one for _, one in comments(text, root)] == ["# top", "# yes", "# end"]


def test_a_comment_before_a_new_line_keeps_its_line_end() -> None:
    edited = EditedText("x.ddsl.yaml", "components:\r\n  mouth:\r\n    port: 1 # c\r\n\r\n# below\r\n")
    edited.set(["components", "lips"], {"port": 2})
    assert edited.text == (
        "components:\r\n  mouth:\r\n    port: 1 # c\r\n  lips: {port: 2}\r\n\r\n# below\r\n"
    )  # fmt: skip


def test_a_long_text_is_parsed_where_it_changes_and_a_step_that_fails_leaves_it_as_it_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("robocomp_yaml.source.parts.LONG", 0)  # as if it were long
    text = "deployment: Net\ncomponents:\n" + "".join(f"  c{at}: {{host: h, after: [x]}} # {at}\n" for at in range(12))
    one, parsed = edited(text), list[str]()
    make = parts.part
    monkeypatch.setattr(parts, "part", lambda path, text, base: parsed.append(text) or make(path, text, base))  # type: ignore[func-returns-value]
    one.set(["components", "c7", "host"], "other")
    assert len(parsed) == 1, parsed
    one.rename(["components", "c3"], "third")  # a line as long as before: what follows moves
    with pytest.raises(NotEditable, match="would be lost"):
        one._change(one.text.replace(" # 9", ""), one.data())
    with pytest.raises(NotEditable, match="more than this value"):
        one._change(one.text.replace("c10: {host: h", "c10: {host: g"), one.data())
    one.set(["components", "c11", "after"], ["why"])
    one.remove(["components", "c5", "after"])
    expected = text.replace("c7: {host: h", "c7: {host: other").replace("c3:", "third:")
    expected = expected.replace("[x]} # 11", "[why]} # 11").replace("c5: {host: h, after: [x]}", "c5: {host: h}")
    assert one.text == expected
    tree, _ = parse("a.yaml", expected)
    assert tree is not None and one.data() == tree.data
    assert list(comments(one.text, one.root)) == list(comments(expected, tree))
