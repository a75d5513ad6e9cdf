"""Writes the pictures of docs/manager.md: the page of the manager with networks of programs that really run.

python benchmarks/pictures.py [FOLDER]
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from playwright.sync_api import Page, expect, sync_playwright

from page import fleet
from run import working_folder

HERE = Path(__file__).resolve().parent
ROBOT = {  # by group: each program with what it uses
    "base": {
        "joystick": "odometry", "safety": "motors bumper lidar camera", "motors": "", "bumper": "",
        "odometry": "imu motors", "battery": "", "lidar": "", "imu": "",
    },
    "face": {
        "dialogue": "hearing emotions speech", "hearing": "", "emotions": "eyes mouth", "eyes": "", "tracker": "faces",
        "speech": "mouth", "faces": "camera", "mouth": "",
    },
    "manipulation": {"grasping": "gripper kinematics arm camera", "gripper": "", "kinematics": "arm", "arm": ""},
    "": {
        "mission": "dialogue grasping planner agenda", "planner": "localiser motors", "viewer": "grid tracker",
        "localiser": "grid odometry", "grid": "lidar", "camera": "", "recorder": "", "rooms": "mapper", "agenda": "",
        "mapper": "grid",
    },
}  # fmt: skip


def robot(folder: Path) -> Path:
    lines, port = ["deployment: Shelly", "components:"], 21000
    for members in ROBOT.values():
        for name, uses in members.items():
            port += 1
            used = ", ".join(f"{one.capitalize()}: {one}" for one in uses.split())
            lines.append(
                f"  {name}: {{program: sleep, args: ['900'], role: server, ready: {{command: ['true']}}, "
                f"endpoints: {{{name.capitalize()}: tcp -p {port}}}, connect: {{{used}}}}}"
            )
    lines.append("groups:")
    lines += [f"  {name}: {{components: [{', '.join(members)}]}}" for name, members in ROBOT.items() if name]
    folder.mkdir(parents=True)
    (folder / "rcyaml.yaml").write_text("{}\n")
    (folder / "shelly.ddsl.yaml").write_text("\n".join(lines) + "\n")
    return folder


@contextmanager
def opened(folder: Path, *words: str, scheme: str = "light") -> Iterator[Page]:
    command = [sys.executable, "-m", "robocomp_yaml", "manager", "--no-browser", *words]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        address = next(found[0] for line in process.stdout if (found := re.search(r"http://\S+token=\S+", line)))
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1500, "height": 900}, color_scheme=scheme)  # type: ignore[arg-type]
            page.goto(address)
            page.get_by_role("treeitem").first.wait_for()
            page.wait_for_timeout(1500)
            yield page
            browser.close()
    finally:
        process.kill()
        process.wait()


def rcyaml(folder: Path, *words: str) -> None:
    subprocess.run([sys.executable, "-m", "robocomp_yaml", *words], cwd=folder, capture_output=True, check=False)


TALK = """\
deployment: Head
components:
  # The one with the good voice.
  speech:
    program: sleep
    args: ["900"]
    connect: {Mouth: mouth}   # talks
  mouth:
    program: sleep
    args: ["900"]
    endpoints: {Mouth: tcp -p 10002}
  lips:   # a spare one
    program: sleep
    args: ["900"]
    endpoints: {Mouth: tcp -p 10003}
groups:
  face: {components: [mouth, lips]}
"""


def talking(folder: Path, target: Path) -> None:
    """The document beside the picture."""
    folder.mkdir()
    (folder / "rcyaml.yaml").write_text("{}\n")
    (folder / "head.ddsl.yaml").write_text(TALK)
    with opened(folder) as page:
        page.set_viewport_size({"width": 1400, "height": 700})
        page.get_by_role("button", name="YAML").click()
        page.get_by_text("mouth:", exact=True).click()
        page.wait_for_timeout(800)
        page.screenshot(path=target / "manager-text.png")


def thirty(folder: Path, target: Path) -> None:
    """A robot, of which one process fails again and again."""
    rcyaml(robot(folder), "deploy", "up", "--on-failure", "keep")
    try:
        with opened(folder) as page:
            rcyaml(folder, "deploy", "down", "agenda")
            for _ in range(60):  # until it is given up
                if page.evaluate("model.look('faces')") == "down":
                    break
                if pid := page.evaluate("model.states.get('faces').pid"):
                    with suppress(ProcessLookupError):
                        os.kill(pid, signal.SIGKILL)
                page.wait_for_timeout(1500)
            assert page.evaluate("model.look('faces')") == "down"
            page.screenshot(path=target / "manager-30.png")
    finally:
        rcyaml(folder, "deploy", "down")


def main(target: Path) -> None:
    with working_folder() as work:
        os.environ["XDG_STATE_HOME"] = f"{work}/own"
        thirty(Path(work) / "robot", target)
        talking(Path(work) / "talk", target)
        folder, engine = (
            fleet(Path(work) / "fleet", 500).parent,
            ("--engine", "local"),
        )  # all addresses are of this machine
        document = folder / "fleet.ddsl.yaml"
        document.write_text(
            document.read_text()
            .replace("10.0.0.", "127.0.0.")
            .replace("'600']", "'600'], ready: {command: ['true'], within: 120000}")
        )
        rcyaml(folder, "deploy", "up", *engine, "--on-failure", "keep")
        try:
            with opened(folder, *engine) as page:
                expect(page.locator("#summary")).to_have_text("● 500 ready", timeout=60_000)
                page.screenshot(path=target / "manager-500.png")
        finally:
            rcyaml(folder, "deploy", "down", *engine)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent / "docs" / "pictures")
