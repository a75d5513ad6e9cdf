"""The page of the manager in a real browser: for tests of it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from processes import until
from test_manager import Manager

pytest.importorskip("rcyaml_manager", reason="the page is not built: pip install ./web")
pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import Browser, ConsoleMessage, Locator, Page, expect, sync_playwright

BROWSER = shutil.which("chromium")
if BROWSER is None:
    pytest.skip("Chromium is not installed: apt install chromium", allow_module_level=True)

Open = Callable[..., Page]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        made = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        yield made
        made.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Open]:
    """Opens the page of a manager. Nothing may be wrong in the browser's console, and nobody else may be asked."""
    wrong: list[str] = []
    asked: set[str] = set()
    contexts = []

    def is_wrong(message: ConsoleMessage) -> bool:
        """Not that the manager ended, or refused something: that is shown in the page."""
        return message.type == "error" and not message.text.startswith("Failed to load resource")

    def opened(one: Manager, **options: Any) -> Page:
        contexts.append(browser.new_context(viewport={"width": 1300, "height": 800}, **options))
        made = contexts[-1].new_page()
        made.set_default_timeout(8_000)
        made.on("console", lambda message: wrong.append(message.text) if is_wrong(message) else None)
        made.on("pageerror", lambda error: wrong.append(str(error)))
        made.on("request", lambda request: asked.add(request.url.split("/")[2]))
        made.goto(f"http://127.0.0.1:{one.port}/?token={one.token}")
        expect(made.get_by_role("treeitem").first).to_be_visible()
        return made

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []
    assert all(host.startswith("127.0.0.1:") for host in asked)


def item(page: Page, name: str) -> Locator:
    return page.get_by_role("treeitem", name=name)


def choose(page: Page, name: str, action: str) -> None:
    """Chooses from the menu of an item of the tree, with the keyboard alone."""
    page.locator(f'[role=treeitem][data-name="{name}"]').focus()
    page.keyboard.press("Shift+F10")
    page.get_by_role("menuitem", name=action, exact=True).focus()
    page.keyboard.press("Enter")


def on_screen(page: Page, script: str, *words: object) -> tuple[float, float]:
    """A point of the picture, which `script` computes from `model`, where it is on the screen."""
    place = page.locator("canvas").bounding_box()
    assert place is not None
    x, y = page.evaluate(f"(words) => {{ const [x, y] = (({script})(...words));"
                         "return [scene.x + x * scene.zoom, scene.y + y * scene.zoom] }", list(words))  # fmt: skip
    return place["x"] + x, place["y"] + y


def middle(page: Page, name: str) -> tuple[float, float]:
    script = "(name) => { const n = model.nodes.get(name); return [n.x + n.width / 2, n.y + n.height / 2] }"
    return on_screen(page, script, name)


def under(page: Page, x: float, y: float) -> str:
    """The node of the picture at a point of the screen; '' if something else is in front of it, or none is there."""
    found: str = page.evaluate(
        "([x, y]) => { const e = document.elementFromPoint(x, y), p = e.getBoundingClientRect();"
        "return e.id === 'picture' ? scene.at(x - p.x, y - p.y)?.name ?? '' : '' }", [x, y],
    )  # fmt: skip
    return found


def drag(page: Page, start: tuple[float, float], end: tuple[float, float]) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=4)
    page.mouse.up()


def pixels(page: Page) -> list[int]:
    """The picture as it was drawn: every 97th byte of it."""
    found: list[int] = page.evaluate(
        "() => { const c = document.getElementById('picture');"
        "return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data].filter((_, at) => at % 97 === 0) }"
    )
    return found


def has_facts(page: Page) -> None:
    """Waits until the page knows what can be changed."""
    until(lambda: page.evaluate("facts.entries.length > 0"), "the page knows the entries")
