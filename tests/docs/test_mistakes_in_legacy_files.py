"""docs/mistakes-in-legacy-files.md has each mistake of the script that writes it, and says what rcyaml reports."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from conftest import ROOT

SCRIPTS = ROOT / "experiments" / "mistakes"
MODULES = ("compare", "legacy_mistakes", "legacy_way", "measure", "by_hand", "wishes", "with_robocompdsl")
SOME = (
    "an unknown language",
    "code that still uses a removed proxy",
)

pytestmark = pytest.mark.processes


@pytest.fixture
def compare(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    monkeypatch.syspath_prepend(str(ROOT / "experiments" / "tasks"))
    monkeypatch.syspath_prepend(str(SCRIPTS))
    yield importlib.import_module("compare")
    for name in MODULES:
        sys.modules.pop(name, None)


def test_the_page_has_each_mistake(compare: ModuleType) -> None:
    rows = compare.on_page(compare.PAGE.read_text(encoding="utf-8"))
    assert [*rows] == [(one.task, one.what) for task in compare.TASKS for one in compare.MISTAKES if one.task == task]
    assert all([*cells] == [*compare.HEAD[1:]] and all(cells.values()) for cells in rows.values())


@pytest.mark.parametrize("what", SOME)
def test_rcyaml_reports_what_the_page_says(what: str, compare: ModuleType, tmp_path: Path) -> None:
    mistake = next(one for one in compare.MISTAKES if one.what == what)
    rows = compare.on_page(compare.PAGE.read_text(encoding="utf-8"))
    pytest.importorskip("Ice", reason="apt install python3-zeroc-ice")
    pytest.importorskip("pygls", reason="pip install 'rcyaml[lsp]'")
    found = compare.of_rcyaml(compare.broken(mistake, tmp_path).rcyaml(), compare.without_mistake(mistake.language))
    assert found == {step: rows[mistake.task, what][step] for step in compare.STEPS}
