"""Operating a network of real components in the page of the manager: calls, topics, values, logs, and what happened."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import Ports, kill_left
from test_manager import manager

pytest.importorskip("Ice", reason="Ice's Python module is not installed")
pytest.importorskip("playwright", reason="pip install playwright")

import subprocess
import sys

from playwright.sync_api import Page, expect

from manager_pages import Open, browser, choose, has_facts, item, page

__all__ = ["browser", "page"]

FILES = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Talk.idsl.yaml": """\
module: RoboCompTalk
types:
  Tone: {enum: [calm, glad]}
  Words: {sequence: string}
  Job: {struct: {at: long, tone: {type: Tone, default: glad}, words: Words}}
interfaces:
  Speech:
    methods:
      say: {in: {text: string, tone: Tone}, returns: string}
      plan: {in: {job: Job}, out: {tone: Tone, count: int}, returns: long}
topics:
  Heard: {methods: {word: {in: {text: string}}}}
""",
    "speech/speech.cdsl.yaml": """\
component: SpeechComp
language: python
imports: [Talk]
implements: [Speech]
publishes: [Heard]
parameters: speech.pdsl.yaml
""",
    "speech/speech.pdsl.yaml": """\
parameters:
  volume: {type: float, default: 0.5, range: [0, 1], editable: true, doc: How loud it is.}
  gains: {list: float, size: 2, default: [1, 2], editable: true}
""",
}
RATE = re.compile(r"Heard, (10 Hz|[1-9]\.\d Hz)")  # of a busy machine
CODE = """\
from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def compute(self):
        self.heard_proxy.word("tick")

    def Speech_say(self, text, tone):
        print(f"says {text}", flush=True)
        return f"{text}, {tone}, {self.parameters.volume}"

    def Speech_plan(self, job):
        return job.at, job.tone, len(job.words)
"""


@pytest.fixture(scope="module")
def head(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("head")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_STATE_HOME", f"{folder}/own")
        ports = Ports()
        speech, storm, publish = ports(), ports(), ports()
        document = (
            f"deployment: Head\nservices: {{storm: {{icestorm: {{port: {storm}, publish: {publish}}}}}}}\n"
            f"components:\n  speech: {{component: speech, port: {speech}, ready: {{within: 60000}}}}\n"
            "  log: {program: sh, args: [-c, 'echo here it is; exec sleep 600']}\n"
        )
        write_tree(folder, {**FILES, "head.ddsl.yaml": document})
        subprocess.run(
            [sys.executable, "-m", "robocomp_yaml", "compile", "."], cwd=folder, check=True, capture_output=True
        )
        (folder / "speech/src/specificworker.py").write_text(CODE)
        yield folder
        kill_left(f"{folder}/.rcyaml/deployments/Head")


def test_a_running_component_is_asked_called_and_changed(head: Path, page: Open) -> None:
    with manager(head) as one:
        shown = page(one)
        has_facts(shown)
        one.ask("/api/deployments/Head/down", {})  # this test may be repeated
        status, done = one.ask("/api/deployments/Head/up", {})
        assert (status, done["ok"]) == (200, True), done
        expect(item(shown, "speech, ready")).to_be_visible(timeout=20_000)
        # What publishers count is shown, although nobody listens.
        expect(item(shown, "Heard")).to_have_attribute("aria-label", RATE, timeout=20_000)
        _call(shown)
        _values(shown)
        _topic(shown)
        _logs(shown)
        shown.get_by_role("button", name="History").click()
        history = shown.get_by_role("log", name="what happened")
        for text in ("up: done", "set volume", "call speech.Speech.plan", "ready"):
            expect(history).to_contain_text(text)
        one.ask("/api/deployments/Head/down", {})
        expect(history).to_contain_text("down: done")  # also what somebody else does


def _call(shown: Page) -> None:
    choose(shown, "speech", "Call a method…")
    dialog = shown.get_by_role("dialog")
    dialog.get_by_label("text").fill("<b>Hello</b>")
    tone = dialog.get_by_label("tone")
    assert tone.locator("option").all_text_contents() == ["calm", "glad"]
    tone.select_option("glad")
    dialog.get_by_role("button", name="Call").click()
    answer = dialog.get_by_role("status", name="answer")
    expect(answer).to_contain_text("<b>Hello</b>, glad, 0.5", timeout=20_000)
    assert answer.locator("b").count() == 0
    # Each member of a struct has its field, with its default; long numbers, such as times, are not rounded.
    dialog.get_by_label("Method", exact=True).select_option("Speech.plan")
    expect(dialog.get_by_label("job.tone")).to_have_value("glad")
    expect(dialog).to_contain_text('Words, such as [""]')
    dialog.get_by_label("job.at").fill("1764292800123456789")
    dialog.get_by_label("job.words").fill("[one")
    dialog.get_by_role("button", name="Call").click()
    expect(answer).to_contain_text("job.words: write it as JSON")
    dialog.get_by_label("job.words").fill('["one", "two"]')
    dialog.get_by_role("button", name="Call").click()
    for said in ("1764292800123456789", '"tone": "glad"', '"count": 2'):
        expect(answer).to_contain_text(said, timeout=20_000)
    dialog.get_by_role("button", name="Close").click()


def _values(shown: Page) -> None:
    item(shown, "speech").click()
    details = shown.get_by_role("complementary")
    details.get_by_role("button", name="Read the values").click()
    expect(details).to_contain_text("volume")
    details.get_by_role("button", name="change volume").click()
    dialog = shown.get_by_role("dialog")
    volume = dialog.get_by_label("volume")
    assert (volume.get_attribute("min"), volume.get_attribute("max")) == ("0", "1")
    volume.fill("0.75")
    dialog.get_by_role("button", name="Set it until the process ends").click()
    expect(dialog).to_have_count(0)
    expect(details).to_contain_text("0.75")
    details.get_by_role("button", name="change gains[1]").click()
    dialog.get_by_label("gains[1]").fill("42")
    dialog.get_by_role("button", name="Set it until the process ends").click()
    expect(details).to_contain_text("42")


def _topic(shown: Page) -> None:
    item(shown, "Heard").click()
    messages = shown.get_by_role("log", name="messages of Heard")
    expect(messages).to_contain_text('word {"text":"tick"}', timeout=10_000)
    expect(item(shown, "Heard")).to_have_attribute("aria-label", RATE, timeout=10_000)
    shown.keyboard.press("Escape")


def _logs(shown: Page) -> None:
    shown.get_by_role("button", name="Logs", exact=True).click()
    lines = shown.get_by_role("log", name="logs")
    for text in ("log  here it is", "speech  says"):
        expect(lines).to_contain_text(text)
    shown.get_by_label("Search the lines").fill("here it")
    expect(lines.get_by_text("here it is")).to_be_visible()
    expect(lines.get_by_text("says")).to_be_hidden()
    shown.get_by_text("of all processes").click()
    shown.get_by_label("speech", exact=True).check()
    shown.get_by_label("Search the lines").fill("")
    only = shown.get_by_role("log", name="log of speech")
    expect(only).to_contain_text("says")
    expect(only).not_to_contain_text("here it is")
