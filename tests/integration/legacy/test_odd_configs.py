"""Flat configs with odd names, odd keys, and thousands of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]


def test_odd_names_and_odd_keys(rcyaml: Run, tmp_path: Path) -> None:
    many = "".join(f"K{number}.a.b{number} = {number}\n" for number in range(3000))
    write_tree(tmp_path, {
        "config con ñ": "a" + ".b" * 3000 + " = 1\nClass.class = 2\nx-y = 3\n", "config_many": many,
        "config_crlf": "# a\r\nA = 1\r\n", "config_bom": b"\xef\xbb\xbfA = 1\n", "config_latin": b"A = \xf1\n",
    })  # fmt: skip
    result = rcyaml("migrate", ".", "--report", "ledger.json")
    assert result.exit_code == 0, result.output
    assert "parameters:\n  A: ñ\n" in (tmp_path / "config_latin.config.yaml").read_text(encoding="utf-8")
    checked = rcyaml("check", ".")
    assert "error" not in checked.output.replace("0 errors", ""), checked.output
