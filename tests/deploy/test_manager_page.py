"""The page of the manager in a real browser, over a real network of programs."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from processes import until
from test_manager import manager, robot

pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import expect

from manager_pages import Open, browser, drag, item, middle, page, pixels, under

__all__ = ["browser", "page", "robot"]


def test_the_network_is_started_and_seen(robot: Path, page: Open) -> None:
    with manager(robot) as one:
        shown = page(one)
        assert shown.url == f"http://127.0.0.1:{one.port}/"
        expect(item(shown, "arm, not started")).to_be_visible()
        before = pixels(shown)
        assert len(set(before)) > 5  # a picture
        shown.get_by_role("button", name="Start…", exact=True).first.click()
        dialog = shown.get_by_role("dialog")
        expect(dialog.get_by_role("listitem")).to_have_text([
            "start base: it does not run yet", "start camera: it does not run yet", "start arm: it does not run yet",
        ])  # fmt: skip
        assert set(one.words().values()) == {"not started"}  # a plan does nothing
        dialog.get_by_role("button", name="Do it").click()
        for name in ("base", "camera", "arm"):
            expect(item(shown, f"{name}, ready")).to_be_visible(timeout=20_000)
        assert pixels(shown) != before
        expect(shown.get_by_role("status")).to_contain_text("3 ready")

        item(shown, "camera").click()
        details = shown.get_by_role("complementary")
        expect(details.get_by_role("heading", name="camera")).to_be_visible()
        pid = next(state["pid"] for state in one.robot("status")[1]["processes"] if state["name"] == "camera")
        expect(details).to_contain_text(str(pid))
        os.kill(pid, signal.SIGKILL)
        expect(details).to_contain_text("SIGKILL", timeout=10_000)
        expect(details).to_contain_text("Restarts")

        details.get_by_role("button", name="stop camera").click()
        shown.get_by_role("dialog").get_by_role("button", name="Do it").click()
        expect(item(shown, "camera, not started")).to_be_visible(timeout=20_000)


def test_the_keyboard_reaches_everything(robot: Path, page: Open) -> None:
    with manager(robot) as one:
        shown = page(one)
        shown.get_by_role("treeitem", name="this machine").focus()
        for key in ("ArrowDown", "ArrowDown", "ArrowDown", "ArrowDown", "Enter"):
            shown.keyboard.press(key)
        expect(shown.get_by_role("heading", name="camera")).to_be_visible()
        expect(item(shown, "camera")).to_have_attribute("aria-selected", "true")
        assert shown.evaluate("model.selected") == "camera"
        for key in ("Home", "ArrowLeft"):
            shown.keyboard.press(key)
        expect(item(shown, "base")).to_be_hidden()
        for key in ("ArrowRight", "End", "Escape"):
            shown.keyboard.press(key)
        expect(shown.get_by_role("complementary")).to_be_hidden()
        assert shown.evaluate("document.activeElement.dataset.name") == "camera"


def test_the_picture_is_moved_and_clicked(robot: Path, page: Open) -> None:
    with manager(robot) as one:
        shown = page(one)
        shown.wait_for_timeout(300)
        was, before = middle(shown, "arm"), pixels(shown)
        assert under(shown, *was) == "arm"
        corner = shown.locator("canvas").bounding_box()
        assert corner is not None
        begin = corner["x"] + 20, corner["y"] + 20
        assert under(shown, *begin) == ""
        drag(shown, begin, (begin[0] + 60, begin[1] + 30))
        now = middle(shown, "arm")
        assert (round(now[0] - was[0]), round(now[1] - was[1])) == (60, 30)
        until(lambda: pixels(shown) != before, "the view moves")
        assert under(shown, *now) == "arm"
        shown.mouse.move(*now)
        zoom = shown.evaluate("scene.zoom")
        shown.mouse.wheel(0, -300)
        until(lambda: shown.evaluate("scene.zoom") > zoom, "the view grows")
        shown.mouse.click(*middle(shown, "arm"))
        expect(shown.get_by_role("heading", name="arm")).to_be_visible()


def test_the_view_goes_to_what_is_selected_and_back(robot: Path, page: Open) -> None:
    with manager(robot) as one:
        shown = page(one)
        view = "[scene.zoom, Math.round(scene.x), Math.round(scene.y)]"
        before = shown.evaluate(view)
        far = max(["arm", "base", "camera"], key=lambda name: middle(shown, name)[0])
        item(shown, far).click()
        assert shown.evaluate(view) != before  # the details would be on it
        edge = shown.locator("#details").bounding_box()
        assert edge is not None
        until(lambda: 0 < edge["x"] - middle(shown, far)[0] < 400, "it is beside the details")
        shown.keyboard.press("Escape")
        assert shown.evaluate(view) == before
        item(shown, far).click()
        shown.evaluate("scene.pan(-40, 0)")  # a person moved it
        moved = shown.evaluate(view)
        shown.keyboard.press("Escape")
        assert shown.evaluate(view) == moved


@pytest.mark.parametrize("size", [(1300, 800), (750, 450), (420, 700)])
def test_everything_is_on_the_screen_however_narrow_it_is(
    robot: Path, page: Open, size: tuple[int, int]
) -> None:  # fmt: skip
    """750 x 450 are 1500 x 900 at a zoom of 200 %."""
    second = (robot / "robot.ddsl.yaml").read_text().replace("Robot", "AnotherRobotWithALongerName")
    (robot / "second.ddsl.yaml").write_text(second)
    with manager(robot, "robot.ddsl.yaml", "second.ddsl.yaml") as one:
        shown = page(one)
        shown.set_viewport_size({"width": size[0], "height": size[1]})
        shown.wait_for_timeout(200)
        assert shown.evaluate("document.documentElement.scrollWidth") <= size[0]
        for one_ in shown.locator("header").get_by_role("button").all():
            place = one_.bounding_box()
            assert place is not None
            assert place["x"] >= 0 and place["x"] + place["width"] <= size[0]
        summary, picture = shown.locator("#summary").bounding_box(), shown.locator("canvas").bounding_box()
        assert summary is not None
        assert picture is not None
        assert summary["height"] < 30
        assert picture["height"] > size[1] / 3


def test_a_page_of_an_earlier_manager_says_so(robot: Path, page: Open) -> None:
    with manager(robot) as one:
        shown = page(one)
    expect(shown.get_by_role("status").first).to_contain_text("no connection to the manager")
    with manager(robot, "--port", str(one.port)):
        expect(shown.get_by_role("alert")).to_contain_text("open the address that it prints", timeout=15_000)


def test_search_and_filter_leave_what_is_meant(robot: Path, page: Open) -> None:
    with manager(robot) as one:
        shown = page(one)
        shown.get_by_role("searchbox").fill("cam")
        expect(item(shown, "camera")).to_be_visible()
        expect(item(shown, "base")).to_be_hidden()
        assert shown.evaluate("[...model.nodes.keys()].filter((name) => model.isClear(name))") == ["camera"]
        shown.get_by_role("searchbox").fill("")
        assert one.robot("up", {"names": ["camera"]})[1]["ok"]
        shown.get_by_label("Show").select_option("ready")
        expect(item(shown, "camera, ready")).to_be_visible(timeout=10_000)
        expect(item(shown, "base")).to_be_hidden()


def test_texts_of_programs_are_no_markup(robot: Path, page: Open) -> None:
    document = robot / "robot.ddsl.yaml"
    evil = "<img src=x onerror=document.title=1><b>bold</b>"
    document.write_text(document.read_text().replace("echo the base turns", f"echo the base turns '{evil}'"))
    with manager(robot) as one:
        shown = page(one)
        assert one.robot("up", {"names": ["base"]})[1]["ok"]
        item(shown, "base").click()
        log = shown.get_by_role("log")
        expect(log).to_contain_text(evil)
        assert log.locator("b, img").count() == 0
        assert shown.title() == "Robot"


def test_changes_of_the_document_appear_and_move_nothing(robot: Path, page: Open) -> None:
    document = robot / "robot.ddsl.yaml"
    with manager(robot) as one:
        shown = page(one)
        places = "Object.fromEntries([...model.nodes].map(([name, node]) => [name, node.x]))"
        before = shown.evaluate(places)
        change = {"change": "add", "entry": "wrist", "program": "sleep", "args": ["9"]}
        assert one.robot("edit", {"change": change})[0] == 200
        expect(item(shown, "wrist")).to_be_visible(timeout=10_000)
        after = shown.evaluate(places)
        assert {name: after[name] for name in before} == before
        document.write_text("deployment: Robot\ncomponents: [\n")
        expect(shown.get_by_role("alert")).to_contain_text("RC01", timeout=10_000)
        assert shown.evaluate("model.nodes.size") == 4  # the last picture stays


def test_a_page_that_nobody_sees_takes_no_connections(robot: Path, page: Open) -> None:
    """A browser has six for all tabs. A page that is seen again shows what happened meanwhile."""
    with manager(robot) as one:
        shown = page(one)
        item(shown, "arm").click()
        streams: list[str] = []
        shown.on("request", lambda request: streams.append(request.url) if "events" in request.url else None)

        def turn(state: str) -> None:
            shown.evaluate(
                "(state) => { Object.defineProperty(document, 'visibilityState', { value: state, configurable: true });"
                "document.dispatchEvent(new Event('visibilitychange')) }", state,
            )  # fmt: skip

        turn("hidden")
        change = {"change": "add", "entry": "wrist", "program": "sleep", "args": ["9"]}
        assert one.robot("edit", {"change": change})[0] == 200
        shown.wait_for_timeout(2500)
        assert (item(shown, "wrist").count(), streams) == (0, [])
        turn("visible")
        expect(item(shown, "wrist")).to_be_visible()
        until(lambda: any("/events" in url for url in streams) and any("log-events" in url for url in streams), "both")
        shown.get_by_role("button", name="History").click()
        expect(shown.get_by_role("region", name="History")).to_contain_text("add wrist")


def test_without_the_right_there_are_no_buttons(robot: Path, page: Open) -> None:
    with manager(robot, "--read-only") as one:
        shown = page(one)
        item(shown, "arm").click()
        expect(shown.get_by_role("heading", name="arm")).to_be_visible()
        assert shown.get_by_role("button", name="Start").count() == 0
        assert shown.get_by_role("button", name="Stop").count() == 0
