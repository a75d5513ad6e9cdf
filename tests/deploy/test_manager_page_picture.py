"""The picture of the manager's page, compared with kept ones: its boxes, lines, states and levels of detail.

The font is the test's own (`pictures/blocks.ttf`: each letter is a rectangle), so that no font of the machine matters.
A tenth of a percent of the pixels may differ. `--update-golden` writes the pictures: look at them before you commit.
"""

from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import until
from test_manager import Manager, manager

pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import Browser, Page

from manager_pages import browser, has_facts
from test_manager_page_edit import FILES

__all__ = ["browser"]

KEPT = Path(__file__).parent / "pictures"
FONT = "@font-face { font-family: Blocks; src: url(blocks.ttf) } html { font-family: Blocks !important }"
TOLERATED = 0.001
DIFFERENT = """async ([one, two]) => {
  const pixels = async (data) => {
    const image = new Image();
    image.src = 'data:image/png;base64,' + data;
    await image.decode();
    const canvas = document.createElement('canvas'), context = canvas.getContext('2d');
    [canvas.width, canvas.height] = [image.width, image.height];
    context.drawImage(image, 0, 0);
    return [image.width, image.height, context.getImageData(0, 0, image.width, image.height).data];
  };
  const [a, b] = [await pixels(one), await pixels(two)];
  if (a[0] !== b[0] || a[1] !== b[1]) return 1;
  let count = 0;
  for (let at = 0; at < a[2].length; at += 4) {
    if ([0, 1, 2].some((part) => Math.abs(a[2][at + part] - b[2][at + part]) > 24)) count += 1;
  }
  return 4 * count / a[2].length;
}"""


STATES = """() => [['speech', true, false], ['mouth', false, true], ['lips', false, false]].forEach(([name, ready, down]) =>
  Object.assign(model.states.get(name), { ready, down, pid: 7 }))"""


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Manager]:
    folder = tmp_path_factory.mktemp("head")
    write_tree(folder, FILES)
    with manager(folder) as one:
        yield one


def opened(browser: Browser, one: Manager, scheme: str) -> Page:
    page = browser.new_page(viewport={"width": 1000, "height": 640}, color_scheme=scheme)  # type: ignore[arg-type]
    page.route("**/blocks.ttf", lambda route: route.fulfill(path=KEPT / "blocks.ttf"))

    def styled(route: object) -> None:
        answer = route.fetch()  # type: ignore[attr-defined]
        route.fulfill(response=answer, body=f"{answer.text()}\n{FONT}")  # type: ignore[attr-defined]

    page.route("**/page.css", styled)
    page.goto(f"http://127.0.0.1:{one.port}/?token={one.token}")
    has_facts(page)
    until(lambda: page.evaluate("model.states.size") > 3, "the states are known")
    page.evaluate(STATES)
    assert page.evaluate("document.fonts.load('12px Blocks').then((found) => found.length)") == 1
    return page


def compare(page: Page, name: str, update: bool) -> None:
    drawn = page.evaluate("scene.drawn")
    page.evaluate("scene.change()")
    until(lambda: page.evaluate("scene.drawn") > drawn, "the picture is drawn")
    found, kept = page.locator("canvas").screenshot(), KEPT / f"{name}.png"
    if update:
        kept.write_bytes(found)
        return
    words = [base64.b64encode(one).decode() for one in (kept.read_bytes(), found)]
    difference = page.evaluate(DIFFERENT, words)
    if difference > TOLERATED:
        beside = kept.with_suffix(".found.png")
        beside.write_bytes(found)
        pytest.fail(f"{difference:.2%} of the pixels differ from {kept}: see {beside}")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_picture_is_the_kept_one(
    browser: Browser, served: Manager, scheme: str, request: pytest.FixtureRequest
) -> None:  # fmt: skip
    update = bool(request.config.getoption("--update-golden"))
    page = opened(browser, served, scheme)
    compare(page, f"all-{scheme}", update)
    page.evaluate("scene.zoomAt(0.35 / scene.zoom, 300, 300)")
    page.wait_for_timeout(300)
    compare(page, f"afar-{scheme}", update)
    page.close()


def test_a_moved_process_would_be_seen(browser: Browser, served: Manager) -> None:
    """The comparison can fail."""
    page = opened(browser, served, "light")
    page.evaluate("model.nodes.get('speech').x += 9")
    page.evaluate("scene.change()")
    page.wait_for_timeout(200)
    words = [
        base64.b64encode(one).decode()
        for one in ((KEPT / "all-light.png").read_bytes(), page.locator("canvas").screenshot())
    ]
    assert page.evaluate(DIFFERENT, words) > TOLERATED
    page.close()
