"""Data as YAML in blocks: whatever it is, it is read again as the same, and no line is long without need."""

from __future__ import annotations

from typing import Any

import pytest

from robocomp_yaml.source.yaml_text import block


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ({"returns": True}, "returns: true\n"),
        ({"out": {"a": [1, 2], "b": {}}}, "out: {a: [1, 2], b: {}}\n"),
        ({"image": list(range(10, 22))}, "image:\n  [10, 11, 12, 13,\n   14, 15, 16, 17,\n   18, 19, 20, 21]\n"),
        ({"poses": [{"opening": 1.5}, {"opening": 2.5}]}, "poses:\n  - {opening: 1.5}\n  - {opening: 2.5}\n"),
        ({"pose": {"opening": 1.5, "width": 22.5}}, "pose:\n  opening: 1.5\n  width: 22.5\n"),
        ([["one", "two"], ["three", "four"]], "- [one, two]\n- [three, four]\n"),
        ([], "[]\n"),
    ],
)
def test_what_fits_is_in_one_line(data: Any, text: str) -> None:
    width = 20 if "returns" not in data and "out" not in data else 100
    assert block(data, width) == text
