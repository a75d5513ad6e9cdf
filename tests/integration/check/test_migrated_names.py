"""Names that C++ cannot have, in documents that `migrate` wrote."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree

TAKEN = {
    "a macro": "enum Kind { EOF, OK };",
    "a macro of windows": "struct Pose { float Q_x; };",
    "a macro of windows as a type": "struct Q_Pose { float x; };",
    "a macro as a method": "interface Chart { void assert(int x); };",
    "a type hidden": "enum Kind { a }; interface Map { void f(Kind Kind, Kind other); };",
    "a result": "enum Kind { a }; interface Map { int f(out Kind Kind); };",
}


@pytest.mark.parametrize("name", TAKEN)
def test_a_document_contains_that_it_was_migrated(name: str, rcyaml: Callable[..., Any], tmp_path: Path) -> None:
    """So it is also known in a clone without the records of `migrate`."""
    write_tree(tmp_path, {
        "Map.idsl": f"/* A map. */\nmodule RoboCompMap {{ {TAKEN[name]} }};\n",
        "Fine.idsl": "module RoboCompFine { interface Fine { void f(int x); }; };\n",
    })  # fmt: skip
    rcyaml("migrate", ".")
    shutil.rmtree(tmp_path / ".rcyaml")
    document = tmp_path / "Map.idsl.yaml"
    text = document.read_text(encoding="utf-8")
    assert "Migrated" not in (tmp_path / "Fine.idsl.yaml").read_text(encoding="utf-8")
    gui = "gui: {toolkit: qt, base: QWidget}\n" if "windows" in name else ""
    document.rename(document.with_name("Chart.idsl.yaml"))
    write_tree(tmp_path, {"c.cdsl.yaml": f"component: C\nlanguage: cpp\n{gui}imports: [Chart]\n"})
    found = rcyaml("check", "--format", "json")
    assert '"warning"' in found.stdout and '"error"' not in found.stdout, found.stdout
    lines = [line for line in text.splitlines() if not line.startswith("# Migrated")]
    write_tree(tmp_path, {"Chart.idsl.yaml": "\n".join([*lines, "# Migrated: not at the head\n"])})
    assert '"error"' in rcyaml("check", "--format", "json").stdout
