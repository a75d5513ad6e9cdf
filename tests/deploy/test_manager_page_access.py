"""The page for those who do not see the picture or hold no mouse: axe finds nothing serious, whatever is open."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from test_manager import manager

pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import Page, expect

from manager_pages import Open, browser, choose, has_facts, item, page
from test_manager_page_edit import FILES

__all__ = ["browser", "page"]

AXE = Path(__file__).parents[2] / "web/node_modules/axe-core/axe.min.js"
if not AXE.exists():
    pytest.skip("axe is not installed: pip install ./web, or npm ci in web/", allow_module_level=True)


def serious(page: Page) -> list[Any]:
    """What axe finds. The page's policy allows no other script, so that it comes by the debugger."""
    session = page.context.new_cdp_session(page)
    session.send("Runtime.evaluate", {"expression": AXE.read_text()})
    script = (
        "axe.run(document, {resultTypes: ['violations']}).then((found) => found.violations"
        ".filter((one) => one.impact === 'serious' || one.impact === 'critical')"
        ".map((one) => [one.id, one.nodes.map((node) => node.html.slice(0, 160) + ' ' + node.any.map((a) => a.message))]))"
    )
    answer = session.send("Runtime.evaluate", {"expression": script, "awaitPromise": True, "returnByValue": True})
    session.detach()
    found: list[Any] = answer["result"]["value"]
    return found


def _plan(page: Page) -> None:
    page.get_by_role("button", name="Start…", exact=True).first.click()
    expect(page.get_by_role("dialog")).to_be_visible()


def _proposal(page: Page) -> None:
    choose(page, "speech", "Set a parameter…")
    expect(page.locator(".diff")).to_be_visible()


def _call(page: Page) -> None:
    choose(page, "speech", "Call a method…")
    expect(page.get_by_role("dialog")).to_be_visible()


def _menu(page: Page) -> None:
    item(page, "speech").focus()
    page.keyboard.press("m")
    expect(page.get_by_role("menu")).to_be_visible()


def _details(page: Page) -> None:
    item(page, "speech").click()


def _text(page: Page) -> None:
    page.get_by_role("button", name="YAML").click()
    page.locator(".cm-line", has_text="speech:").click()


def _group(page: Page) -> None:
    choose(page, "speech", "Add to group…")
    expect(page.get_by_role("dialog")).to_be_visible()


def _find(page: Page) -> None:
    """The panel of the editor, with what is typed in a document that is not saved."""
    page.locator(".cm-line", has_text="speech:").click()
    page.keyboard.press("End")
    page.keyboard.type("x")
    page.keyboard.press("Control+f")
    expect(page.locator(".cm-search")).to_be_visible()
    expect(page.locator("#draft")).to_be_visible()


def _drawer(name: str) -> Callable[[Page], None]:
    def opened(page: Page) -> None:
        page.get_by_role("button", name=name, exact=True).click()
        expect(page.get_by_role("region", name=name)).to_be_visible()
        page.get_by_role("button", name=re.compile("close")).first.focus()

    return opened


STATES: dict[str, Callable[[Page], None]] = {
    "start": lambda page: None, "details": _details, "menu": _menu, "plan": _plan, "proposal": _proposal, "call": _call,
    "logs": _drawer("Logs"), "history": _drawer("History"), "hosts": _drawer("Hosts"), "text": _text,
    "group": _group, "find": _find,
}  # fmt: skip


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious(tmp_path: Path, page: Open, scheme: str) -> None:
    write_tree(tmp_path, FILES)
    found: dict[str, list[Any]] = {}
    with manager(tmp_path) as one:
        shown = page(one, color_scheme=scheme)
        has_facts(shown)
        for name, reach in STATES.items():
            reach(shown)
            if wrong := serious(shown):
                found[name] = wrong
            shown.keyboard.press("Escape")
    assert found == {}
