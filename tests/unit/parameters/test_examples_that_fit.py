"""Examples of values are values: what `config new` writes for a plain parameter passes `config check`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

TYPES = [
    "type: int", "type: int, range: [5, 9]", "type: float, range: {above: 0, below: 0.5}", "type: int, values: [3, 5, 8]",
    "type: string, pattern: '[a-c][0-9]+'", "type: Side", "type: bool", "type: string",
]  # fmt: skip
SIDE = "types: {Side: {enum: [left, right, both]}}\n"


def _errors(rcyaml: Callable[..., Result], folder: Path, pdsl: str) -> str:
    (folder / "c.cdsl.yaml").write_text("component: C\nlanguage: python\nparameters: c.pdsl.yaml\n")
    (folder / "c.pdsl.yaml").write_text(pdsl)
    assert rcyaml("config", "new", "c.cdsl.yaml").exit_code == 0
    result = rcyaml("config", "check", "etc/config.yaml")
    return "" if result.exit_code == 0 else result.output


@pytest.mark.parametrize("type_", TYPES)
def test_a_plain_one(rcyaml: Callable[..., Result], tmp_path: Path, type_: str) -> None:
    assert not _errors(rcyaml, tmp_path, f"{SIDE}parameters:\n  p: {{{type_}}}\n")


@pytest.mark.parametrize("type_", [type_ for type_ in TYPES if "pattern" not in type_])
def test_a_list_of_different_ones(rcyaml: Callable[..., Result], tmp_path: Path, type_: str) -> None:
    size = 2 if "bool" in type_ else 3
    pdsl = f"{SIDE}parameters:\n  p: {{list: {{{type_}}}, size: {size}, unique: true}}\n"
    assert not _errors(rcyaml, tmp_path, pdsl)
