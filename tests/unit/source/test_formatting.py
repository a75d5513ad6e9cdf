"""The normal layout of documents: what changes, and what stays."""

from __future__ import annotations

import pytest

from robocomp_yaml.source.formatting import formatted, same_content
from robocomp_yaml.source.tree import parse

CASES = {
    "blanks within a line": ("a:   1\nb :  {c: 1 ,d : [ 2,3 ]}\n", "a: 1\nb: {c: 1, d: [2, 3]}\n"),
    "empty collections": ("a: [ ]\nb: { }\n", "a: []\nb: {}\n"),
    "a comma at the end of a line with brackets": ("a: [1, 2, ]\nb: [\n 1,\n]\n", "a: [1, 2]\nb: [\n  1,\n]\n"),
    "no value in brackets": ("a: {b: , c: }\n", "a: {b: , c: }\n"),
    "indentation": ("a:\n     b:\n      c: 1\n     d: 2\n", "a:\n  b:\n    c: 1\n  d: 2\n"),
    "a list below its key": ("a:\n- 1\n-   b: 2\n    c: 3\nd: 4\n", "a:\n  - 1\n  - b: 2\n    c: 3\nd: 4\n"),
    "lists in lists": ("-   - 1\n    - 2\n-\n   - 3\n", "- - 1\n  - 2\n-\n  - 3\n"),
    "a value on the next line": ("a:\n   x y\nb:\n      [1,\n 2]\n", "a:\n  x y\nb:\n  [1,\n    2]\n"),
    "brackets over several lines": (
        "a: {b: 1,\n        c: {d: 2,\n   e: 3\n}\n   }\n",
        "a: {b: 1,\n  c: {d: 2,\n    e: 3\n  }\n}\n",
    ),
    "brackets in a list of mappings": (
        "a:\n- b: [1,\n  2]\n  c: 3\n",
        "a:\n  - b: [1,\n      2]\n    c: 3\n",
    ),
    "quotes that do nothing": ("'a b': 'c d'\nb: \"x: y\"\nc: ['x', \"-c\", 'y z']\n",
                               "a b: c d\nb: \"x: y\"\nc: [x, -c, y z]\n"),
    "quotes that keep text text": (
        "a: '1'\nb: 'true'\nc: ''\nd: '~'\ne: '007'\nf: '1e3'\ng: '.5'\nh: '0x1F'\ni: 'null'\nj: '.inf'\n'2': k\n",
        'a: "1"\nb: "true"\nc: ""\nd: "~"\ne: "007"\nf: "1e3"\ng: ".5"\nh: "0x1F"\ni: "null"\nj: ".inf"\n"2": k\n',
    ),
    "words that YAML 1.1 takes for booleans": ("a: 'yes'\nb: \"off\"\nc: '12:30'\nd: '1_000'\n",
                                               "a: yes\nb: off\nc: 12:30\nd: 1_000\n"),
    "quotes for what cannot begin a text": ("a: '*x'\nb: '# x'\nc: ' x'\nd: '- x'\ne: '@x'\nf: 'x:'\ng: 'x #y'\n",
                                            'a: "*x"\nb: "# x"\nc: " x"\nd: "- x"\ne: "@x"\nf: "x:"\ng: "x #y"\n'),
    "quotes within brackets": ("a: ['b,c', 'd]', 'x:y', 'e f']\n", 'a: ["b,c", "d]", "x:y", e f]\n'),
    "single quotes with both quotes": ("a: 'it''s: \"x\" \\ y'\n", 'a: "it\'s: \\"x\\" \\\\ y"\n'),
    "escapes as they are spelled": ('a: "\\u00e9\\tb"\n', 'a: "\\u00e9\\tb"\n'),
    "numbers and booleans as they are spelled": ("a: .9\nb: 2000.\nc: True\nd: 1E5\ne: NULL\nf: +1\n",) * 2,
    "blank lines": ("\n\na: 1\n\n\n\nb: 2   \n   \n\n", "a: 1\n\nb: 2\n"),
    "line ends": ("a: 1\r\nb:\r\n- 2\r\n", "a: 1\nb:\n  - 2\n"),
    "no line end at the end": ("a: 1", "a: 1\n"),
    "comments above": (
        "# head\n\n\na:\n    # first\n    b: 1\n    # last of a\n# about c\nc:\n- 1\n# in c\n- 2\n",
        "# head\n\na:\n  # first\n  b: 1\n  # last of a\n# about c\nc:\n  - 1\n  # in c\n  - 2\n",
    ),
    "comments between brackets": ("a: [1, # one\n      # own\n  2]\n", "a: [1, # one\n  # own\n  2]\n"),
    "comments in one column": (
        "a:     1  # one\nlonger: 2 # two\nb:        # b\n  - 3    # three\nc: 4 # four\n",
        "a: 1      # one\nlonger: 2 # two\nb:        # b\n  - 3    # three\nc: 4 # four\n",
    ),
    "comments in one column, far from each other": (
        "a:     'x'    # one\nb: 1\nc: 2\nd: 3          # four\n",
        "a: x    # one\nb: 1\nc: 2\nd: 3    # four\n",
    ),
    "no-break spaces, which are text": (
        "a:  b\u00a0  # c\u00a0\n\u00a0d:\t1\u00a0\n",
        "a: b\u00a0  # c\u00a0\n\u00a0d: 1\u00a0\n",
    ),
    "invisible characters, which only quotes show": (
        "a:  '\u200b'\nb: \"\u00a0x\"\nc: \u00a0y\nd: '\U0001f916'\n",
        'a: "\u200b"\nb: "\u00a0x"\nc: \u00a0y\nd: \U0001f916\n',
    ),
    "text of several lines": (
        "a: one\n       two\n\n       three\nb: 'it''s\n  two'\n",
        'a: one\n  two\n\n  three\nb: "it\'s\n  two"\n',
    ),
    "escaped line ends": ('a: "one \\\n      two \\ \n  x"\n', 'a: "one \\\n  two \\ \n  x"\n'),
    "literal text": (
        "a:\n    b: |  # why\n         one\n           two\n\n         three\n\n\n    c: 1\n",
        "a:\n  b: |  # why\n    one\n      two\n\n    three\n\n  c: 1\n",
    ),
    "literal text that begins with blanks": ("a: |4\n      x\n    y\n", "a: |2\n    x\n  y\n"),
    "blank lines that belong to a text": ("a: |+\n   x\n\n\nb: >+\n  y\n\n\n", "a: |+\n  x\n\n\nb: >+\n  y\n\n\n"),
    "anchors, aliases, tags": ("a: &x   {b: 1}\nc:  *x\nd: !!map {}\n", "a: &x {b: 1}\nc: *x\nd: !!map {}\n"),
    "directives and markers": ("%YAML 1.2\n---\na:  1\n...\n", "%YAML 1.2\n---\na: 1\n...\n"),
    "keys with a question mark": ("?   a\n:   b\n", "? a\n: b\n"),
    "a line end of YAML 1.1 in a text": ("a: 'x\u2028y'\nb:  1\n", 'a: "x\\u2028y"\nb: 1\n'),
    "nothing but comments": ("\n# one\n\n\n# two", "# one\n\n# two\n"),
}  # fmt: skip


