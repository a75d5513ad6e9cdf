"""Editing a network in the page of the manager: by drag, and by the keyboard."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import until
from test_manager import Manager, manager

pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import Page, expect

from manager_pages import Open, browser, choose, drag, has_facts, item, middle, on_screen, page, under

__all__ = ["browser", "page"]

DOCUMENT = """\
deployment: Head
hosts:
  onboard: 127.0.0.1   # behind the neck
  desk: 127.0.0.2
services: {storm: {icestorm: {host: onboard}}}
components:
  # The one with the good voice.
  speech: {component: speech, host: onboard, connect: {Mouth: mouth}}   # talks
  mouth: {component: mouth, host: onboard}
  lips: {component: mouth, host: desk}  # spare
  log: {program: sleep, args: ["600"], host: desk}
groups: {face: {components: [mouth]}}
"""
FILES = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Talk.idsl.yaml": """\
module: RoboCompTalk
interfaces:
  Speech: {methods: {say: {in: {text: string}}}}
  Mouth: {methods: {open: {in: {by: float}}}}
topics:
  Heard: {methods: {word: {in: {text: string}}}}
""",
    "speech/speech.cdsl.yaml": """\
component: SpeechComp
language: python
imports: [Talk]
implements: [Speech]
requires: [Mouth]
publishes: [Heard]
parameters: speech.pdsl.yaml
""",
    "speech/speech.pdsl.yaml": """\
parameters:
  volume: {type: float, default: 0.5, range: [0, 1], doc: How loud it is.}
  delay: {type: int, default: 20, unit: ms}
  voice: {type: string, default: low, values: [low, high]}
  key: {type: string, optional: true, secret: true}
""",
    "speech/etc/config.yaml": "parameters: {delay: 25}\n",
    "mouth/mouth.cdsl.yaml": """\
