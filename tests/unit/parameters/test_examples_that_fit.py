"""Examples of values are values: what `config new` writes for a plain parameter passes `config check`."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.api.values import Values, write_new
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic

TYPES = [
    "type: int", "type: int, range: [5, 9]", "type: float, range: {above: 0, below: 0.5}", "type: int, values: [3, 5, 8]",
    "type: string, pattern: '[a-c][0-9]+'", "type: Side", "type: bool", "type: string",
]  # fmt: skip
SIDE = "types: {Side: {enum: [left, right, both]}}\n"


def _errors(folder: Path, pdsl: str) -> list[Diagnostic]:
    (folder / "c.cdsl.yaml").write_text("component: C\nlanguage: python\nparameters: c.pdsl.yaml\n")
    (folder / "c.pdsl.yaml").write_text(pdsl)
    written = Values(write_new(str(folder / "c.cdsl.yaml")))
    return [one for one in written.diagnostics if one.severity == ERROR]


@pytest.mark.parametrize("type_", TYPES)
def test_a_plain_one(tmp_path: Path, type_: str) -> None:
    assert not _errors(tmp_path, f"{SIDE}parameters:\n  p: {{{type_}}}\n")


@pytest.mark.parametrize("type_", [type_ for type_ in TYPES if "pattern" not in type_])
def test_a_list_of_different_ones(tmp_path: Path, type_: str) -> None:
    size = 2 if "bool" in type_ else 3
    pdsl = f"{SIDE}parameters:\n  p: {{list: {{{type_}}}, size: {size}, unique: true}}\n"
    assert not _errors(tmp_path, pdsl)