@pytest.mark.parametrize(("before", "after"), CASES.values(), ids=CASES)
def test_layout(before: str, after: str) -> None:
    assert formatted(before) == after
    assert formatted(after) == after
    assert same_content(parse("", before)[0], parse("", after)[0])


@pytest.mark.parametrize(
    ("one", "other"),
    [("a: 1", "a: 2"), ("a: 1", "a: 1.0"), ("a: '1'", "a: 1"), ("a: .9", "a: 0.9"), ("a: 1\nb: 2", "b: 2\na: 1"),
     ("a: [1]", "a: [1, 1]"), ("a: {b: 1}", "a: [1]"), ("a: true", "a: True")],
)  # fmt: skip
def test_other_content_is_noticed(one: str, other: str) -> None:
    assert not same_content(parse("", one)[0], parse("", other)[0])


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("a: |\n  text", "a: |-\n  text\n"),
        ("a: |+\n  text", "a: |-\n  text\n"),
        ("- >2+ # c\n    text\n\n   b", "- >2- # c\n    text\n\n   b\n"),
        ("a: |+\n  text\n  ", "a: |+\n  text\n"),
        ("a: |+\n  text\n   ", "a: |-\n  text\n   \n"),
        ("a: |-\n  text", "a: |-\n  text\n"),
        ("a: |+\n  text\n\nb: 1", "a: |+\n  text\n\nb: 1\n"),
        ("a: [\n  b # c\n   , ]\nd: 1\n", "a: [\n  b # c\n]\nd: 1\n"),
        ("a: |2\n     \n  b\nc: 1\n", "a: |2\n     \n  b\nc: 1\n"),
        ("a:\n    b: |+4\n            \n    c: 1\n", "a:\n  b: |2+\n        \n  c: 1\n"),
        ("a: {b: x?y, c:   d:e}\n", "a: {b: x?y, c: d:e}\n"),
        ("- - [ b\n  ,]\n", "- - [b\n  ]\n"),
        ("a: {b: 1\n\n  , # c\n}\n", "a: {b: 1\n\n  , # c\n}\n"),
    ],
)  # fmt: skip
def test_the_end_of_a_text_and_of_a_list(before: str, after: str) -> None:
    """Texts at the end of a document without a line break there, and commas in lines of their own."""
    tree, faults = parse("x", before)
    assert not faults and same_content(tree, parse("x", formatted(before))[0])
    assert formatted(formatted(before)) == formatted(before)
    assert formatted(before) == after