component: MouthComp
language: python
imports: [Talk]
implements: [Mouth]
subscribes: [Heard]
""",
    "head.ddsl.yaml": DOCUMENT,
}
HANDLE = "(name) => { const n = model.nodes.get(name); return [n.x + n.width, n.y + n.height - 9] }"
END = "(from, to) => model.graph.edges.find((e) => e.kind === 'uses' && e.from === from && e.to === to).points.at(-1)"


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, Manager]]:
    """One manager for all tests of a module."""
    folder = tmp_path_factory.mktemp("head")
    write_tree(folder, FILES)
    with manager(folder) as one:
        yield folder, one


@pytest.fixture
def head(served: tuple[Path, Manager]) -> Path:
    """The workspace as it was."""
    folder = served[0]
    shutil.rmtree(folder / ".rcyaml", ignore_errors=True)
    write_tree(folder, FILES)
    return folder


@pytest.fixture
def shown(served: tuple[Path, Manager], head: Path, page: Open) -> Page:
    made = page(served[1])
    has_facts(made)
    return made


def text(head: Path) -> str:
    return (head / "head.ddsl.yaml").read_text()


def write(page: Page) -> None:
    button = page.get_by_role("button", name="Write", exact=True)
    expect(button).to_be_enabled(timeout=15_000)
    button.click()
    expect(page.get_by_role("dialog")).to_have_count(0)


def uses(page: Page) -> list[list[str]]:
    found: list[list[str]] = page.evaluate(
        "model.graph.edges.filter((e) => e.kind === 'uses').map((e) => [e.from, e.to])"
    )
    return found


def test_a_drag_connects_and_another_one_disconnects(head: Path, shown: Page) -> None:
    shown.mouse.move(*middle(shown, "speech"))
    target = middle(shown, "lips")
    assert under(shown, *target) == "lips"
    drag(shown, on_screen(shown, HANDLE, "speech"), target)
    expect(shown.get_by_role("dialog", name="Connect speech")).to_contain_text("+  speech:")
    assert text(head) == DOCUMENT  # a preview writes nothing
    write(shown)
    assert text(head) == DOCUMENT.replace("Mouth: mouth", "Mouth: lips")
    until(lambda: uses(shown) == [["speech", "lips"]], "the picture follows")
    x, y = on_screen(shown, END, "speech", "lips")
    empty = (x - 8, shown.viewport_size["height"] - 8)  # type: ignore[index]
    assert under(shown, *empty) == ""
    drag(shown, (x - 5, y), empty)
    expect(shown.get_by_role("dialog", name="Disconnect speech")).to_contain_text("-  speech:")
    shown.get_by_role("dialog").get_by_role("button", name="Write it although it causes errors").click()
    expect(shown.get_by_role("dialog")).to_have_count(0)
    assert "connect" not in text(head)
    shown.get_by_role("button", name="Undo").click()
    until(lambda: text(head) == DOCUMENT.replace("Mouth: mouth", "Mouth: lips"), "undone")
    shown.keyboard.press("Control+z")
    until(lambda: text(head) == DOCUMENT, "undone by the keyboard")
    shown.get_by_role("button", name="Redo").click()
    until(lambda: "Mouth: lips" in text(head), "done again")


def test_a_drag_to_another_host_moves_the_entry(head: Path, shown: Page) -> None:
    box = "(name) => { const h = model.graph.hosts.find((one) => one.name === name); return [h.x + h.width - 4, h.y + h.height - 4] }"
    drag(shown, middle(shown, "mouth"), on_screen(shown, box, "desk"))
    write(shown)
    assert text(head) == DOCUMENT.replace(
        "mouth: {component: mouth, host: onboard}", "mouth: {component: mouth, host: desk}"
    )
    until(lambda: shown.evaluate("model.nodes.get('mouth').host") == "desk", "the picture follows")


def test_the_keyboard_changes_everything(head: Path, shown: Page) -> None:
    """Each change by its menu, its fields, and what the document has after it."""
    steps: list[tuple[str, str, dict[str, str], list[str], str]] = [
        ("speech", "Connect…", {"Who serves it": "lips"}, [], "connect: {Mouth: lips}}   # talks"),
        ("speech", "Topics…", {"The topic in this network": "Said"}, [], "topics: {Heard: Said}"),
        ("lips", "Move to host…", {"To the host": "onboard"}, [], "lips: {component: mouth, host: onboard}  # spare"),
        ("lips", "Add to group…", {"Group": "spares"}, [], "spares: {components: [lips]}"),
        ("lips", "Port…", {"TCP port": "10017"}, [], "port: 10017"),
        ("lips", "Start after…", {}, ["log"], "after: [log]"),
        ("lips", "Start independently of…", {}, ["log"], "-after"),
        ("log", "Rename…", {"New name": "diary"}, [], "  diary: {program: sleep"),
        ("mouth", "Instances…", {"Number of processes": "2"}, [], "instances: 2"),
        ("face", "Remove from it…", {}, ["mouth{i}"], "-face"),
        ("lips", "Remove…", {}, [], "-lips: {component"),
    ]
    for name, action, fields, boxes, expected in steps:
        until(
            lambda name=name: shown.locator(f'[role=treeitem][data-name="{name}"]').count() == 1,
            f"{name} is in the tree",
        )
        until(lambda action=action, name=name: has_action(shown, name, action), f"{action} of {name}")
        if "mouth{i}" in boxes:
            expect(shown.locator('[role=treeitem][data-name="mouth1"]')).to_have_count(1)  # its instances are known
        choose(shown, name, action)
        dialog = shown.get_by_role("dialog")
        for label, value in fields.items():
            field = dialog.get_by_label(label, exact=True)
            if field.evaluate("(one) => one.tagName") == "SELECT":
                field.select_option(value)
            else:
                field.fill(value)
        for box in boxes:
            dialog.get_by_label(box, exact=True).check()
        before = text(head)
        expect(dialog.locator(".diff, .fault").first).to_be_visible()
        if dialog.get_by_role("button", name="although").is_visible():
            dialog.get_by_role("button", name="although").click()
            expect(dialog).to_have_count(0)
        else:
            write(shown)
        assert text(head) != before, action
        assert (expected[1:] not in text(head)) if expected[0] == "-" else (expected in text(head)), (
            action,
            text(head),
        )
    assert "# The one with the good voice." in text(head)
    assert "# behind the neck" in text(head)


def has_action(page: Page, name: str, action: str) -> bool:
    page.locator(f'[role=treeitem][data-name="{name}"]').focus()
    page.keyboard.press("m")
    expect(page.get_by_role("menu")).to_be_visible()
    found = page.get_by_role("menuitem", name=action, exact=True).count() > 0
    page.keyboard.press("Escape")
    return found


def test_fields_of_parameters_know_their_types(head: Path, shown: Page) -> None:
    choose(shown, "speech", "Set a parameter…")
    dialog = shown.get_by_role("dialog")
    dialog.get_by_label("Parameter").select_option("volume")
    volume = dialog.get_by_label("Value", exact=True)
    assert [volume.get_attribute(name) for name in ("type", "min", "max")] == ["number", "0", "1"]
    expect(dialog).to_contain_text("How loud it is.")
    volume.fill("3")
    expect(dialog.get_by_role("button", name="Write", exact=True)).to_be_disabled()
    dialog.get_by_label("Parameter").select_option("voice")
    assert dialog.get_by_label("Value", exact=True).locator("option").all_text_contents() == ["low", "high"]
    dialog.get_by_label("Parameter").select_option("key")
    assert dialog.get_by_label("Value", exact=True).get_attribute("type") == "password"
    expect(dialog.locator(".diff")).to_have_count(0)  # an empty field is no empty secret
    dialog.get_by_label("Parameter").select_option("delay")
    delay = dialog.get_by_label("Value (ms)")
    assert delay.get_attribute("step") == "1"
    assert delay.input_value() == "25"  # of its own configuration, not the default
    delay.fill("35")
    write(shown)
    assert "set: {delay: 35}}   # talks" in text(head)


def test_a_dialog_begins_with_what_is(head: Path, shown: Page) -> None:
    """What was opened and not changed can change nothing."""
    document = text(head).replace("component: speech, host", "component: speech, port: 10007, host")
    document = document.replace('args: ["600"]', 'args: ["600"], endpoints: {Log: tcp -p 10008}, role: server')
    many = "".join(f"  p{number}: {{program: sleep, host: desk}}\n" for number in range(60))
    document = document.replace("groups:", f"{many}groups:")
    (head / "head.ddsl.yaml").write_text(document)
    until(lambda: shown.evaluate("facts.entry('log').serves[0]?.number") == 10008, "the port is known")
    for name, number in (("speech", "10007"), ("log", "10008")):
        choose(shown, name, "Port…")
        dialog = shown.get_by_role("dialog")
        expect(dialog.get_by_label("TCP port")).to_have_value(number)
        expect(dialog.get_by_role("button", name="Write", exact=True)).to_be_disabled()
        dialog.get_by_label("TCP port").fill("10009")
        expect(dialog.locator(".diff .added")).to_contain_text("10009")
        shown.keyboard.press("Escape")
    choose(shown, "speech", "Start after…")
    last = shown.get_by_role("dialog").get_by_label("p59", exact=True)
    list_ = shown.locator("dialog fieldset")
    assert list_.evaluate("(e) => e.scrollWidth <= e.clientWidth && e.scrollHeight > e.clientHeight")
    last.check()  # it is scrolled to
    expect(last).to_be_in_viewport()
    shown.keyboard.press("Escape")
    choose(shown, "speech", "Topics…")
    expect(shown.get_by_role("dialog").get_by_label("The topic in this network")).to_have_value("")
    expect(shown.get_by_role("dialog").get_by_role("button", name="Write", exact=True)).to_be_disabled()
    shown.keyboard.press("Escape")
    assert text(head) == document


def test_entries_hosts_and_interfaces_are_added(head: Path, shown: Page) -> None:
    def add(action: str, **fields: str) -> None:
        shown.get_by_role("button", name="Add ▾").click()
        shown.get_by_role("menuitem", name=action).click()
        for label, value in fields.items():
            shown.get_by_role("dialog").get_by_label(label.replace("_", " "), exact=True).fill(value)

    add("Add a component…", Its_name_here="tongue")
    expect(shown.get_by_role("dialog")).to_contain_text("+  tongue: {component: mouth")
    write(shown)
    expect(item(shown, "tongue")).to_be_visible()
    add("Add a program…", Program_and_arguments="sh -c 'sleep 99 && exit 3' \"\"", Its_name_here="nap")
    write(shown)
    assert 'nap: {program: sh, args: ["-c", "sleep 99 && exit 3", ""]' in text(head)
    add("Add a host…", Name="cloud", Address="127.0.0.9")
    write(shown)
    assert "  cloud: 127.0.0.9\n" in text(head)
    until(lambda: has_action(shown, "tongue", "Interfaces of its component…"), "the entry is known")
    choose(shown, "tongue", "Interfaces of its component…")
    dialog = shown.get_by_role("dialog")
    dialog.get_by_label("It", exact=True).select_option("publishes")
    dialog.get_by_label("Heard").check()
    expect(dialog).to_contain_text("+publishes: [Heard]")
    write(shown)
    assert "publishes: [Heard]" in (head / "mouth/mouth.cdsl.yaml").read_text()
    shown.get_by_role("button", name="Undo").click()  # of the document that was changed last
    until(lambda: "publishes" not in (head / "mouth/mouth.cdsl.yaml").read_text(), "undone")


def test_an_error_is_told_before_it_is_written(head: Path, shown: Page) -> None:
    choose(shown, "speech", "Connect…")
    dialog = shown.get_by_role("dialog")
    dialog.get_by_label("Who serves it").fill("nobody")
    expect(dialog.locator(".fault").first).to_contain_text("nobody")
    expect(dialog.get_by_role("button", name="Write", exact=True)).to_be_disabled()
    dialog.get_by_role("button", name="Cancel").click()
    assert text(head) == DOCUMENT


def test_a_conflict_shows_both_versions(head: Path, shown: Page) -> None:
    choose(shown, "lips", "Move to host…")
    dialog = shown.get_by_role("dialog")
    dialog.get_by_label("To the host").select_option("onboard")
    expect(dialog.locator(".added")).to_have_count(1)
    expect(dialog.get_by_role("button", name="Write", exact=True)).to_be_enabled()
    mine = DOCUMENT + "# written in an editor\n"
    (head / "head.ddsl.yaml").write_text(mine)
    dialog.get_by_role("button", name="Write", exact=True).click()
    expect(dialog.get_by_role("alert")).to_contain_text("changed meanwhile")
    expect(dialog.get_by_label("In the file now")).to_contain_text("# written in an editor")
    expect(dialog.get_by_label("What you meant")).to_contain_text("lips: {component: mouth, host: onboard}")
    assert text(head) == mine
    dialog.get_by_role("button", name="Make the change in the file as it is").click()
    expect(dialog.locator(".diff .added")).to_have_count(1)
    write(shown)
    assert text(head) == mine.replace("host: desk}  # spare", "host: onboard}  # spare")


@pytest.mark.parametrize("option", ["--read-only", "--operate"])
def test_without_the_right_nothing_can_be_edited(head: Path, page: Open, option: str) -> None:
    with manager(head, option) as one:
        shown = page(one)
        has_facts(shown)
        for name in ("Add ▾", "Undo", "Redo"):
            assert shown.get_by_role("button", name=name).count() == 0
        for action in ("Connect…", "Remove…", "Rename…"):
            assert not has_action(shown, "speech", action)
        assert has_action(shown, "speech", "Restart…") == (option == "--operate")
        shown.mouse.move(*middle(shown, "speech"))
        drag(shown, on_screen(shown, HANDLE, "speech"), middle(shown, "lips"))
        assert shown.get_by_role("dialog").count() == 0
        assert refused(one) == 403


def refused(one: Manager) -> int:
    change = {"change": "rename", "entry": "lips", "name": "x"}
    return one.ask("/api/deployments/Head/edit", {"change": change})[0]
