"""The table of what both language servers know at forty positions is up to date."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from conftest import ROOT
from editor.editing import Editor, edited
from editor.positions import Ours, Spot, page, spots, theirs
from editor.workbench import Workbench

PAGE = ROOT / "docs/editors/positions.md"
pytestmark = pytest.mark.processes


def test_the_table_is_up_to_date(compiled: Workbench, request: pytest.FixtureRequest) -> None:
    rows: list[tuple[Spot, list[str]]] = []

    async def ask(editor: Editor) -> None:
        answered = await editor.start(compiled.folder, schema_server="no")
        ours = Ours(editor, compiled.folder, answered.capabilities)
        for spot in spots():
            rows.append((spot, await ours.answers(spot)))

    edited(ask)
    assert len(rows) >= 40
    text = page(
        [
            (spot, [*cells, *theirs(compiled.server, compiled.folder, number, spot)])
            for number, (spot, cells) in enumerate(rows)
        ]
    )
    if request.config.getoption("--update-golden"):
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(text, encoding="utf-8")
    assert text == PAGE.read_text(encoding="utf-8"), "pytest tests/editor/test_positions.py --update-golden"
