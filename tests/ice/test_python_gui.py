"""Python components with a window, offscreen: it answers while the worker is busy, and closing it stops the component."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from components import Build, Built
from forms import FORM
from processes import Ports, Start
from scenario import INTERFACES, cdsl

BASES = ["QWidget", "QMainWindow", "QDialog"]
WORKER = """
import threading
import time

from generated.genericworker import GenericWorker
from PySide6.QtCore import QTimer


class SpecificWorker(GenericWorker):
    def initializeGui(self):
        self.main = threading.current_thread()
        self.ticks = 0
        self.ticking = QTimer(self.window)
        self.ticking.timeout.connect(self.tick)
        self.ticking.start(10)
        self.ui.button.clicked.connect(self.clicked)
        print("window", type(self.window).__name__, self.main is threading.main_thread(), self.ui.label.text(), flush=True)

    def initialize(self):
        self.turns = 0
        print("initialize in", threading.current_thread().name, flush=True)

    def tick(self):
        self.ticks += 1

    def clicked(self):
        print("clicked in main", threading.current_thread() is self.main, flush=True)
        self.runInWorker(self.work, 7)

    def work(self, n):
        print("work", n, "in", threading.current_thread().name, flush=True)
        self.runInGui(self.ui.label.setText, f"worked {n}")
        self.runInGui(lambda: print("label says", self.ui.label.text(), flush=True))
        self.runInGui(lambda: 1 / 0)
        self.runInWorker(self.fail)

    def fail(self):
        raise ValueError("in between")

    def compute(self):
        self.turns += 1
        if self.turns == 1:
            self.runInGui(self.ui.button.click)
        elif self.turns == 2:
            before = self.ticks
            time.sleep(0.5)  # the window must answer meanwhile
            print("ticks while it worked:", self.ticks - before, flush=True)
            for n in range(2000):
                self.runInGui(self.ui.label.setText, str(n))
            self.runInGui(lambda: print("at last", self.ui.label.text(), flush=True))

    def Arm_move(self, path, fast):
        self.runInGui(self.window.close)
        return 1
"""


@pytest.fixture
def window(build: Build, free_port: Ports) -> Callable[..., tuple[Built, int]]:
    """`window(base, code)`: a component with a window, and the port of its arm."""
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")

    def made(base: str, code: str = WORKER) -> tuple[Built, int]:
        keys: dict[str, Any] = {"gui": {"toolkit": "qt", "base": base}, "implements": ["Arm"]}
        built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", **keys)})["Any"]
        if code:
            (built.root / "src" / "specificworker.py").write_text(code)
            (built.root / "src" / "mainUI.ui").write_text(FORM.format(base=base))
        port = free_port()
        return built.configure({"Arm.Endpoints": f"tcp -p {port}", "period.compute": 20}), port

    return made


OFFSCREEN = {"QT_QPA_PLATFORM": "offscreen"}


@pytest.mark.parametrize("base", BASES)
def test_each_has_its_thread(window: Callable[..., tuple[Built, int]], start: Start, base: str) -> None:
    component, _ = window(base)
    running = start(component.command, env=OFFSCREEN, cwd=Path("/")).wait_for("at last 1999\n")
    said = running.output
    assert f"window {base} True none\n" in said
    assert "initialize in worker\n" in said
    assert "clicked in main True\n" in said
    assert "work 7 in worker\n" in said
    assert "label says worked 7\n" in said
    assert "ZeroDivisionError" in said and "ValueError: in between" in said, "shown, and all goes on"
    ticks = int(said.split("ticks while it worked: ")[1].split()[0])
    assert ticks > 10, "about 50 in half a second, however busy the worker and this machine are"
    assert running.stop() == 0


@pytest.mark.parametrize("base", BASES)
def test_closing_the_window_stops_the_component(
    window: Callable[..., tuple[Built, int]], start: Start, ice: Any, slices: None, base: str
) -> None:
    import RoboCompArm

    component, port = window(base)
    running = start(component.command, env=OFFSCREEN).wait_for("Any is running")
    RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {port}")).move([], False)
    assert running.exit_code(3) == 0
    assert "the process ends anyway" not in running.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_stop_it(window: Callable[..., tuple[Built, int]], start: Start, number: int) -> None:
    component, _ = window("QWidget")
    running = start(component.command, env=OFFSCREEN).wait_for("Any is running")
    assert running.stop(number) == 0
    assert (
        "the process ends anyway" not in running.output and "Traceback" not in running.output.split("initialize in")[0]
    )


@pytest.mark.parametrize("base", BASES)
def test_the_skeleton_runs(window: Callable[..., tuple[Built, int]], start: Start, base: str) -> None:
    component, _ = window(base, "")
    running = start(component.command, env=OFFSCREEN).wait_for("Any is running")
    assert running.stop() == 0
    assert "Traceback" not in running.output
    assert start([*component.command, "--startup-check"], env=OFFSCREEN).exit_code() == 0


def test_it_waits_for_others_with_its_window_open(build: Build, start: Start, free_port: Ports) -> None:
    """A signal stops the component while a server is still absent."""
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    keys: dict[str, Any] = {"gui": {"toolkit": "qt", "base": "QWidget"}, "requires": ["Arm"]}
    built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", **keys)})["Any"]
    built.configure({"ArmProxy": f"arm:tcp -h 127.0.0.1 -p {free_port()}"})
    running = start(built.command, env=OFFSCREEN).wait_for("waiting for Arm")
    assert running.stop() == 0
    assert "Traceback" not in running.output


@pytest.mark.parametrize(
    ("form", "says"),
    [
        ("<ui", "src/mainUI.ui is not a form"),
        (
            FORM.format(base="QWidget").replace("guiDlg", "Other"),
            "src/mainUI.ui is not a form for the window: its <class> must be guiDlg",
        ),
        (FORM.format(base="QMainWindow").replace("<widget class", "<widget  class"), None),
    ],
    ids=["no-xml", "another-class", "fine"],
)
def test_a_broken_form_is_one_line(
    window: Callable[..., tuple[Built, int]], start: Start, form: str, says: str | None
) -> None:
    component, _ = window("QMainWindow")
    (component.root / "src" / "mainUI.ui").write_text(form)
    running = start(component.command, env=OFFSCREEN, cwd=component.root)
    if says is None:
        running.wait_for("Any is running")
        return
    assert running.exit_code() == 1
    assert says in running.output and "Traceback" not in running.output


def test_without_pyside(build: Build, start: Start, tmp_path: Path) -> None:
    (tmp_path / "hidden" / "PySide6").mkdir(parents=True)
    (tmp_path / "hidden" / "PySide6" / "__init__.py").write_text("raise ModuleNotFoundError('No PySide6')\n")
    keys: dict[str, Any] = {"gui": {"toolkit": "qt", "base": "QWidget"}}
    for more in ({}, {"compatibility": "robocomp"}):
        built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", **keys, **more)})["Any"].configure({})
        refused = start(built.command, env={"PYTHONPATH": str(tmp_path / "hidden")})
        assert refused.exit_code() == 1
        assert refused.output.count("\n") == 1, refused.output
        assert (
            "the window needs PySide6" in refused.output and 'pip install "PySide6-Essentials<6.11"' in refused.output
        )


def test_without_a_screen(window: Callable[..., tuple[Built, int]], start: Start) -> None:
    component, _ = window("QWidget", "")
    refused = start(component.command, env={"DISPLAY": "", "WAYLAND_DISPLAY": "", "QT_QPA_PLATFORM": ""})
    assert refused.exit_code() == 1
    assert "the window has no screen" in refused.output and refused.output.count("\n") == 1


EXITING = """
import sys

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initializeGui(self):
        self.ui.button.clicked.connect(self.leave)
        {begin}

    def leave(self):
        {slot}

    def compute(self):
        {turn}
