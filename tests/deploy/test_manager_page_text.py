"""The document beside the picture: each follows the other."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from processes import until
from test_manager import manager

pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import Page, expect

from manager_pages import Open, browser, choose, drag, has_facts, item, middle, page, under
from test_manager_page_edit import DOCUMENT, has_action, head, served, shown, text, write

__all__ = ["browser", "head", "page", "served", "shown"]


def marked(page: Page) -> list[str]:
    return page.locator(".cm-line.marked").all_text_contents()


def put_cursor(page: Page, line: str) -> None:
    page.locator(".cm-line", has_text=line).click()


def test_text_and_picture_follow_each_other(head: Path, shown: Page) -> None:
    shown.get_by_role("button", name="YAML").click()
    put_cursor(shown, "  lips:")
    expect(item(shown, "lips")).to_have_attribute("aria-selected", "true")
    assert shown.evaluate("model.selected") == "lips"
    until(lambda: under(shown, *middle(shown, "speech")) == "speech", "the picture made room")
    shown.mouse.click(*middle(shown, "speech"))
    until(lambda: "".join(marked(shown)).startswith("  speech:"), "the lines of what was clicked are marked")

    choose(shown, "lips", "Move to host…")  # a change of the picture appears in the text
    write(shown)
    expect(shown.locator(".cm-line", has_text="lips: {component: mouth, host: onboard}")).to_be_visible()

    put_cursor(shown, "  log:")  # what is typed appears in the picture
    shown.keyboard.press("End")
    shown.keyboard.type("\nwink: {program: sleep, args: ['9'], host: desk}")
    expect(shown.get_by_role("region", name="Document").get_by_role("status")).to_have_text("not saved")
    assert "wink" not in text(head)
    shown.keyboard.press("Control+s")
    expect(item(shown, "wink")).to_be_visible()
    assert "  wink: {program: sleep" in text(head)
    assert "# The one with the good voice." in text(head)


def test_what_is_typed_is_checked_and_completed(head: Path, shown: Page) -> None:
    shown.get_by_role("button", name="YAML").click()
    put_cursor(shown, "  lips:")
    shown.keyboard.press("End")
    shown.keyboard.type("\ntongue: {component: mouht, host: desk}")
    expect(shown.locator(".cm-lintRange-error", has_text="mouht")).to_be_visible()
    shown.keyboard.press("Control+s")  # what has errors is not written without a question
    dialog = shown.get_by_role("dialog")
    expect(dialog).to_contain_text("mouht")
    assert text(head) == DOCUMENT
    dialog.get_by_role("button", name="Back to the text").click()
    shown.locator(".cm-line", has_text="tongue").click()
    shown.keyboard.press("End")
    for _ in range(len("mouht, host: desk}")):
        shown.keyboard.press("Backspace")
    shown.keyboard.type("mou")
    expect(shown.locator(".cm-tooltip-autocomplete")).to_contain_text("mouth")


def test_the_picture_follows_what_is_typed_before_it_is_saved(head: Path, shown: Page) -> None:
    draft = shown.locator("#draft")
    shown.get_by_role("button", name="YAML").click()
    put_cursor(shown, "  log:")
    shown.keyboard.press("End")
    shown.keyboard.type("\nwink: {program: sleep, args: ['9'], host: desk}")
    expect(item(shown, "wink")).to_be_visible()
    until(lambda: under(shown, *middle(shown, "wink")) == "wink", "it is drawn")
    expect(draft).to_contain_text("not saved")
    assert text(head) == DOCUMENT
    shown.keyboard.press("Home")  # a line that is not YAML yet: the last picture stays
    shown.keyboard.type("wonk: [")
    expect(draft).to_contain_text("the last one")
    expect(item(shown, "wink")).to_be_visible()
    for _ in "wonk: [":
        shown.keyboard.press("Backspace")
    expect(draft).not_to_contain_text("the last one")
    shown.keyboard.press("End")
    for _ in ", host: desk}":
        shown.keyboard.press("Backspace")
    shown.keyboard.type(", host: dsek}")  # an error of the text is red in the picture
    until(lambda: shown.evaluate("model.look('wink')") == "down", "its error is shown")
    assert "RC4002" in str(shown.evaluate("model.nodes.get('wink').faults.map((one) => one.code)"))
    choose(shown, "desk", "Close in the picture")  # boxes of it can be closed, too
    until(lambda: shown.evaluate("model.graph.nodes.some((one) => one.kind === 'closed')"), "the box is closed")
    expect(item(shown, "wink")).to_be_visible()
    choose(shown, "desk", "Open in the picture")
    shown.get_by_role("button", name="Discard").click()
    expect(item(shown, "wink")).to_have_count(0)
    expect(draft).to_be_hidden()
    assert text(head) == DOCUMENT


def test_what_others_write_is_not_overwritten(head: Path, shown: Page) -> None:
    shown.get_by_role("button", name="YAML").click()
    document = head / "head.ddsl.yaml"
    document.write_text(DOCUMENT.replace("# spare", "# for Mondays"))
    expect(shown.locator(".cm-line", has_text="# for Mondays")).to_be_visible()  # nothing was typed: it is read again
    put_cursor(shown, "  log:")
    shown.keyboard.press("End")
    shown.keyboard.type("  # mine")
    theirs = DOCUMENT.replace("# spare", "# theirs")
    document.write_text(theirs)
    shown.keyboard.press("Control+s")
    dialog = shown.get_by_role("dialog", name="The file was changed elsewhere")
    expect(dialog.get_by_label("In the file now")).to_contain_text("# theirs")
    expect(dialog.get_by_label("What you meant")).to_contain_text("# mine")
    assert text(head) == theirs
    dialog.get_by_role("button", name="Take theirs").click()
    expect(shown.locator(".cm-line", has_text="# theirs")).to_be_visible()
    assert shown.locator(".cm-line", has_text="# mine").count() == 0
    assert text(head) == theirs


def test_what_is_typed_is_not_lost_by_leaving_it(head: Path, page: Open) -> None:
    other = head / "other.ddsl.yaml"
    other.write_text("deployment: Other\ncomponents: {nap: {program: sleep}}\n")
    lines = "".join(f"# line {number}\n" for number in range(60))  # both versions are longer than what is seen
    (head / "head.ddsl.yaml").write_text(lines + DOCUMENT)
    with manager(head, "head.ddsl.yaml", "other.ddsl.yaml") as one:
        shown = page(one)
        has_facts(shown)
        shown.get_by_role("button", name="YAML").click()
        shown.locator(".cm-content").click()
        shown.keyboard.press("Control+End")
        shown.keyboard.type("# mine")
        which = shown.locator("#which")
        which.select_option("Other")
        expect(shown.get_by_role("alert")).to_contain_text("head.ddsl.yaml is not saved")
        expect(which).to_have_value("Head")
        asked: list[str] = []
        shown.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.dismiss()))
        shown.close(run_before_unload=True)
        until(lambda: asked == ["beforeunload"] or bool(shown.title() and None), "the browser asks")
        (head / "head.ddsl.yaml").write_text(lines + DOCUMENT + "# theirs\n")
        shown.keyboard.press("Control+s")
        theirs = shown.get_by_role("dialog").get_by_label("In the file now").get_by_text("# theirs")
        expect(theirs).to_be_in_viewport()
        shown.get_by_role("dialog").get_by_role("button", name="Take theirs").click()
        which.select_option("Other")
        expect(item(shown, "nap")).to_be_visible()
    other.unlink()


def test_what_others_write_while_both_versions_are_shown_is_not_overwritten(head: Path, shown: Page) -> None:
    shown.get_by_role("button", name="YAML").click()
    put_cursor(shown, "  log:")
    shown.keyboard.press("End")
    shown.keyboard.type("  # mine")
    (head / "head.ddsl.yaml").write_text(DOCUMENT.replace("# spare", "# theirs"))
    shown.keyboard.press("Control+s")
    dialog = shown.get_by_role("dialog", name="The file was changed elsewhere")
    expect(dialog.get_by_label("In the file now")).to_contain_text("# theirs")
    (head / "head.ddsl.yaml").write_text(DOCUMENT.replace("# spare", "# once more"))
    dialog.get_by_role("button", name="Write mine over it").click()
    expect(dialog.get_by_label("In the file now")).to_contain_text("# once more")
    assert "# once more" in text(head)
    dialog.get_by_role("button", name="Write mine over it").click()
    until(lambda: "# mine" in text(head), "it is written over what was shown")
    assert "# once more" not in text(head)


def test_documents_of_components_follow_their_processes_and_these_them(head: Path, shown: Page) -> None:
    choose(shown, "speech", "Show its component's document")
    which = shown.get_by_role("region", name="Document").get_by_role("combobox")
    expect(which).to_have_value("speech/speech.cdsl.yaml")
    expect(shown.locator(".cm-line.marked")).to_have_text(
        ["implements: [Speech]", "requires: [Mouth]", "publishes: [Heard]"]
    )
    item(shown, "lips").click()
    expect(which).to_have_value("mouth/mouth.cdsl.yaml")
    which.select_option("speech/speech.cdsl.yaml")
    put_cursor(shown, "publishes: [Heard]")
    until(lambda: shown.evaluate("model.selected") == "speech", "its process is selected")
    publishes = "model.graph.edges.some((one) => one.kind === 'publishes')"
    assert shown.evaluate(publishes)
    shown.keyboard.press("Home")
    shown.keyboard.type("# ")
    until(lambda: not shown.evaluate(publishes), "the line is gone")
    shown.get_by_role("button", name="Discard").click()
    until(lambda: shown.evaluate(publishes), "the line is back")


@pytest.fixture
def eyes(head: Path) -> Iterator[Path]:
    """A component that is in no network."""
    folder = head / "eyes"
    folder.mkdir()
    yield folder
    shutil.rmtree(folder)


def test_components_have_a_picture_of_their_own_beside_their_documents(head: Path, eyes: Path, shown: Page) -> None:
    """Text and picture follow each other in both directions; a component need not be in the network."""
    (eyes / "eyes.cdsl.yaml").write_text("component: EyesComp  # two\nlanguage: python\nimports: [Talk]\n")
    shown.get_by_role("button", name="Components").click()
    until(lambda: shown.evaluate("model.nodes.has('EyesComp')"), "all components are drawn")
    assert under(shown, *middle(shown, "EyesComp")) == "EyesComp"
    shown.get_by_role("button", name="YAML").click()
    which = shown.get_by_role("region", name="Document").get_by_role("combobox")
    item(shown, "EyesComp").click()
    expect(which).to_have_value("eyes/eyes.cdsl.yaml")
    lines = "model.graph.edges.map((one) => [one.from, one.to, one.kind]).filter((one) => one[0] === 'EyesComp')"
    put_cursor(shown, "imports")  # from the text to the picture
    shown.keyboard.press("End")
    shown.keyboard.type("\nrequires: [Mouth]")
    until(lambda: shown.evaluate(lines) == [["EyesComp", "MouthComp", "uses"]], "what is typed is drawn")
    shown.keyboard.press("Control+s")
    until(lambda: "requires" in (eyes / "eyes.cdsl.yaml").read_text(), "it is saved")
    choose(shown, "EyesComp", "Interfaces…")  # and from the picture to the text
    dialog = shown.get_by_role("dialog")
    dialog.get_by_label("It", exact=True).select_option("publishes")
    dialog.get_by_label("Heard").check()
    write(shown)
    expect(shown.locator(".cm-line", has_text="publishes: [Heard]")).to_be_visible()
    until(lambda: len(shown.evaluate(lines)) == 2, "it is drawn")
    which.select_option("mouth/mouth.cdsl.yaml")
    put_cursor(shown, "implements")
    until(lambda: shown.evaluate("model.selected") == "MouthComp", "the component of the document is selected")
    choose(shown, "EyesComp", "Add to the network…")
    dialog.get_by_label("Its name here").fill("eyes")
    dialog.get_by_role("button", name="although").click(timeout=15_000)  # two serve what it requires
    expect(dialog).to_have_count(0)
    assert "  eyes: {component: eyes" in text(head)
    shown.get_by_role("button", name="Components").click()
    expect(item(shown, "eyes")).to_be_visible()


def test_the_keyboard_moves_boxes_and_the_view(head: Path, shown: Page) -> None:
    where, tree = "[model.nodes.get('log').x, model.nodes.get('log').y]", '[role=treeitem][data-name="log"]'
    x, y = shown.evaluate(where)
    shown.locator(tree).focus()
    for key in ("Alt+ArrowRight", "Alt+ArrowRight", "Alt+ArrowDown"):
        shown.keyboard.press(key)
    until(lambda: shown.evaluate("'log' in model.positions"), "the position is kept")
    assert shown.evaluate(where) == [x + 16, y + 8]
    assert shown.evaluate("document.activeElement.dataset.name") == "log"
    zoom = shown.evaluate("scene.zoom")
    shown.keyboard.press("+")
    assert shown.evaluate("scene.zoom") > zoom
    shown.keyboard.press("0")
    assert shown.evaluate("scene.zoom") == pytest.approx(zoom)


def test_a_position_is_kept_and_forgotten(head: Path, shown: Page) -> None:
    before, start = shown.evaluate("[model.nodes.get('log').x, model.nodes.get('log').y]"), middle(shown, "log")
    drag(shown, start, (start[0] + 90, start[1] + 40))
    until(lambda: shown.evaluate("'log' in model.positions"), "the position is kept")
    where = "[model.nodes.get('log').x, model.nodes.get('log').y]"
    until(lambda: shown.evaluate(where) != before, "the process is where it was put")
    moved = shown.evaluate(where)
    assert text(head) == DOCUMENT
    assert list((head / ".rcyaml/layout").iterdir())
    shown.reload()
    has_facts(shown)
    assert shown.evaluate("[model.nodes.get('log').x, model.nodes.get('log').y]") == moved
    choose(shown, "log", "Forget its position")
    until(lambda: shown.evaluate("[model.nodes.get('log').x, model.nodes.get('log').y]") == before, "it is back")


def test_boxes_close_and_open(head: Path, shown: Page) -> None:
    choose(shown, "desk", "Close in the picture")
    closed = "model.graph.nodes.filter((one) => one.kind === 'closed').map((one) => [one.title, one.members.length])"
    until(lambda: shown.evaluate(closed) == [["desk (127.0.0.2)", 2]], "the host is one node")
    assert shown.evaluate("[...model.nodes.keys()].includes('lips')")
    item(shown, "lips").click()  # what is inside can still be selected
    expect(shown.get_by_role("complementary").get_by_role("heading", name="lips")).to_be_visible()
    name = "host desk"
    until(lambda: under(shown, *middle(shown, name)) == name, "its box is where it is drawn")
    shown.mouse.dblclick(*middle(shown, name))
    until(lambda: shown.evaluate(closed) == [], "it is open again")
    assert has_action(shown, "face", "Close in the picture")


def test_what_a_host_lacks_is_seen(head: Path, shown: Page) -> None:
    shown.get_by_role("button", name="Hosts", exact=True).click()
    drawer = shown.get_by_role("region", name="Hosts")
    drawer.get_by_role("button", name="what onboard has").click()
    rows = drawer.get_by_role("row")
    expect(rows.filter(has_text="speech")).to_contain_text("✕", timeout=15_000)
    expect(rows.filter(has_text="speech")).to_contain_text("SpeechComp")
