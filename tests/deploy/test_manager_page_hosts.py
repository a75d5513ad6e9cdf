"""A second host in the page: it is added, shows what it lacks, gets it, and appears. It is a real sshd on loopback."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from ssh_host import NEEDS_SSHD, ssh_host
from test_manager import manager
from test_push import Robot

pytest.importorskip("playwright", reason="pip install playwright")

from playwright.sync_api import Page, expect

from manager_pages import Open, browser, has_facts, item, middle, page, under

__all__ = ["browser", "page"]
pytestmark = [
    pytest.mark.slow,
    NEEDS_SSHD,
    pytest.mark.skipif(shutil.which("rsync") is None, reason="there is no rsync (Debian: rsync)"),
]
NETWORK = """\
deployment: Robot
# All of it runs on the desk.
hosts:
  desk: 127.0.0.2
components:
  grip: {program: ./grip, args: [slowly]}  # the hand
  see: {program: tools/see, cwd: .}
"""


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Robot]:
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/state")
    with ssh_host(tmp_path / "ssh") as host:
        made = Robot(tmp_path / "robot", host)
        (made.root / "robot.ddsl.yaml").write_text(NETWORK)
        yield made


def write(page: Page) -> None:
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Write", exact=True)).to_be_enabled(timeout=60_000)
    dialog.get_by_role("button", name="Write", exact=True).click()
    expect(dialog).to_have_count(0, timeout=60_000)


def test_a_host_is_added_gets_what_it_lacks_and_appears(robot: Robot, page: Open) -> None:
    with manager(robot.root) as one:
        shown = page(one)
        has_facts(shown)
        shown.get_by_role("button", name="Hosts").click()
        panel = shown.get_by_role("region", name="Hosts")
        panel.get_by_role("button", name="Add a host…").click()
        fields = {
            "Name": "arm", "Address": "127.0.0.1", "Folder there": str(robot.there), "Port of ssh": robot.host.port,
            "Private key": robot.host.folder / "key", "Keys of hosts": robot.host.folder / "known_hosts",
        }  # fmt: skip
        for label, value in fields.items():
            shown.get_by_role("dialog").get_by_label(label, exact=True).fill(str(value))
        write(shown)
        lacking = panel.get_by_role("row", name="grip")
        expect(lacking).to_contain_text(f"1 file to push: {robot.there}/grip", timeout=60_000)
        expect(panel.get_by_role("button", name="Push what is missing")).to_have_count(0)  # nothing is to run there

        panel.get_by_role("button", name="Move here…: grip to arm").click()
        expect(shown.get_by_role("dialog").get_by_label("To the host")).to_have_value("arm")
        write(shown)
        panel.get_by_role("button", name="Push what is missing to arm").click(timeout=60_000)
        expect(lacking).to_contain_text("✓", timeout=60_000)
        assert robot.files() == {"grip"}
        assert "nothing to send" in robot.rcyaml("push", "arm")

        expect(item(shown, "arm (127.0.0.1)")).to_be_visible()  # in the tree, and as a box in the picture
        box = shown.evaluate("model.graph.hosts.find((one) => one.name === 'arm').width")
        assert box > 100
        assert shown.evaluate("model.nodes.get('grip').host") == "arm"
        shown.get_by_role("button", name="close hosts").click()
        shown.get_by_role("button", name="Fit").click()
        assert under(shown, *middle(shown, "grip")) == "grip"
        written = (robot.root / "robot.ddsl.yaml").read_text()
        for line in ("# All of it runs on the desk.", "# the hand", "  desk: 127.0.0.2"):
            assert line in written
        history = [event["text"] for event in one.robot("history")[1]["happened"]]
        assert [text for text in history if text.startswith("push")] == ["push arm", "push: done"]
