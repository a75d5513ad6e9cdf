"""Each row of the fault table has tests that exist, and each fault of the long run has a row."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from conftest import ROOT

PAGE = (ROOT / "docs" / "faults.md").read_text(encoding="utf-8")
ROWS = [line for line in PAGE.splitlines() if line.startswith("| ") and not line.startswith("| Fault |")]
_TEST = re.compile(r"`(\w+)::(\w+)`")
_TESTS = ROOT / "tests"


def functions(module: str) -> set[str]:
    """The functions of a test module, which has its name without `test_` in short."""
    names = {module, f"test_{module}"}
    (path,) = (path for path in _TESTS.rglob("*.py") if path.stem in names)
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return {one.name for one in tree.body if isinstance(one, ast.FunctionDef)}


def named(row: str) -> list[tuple[str, str]]:
    return _TEST.findall(row.rstrip("| ").rpartition(" | ")[2])


def test_there_are_rows() -> None:
    assert len(ROWS) > 50


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[2:50])
def test_a_row_has_tests(row: str) -> None:
    tests = named(row)
    assert tests, "its last column names none"
    for module, name in tests:
        assert {name, f"test_{name}"} & functions(module), f"{module} has no test '{name}'"


def test_each_fault_of_the_run_has_a_row() -> None:
    path: Path = _TESTS / "deploy" / "test_fault_run.py"
    tree = ast.parse(path.read_text(encoding="utf-8"))
    runs = [
        one.value for one in tree.body
        if isinstance(one, ast.AnnAssign) and ast.unparse(one.target) in ("FAULTS", "LOCAL")
    ]  # fmt: skip
    assert len(runs) == 2
    in_run = {ast.unparse(fault) for faults in runs if isinstance(faults, ast.Tuple) for fault in faults.elts}
    assert in_run == {name for row in ROWS for module, name in named(row) if module == "fault_run"}
