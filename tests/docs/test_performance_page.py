"""The page on performance has the rows of its benchmark, with figures from a run."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\| (?P<name>[^|]+) \| (?P<own>[^|]+) \| (?P<goal>[^|]+) \|", re.MULTILINE)
FIGURE = re.compile(r"[\d,]+ (?:ms|MiB)")


def test_the_page_has_the_rows_of_the_benchmark(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(ROOT / "benchmarks"), *sys.path])
    for name in ("run", "editors"):  # tests may have imported modules with these names
        monkeypatch.delitem(sys.modules, name, raising=False)
    import editors as benchmark

    shown = [match for match in ROW.finditer(benchmark.PAGE.read_text()) if FIGURE.fullmatch(match["goal"])]
    assert [(one["name"], one["goal"]) for one in shown] == [
        (row.name, f"{row.goal:,.0f} {row.unit}") for row in benchmark.ROWS
    ]
    assert all(FIGURE.fullmatch(one["own"]) for one in shown), "each figure is from a run"
    for name in re.findall(r"benchmarks/(\w+)\.py", benchmark.PAGE.read_text()):
        assert (ROOT / f"benchmarks/{name}.py").is_file()
