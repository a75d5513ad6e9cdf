"""The key or value at an index of a document: the same as by looking at each, and as fast in a long one."""

from __future__ import annotations

import pytest

from robocomp_yaml.source import spelled
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

TEXTS = [
    "a: 1\nb: {c: [1, 2, {d: x}], e: }\nf:\n  - g\n  - - h\n    - i: j\nk:\n\nl: 'm'\n",
    "a: &x {k: &y 1, n: [2]}\nb: *x\nc: [*y, *x, {p: *y}]\n*y : 3\n",
    "- &a [1, 2]\n- *a\n- {b: *a, c: *a}\n-\n- \U0001f916\r\n",
    "a: |\n  x\n  y\nb: >-\n  z\n# c\nd:   # e\n  f\n",
    "",
]


def _one_by_one(node: Node | None, index: int) -> Scalar | None:
    while node is not None and not isinstance(node, Scalar):
        pairs = [each for pair in node.items() for each in pair] if isinstance(node, Mapping) else []
        children: list[Node] = [*(node.items if isinstance(node, Sequence) else pairs)]
        node = next((one for one in children if one.start <= index < max(one.end, one.start + 1)), None)
    return node


@pytest.mark.parametrize("text", TEXTS)
def test_the_scalar_at_each_index(text: str) -> None:
    document = DocumentText("a.yaml", text)
    for index in range(len(text) + 2):
        assert document._scalar(index) is _one_by_one(document.tree, index), index


def test_a_long_document_is_not_searched_from_its_beginning(monkeypatch: pytest.MonkeyPatch) -> None:
    """A name that is used 5,000 times was renamed, and its uses were shown, after a minute."""
    seen: list[int] = []
    has = spelled._has
    monkeypatch.setattr(spelled, "_has", lambda node, index: (seen.append(index), has(node, index))[1])
    document = DocumentText("a.yaml", "".join(f"key{n}: {{a: [value]}}\n" for n in range(500)))
    assert sum(document._scalar(index) is not None for index in range(0, len(document.text), 20)) > 200
    assert len(seen) < 4000