"""
CLICK = "self.runInGui(self.ui.button.click)"


@pytest.mark.parametrize(("statement", "code"), [("sys.exit(6)", 6), ("sys.exit('no screen')", 1), ("sys.exit()", 0)])
@pytest.mark.parametrize(
    ("begin", "turn", "slot"),
    [
        ("pass", CLICK, "{}"),
        ("pass", "self.runInGui(self.leave)", "{}"),
        ("pass", "self.runInWorker(self.leave)", "{}"),
        ("self.leave()", "pass", "{}"),
    ],
    ids=["slot", "runInGui", "runInWorker", "initializeGui"],
)
def test_it_exits(
    window: Callable[..., tuple[Built, int]], start: Start, statement: str, code: int, begin: str, turn: str, slot: str
) -> None:
    """In order, and with the code and the text of `sys.exit`, wherever that is called."""
    component, _ = window("QWidget", EXITING.format(begin=begin, turn=turn, slot=slot.format(statement)))
    running = start(component.command, env=OFFSCREEN)
    assert running.exit_code() == code
    assert "Traceback" not in running.output and "ends anyway" not in running.output
    assert ("no screen\n" in running.output) == (code == 1)


def test_a_slot_is_interrupted(window: Callable[..., tuple[Built, int]], start: Start) -> None:
    code = EXITING.format(begin="pass", turn=CLICK, slot="raise KeyboardInterrupt")
    component, _ = window("QWidget", code)
    running = start(component.command, env=OFFSCREEN)
    assert running.exit_code() == 0, "as after Ctrl-C"
    assert "Traceback" not in running.output


ROBOCOMP = """
from PySide2.QtCore import QTimer
from PySide2 import QtWidgets
from genericworker import *

class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, startup_check=False):
        super(SpecificWorker, self).__init__(proxy_map)
        self.ui.button.clicked.connect(self.clicked)
        self.timer.timeout.connect(self.compute)
        self.timer.start(20)

    def setParams(self, params):
        return True

    @QtCore.Slot()
    def clicked(self):
        self.ui.label.setText("clicked")

    @QtCore.Slot()
    def compute(self):
        self.ui.button.click()
        print(self.ui.label.text(), isinstance(self, QtWidgets.{base}), flush=True)
        self.close()
"""


@pytest.mark.parametrize("base", BASES)
def test_robocomps_own(build: Build, start: Start, base: str) -> None:
    """The worker is the window."""
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    keys: dict[str, Any] = {"gui": {"toolkit": "qt", "base": base}, "compatibility": "robocomp"}
    built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", **keys)})["Any"].configure({})
    (built.root / "src" / "specificworker.py").write_text(ROBOCOMP.format(base=base))
    (built.root / "src" / "mainUI.ui").write_text(FORM.format(base=base))
    running = start(built.command, env=OFFSCREEN)
    assert running.exit_code() == 0
    assert "clicked True\n" in running.output and "Traceback" not in running.output
