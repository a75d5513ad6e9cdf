"""Constraints and values for them: accessors in every language must judge them as the checker does."""

from __future__ import annotations

from typing import Any

CONSTRAINTS = [
    "low + 1 < high * 2 - 1 and not high % 2 == 0",
    "max(low, high) >= 2 or min(ids) > 0",
    "unique(ids)",
    "len(names) > 0",
    "text in ['a', 'b'] or has(limit)",
    "low < limit",
    "has(limit) and limit > low",
    "not (limit < 3) or low == 1",
    "all(p.x < limit for p in points)",
    "any(p.x == low for p in points if has(p.tag))",
    "points[low].x > 0",
    "all(p.tag != 'bad' for p in points if p.tag != 'skip')",
    "sum(p.x for p in points) / low > 1.5",
    "names['a'] == 2",
    "'a' in names",
    "all(k != 'b' for k in keys(names))",
    "sum(values(names)) < 9",
    "high / (low - 1) > 0",
    "abs(-low) == low < high",
    "more[0] > 1",
    "len(more) > 2",
    "all(x > 0 for x in more)",
    "max(x for x in more) > 4",
    "mode == 'fast' or class == 'a'",
    "min(limit, low) < 5",
    "unique(p.tag for p in points)",
    "-high % 4 == 3 or high % -4 == -2",
    "low in [1, 5.0] and 2.0 in ids",
    "all(q != low or q not in ids for q in ids)",
]
SUBJECT = """\
types:
  Speed: {{enum: [slow, fast]}}
  P: {{struct: {{x: double, tag: {{type: string, optional: true}}}}}}
parameters:
  low: int
  high: int
  limit: {{type: double, optional: true}}
  ids: {{list: int}}
  more: {{list: double, optional: true}}
  names: {{map: long}}
  points: {{list: P}}
  text: string
  mode: Speed
  class: string
constraints: {those}
"""
_BASE: dict[str, Any] = {"text": "a", "mode": "slow", "class": "a"}
CASES: list[dict[str, Any]] = [
    {**_BASE, "low": 1, "high": 2, "ids": [1, 2], "names": {"a": 2}, "points": [{"x": 1}, {"x": 2.5, "tag": "t"}]},
    {**_BASE, "low": 0, "high": -3, "ids": [], "names": {}, "points": [], "text": "c", "mode": "fast", "limit": 2},
    {**_BASE, "low": 5, "high": 7, "ids": [3, 3], "names": {"b": 9}, "points": [{"x": 5, "tag": "bad"}], "class": "",
     "limit": 4.5, "more": [4.5, -1]},
    {**_BASE, "low": -1, "high": 1, "ids": [0], "names": {"a": 1}, "text": "b", "mode": "fast", "more": [],
     "points": [{"x": 1, "tag": "skip"}, {"x": -1, "tag": "skip"}]},
    {**_BASE, "low": 2, "high": 6, "ids": [2**31 - 1], "names": {"a": 2**63 - 1, "c": 2**63 - 1}, "points": [{"x": 0}],
     "more": [1.5, 2.5, 6.0], "limit": 0.5},
]  # fmt: skip


def subject(*constraints: str) -> str:
    """A document of parameters with these constraints."""
    return SUBJECT.format(those=_listed(constraints))


def _listed(constraints: tuple[str, ...]) -> str:
    return "[" + ", ".join('"' + that.replace('"', '\\"') + '"' for that in constraints) + "]"
