"""The pages of diagnostics say what there is to say about each code of the table, and the index leads to it."""

from __future__ import annotations

import re

import pytest

from conftest import ROOT
from robocomp_yaml.diag import page
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.diagnostic import SEVERITIES

PAGES = {path.stem for path in (ROOT / "docs" / "diagnostics").glob("*.md")}
INDEX = (ROOT / "docs" / "diagnostics.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(PAGES))
def test_a_page_has_the_codes_of_its_family(name: str) -> None:
    on_page = [*page.page(name).severities]
    assert on_page == sorted(row.id for row in table().values() if row.page == name)
    text = (ROOT / "docs" / "diagnostics" / f"{name}.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (?!Beside the examples$)(.*)$", text, re.MULTILINE) == on_page


def test_no_code_stands_on_a_page_that_there_is_not() -> None:
    assert {row.page for row in table().values()} == PAGES


@pytest.mark.parametrize("row", table().values(), ids=lambda row: row.id)
def test_an_entry_is_whole(row: Code) -> None:
    entry = row.entry
    assert row.severity in SEVERITIES
    assert entry.why and entry.wrong and entry.right
    for message in row.messages:  # what a reader meets on the screen can be found: some words are the page's own
        assert re.search(r"\b[a-z]{2}", message), message
        assert "PROBLEM" not in message


@pytest.mark.parametrize("row", table().values(), ids=lambda row: row.id)
def test_the_index_leads_to_it(row: Code) -> None:
    """Links to `docs/diagnostics.md#rc1001` lead on."""
    anchor = row.id.lower()
    assert f'<a id="{anchor}"></a>[{row.id}](diagnostics/{row.page}.md#{anchor})' in INDEX


def test_the_index_names_no_code_that_is_gone() -> None:
    assert {*re.findall(r"\[(RC\d+)\]", INDEX)} == {*table()}
