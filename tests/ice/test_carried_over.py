"""From a legacy component's folder to one that runs, its code untouched; and a window that comes and goes."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

from conftest import write_tree
from processes import Ports, Start
from robocomp_workers import NO_QT

IDSL = "module RoboCompEcho { interface Echo { string say(string text, out int length); }; };\n"
CDSL = """import "Echo.idsl";
Component EchoComp
{
    Communications
    {
        implements Echo;
    };
    language python;
};
"""
WORKER = """
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from genericworker import *
import interfaces as ifaces


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, startup_check=False):
        super(SpecificWorker, self).__init__(proxy_map)
        self.Period = 50
        self.timer.timeout.connect(self.compute)
        self.timer.start(self.Period)

    def setParams(self, params):
        print("greeting", params["Greeting"], flush=True)
        return True

    @QtCore.Slot()
    def compute(self):
        pass

    def Echo_say(self, text):
        return [text + "!", len(text)]
"""
STALE = "raise SystemExit('what RoboComp generated is of no use here')\n"


def test_a_legacy_component(
    rcyaml: Callable[..., Result], tmp_path: Path, start: Start, free_port: Ports, ice: Any
) -> None:
    """migrate, compile, run: not one file of the user's code has changed."""
    port = free_port()
    own = {
        "comp/echo.cdsl": CDSL,
        "comp/src/specificworker.py": WORKER,
        "comp/src/genericworker.py": STALE,
        "comp/src/interfaces.py": STALE,
        "comp/src/echoI.py": STALE,
        "comp/CMakeLists.txt": "# RoboComp's\n",
        "comp/etc/config": f"Echo.Endpoints=tcp -p {port}\nGreeting=hello\n",
        "interfaces/Echo.idsl": IDSL,
    }
    write_tree(tmp_path, own)
    (tmp_path / "hidden" / "PySide6").mkdir(parents=True)
    (tmp_path / "hidden" / "PySide6" / "__init__.py").write_text(NO_QT)
    assert rcyaml("migrate", ".").exit_code == 0
    assert "compatibility: robocomp" in (tmp_path / "comp" / "echo.cdsl.yaml").read_text()
    compiled = rcyaml("compile", "comp")
    assert compiled.exit_code == 0, compiled.output
    running = start(
        [sys.executable, tmp_path / "comp" / "bin" / "EchoComp"], env={"PYTHONPATH": str(tmp_path / "hidden")}
    )
    running.wait_for("EchoComp is running").wait_for("greeting hello")
    assert _echo(ice, tmp_path / "slice", port).say("ho") == ("ho!", 2)
    assert running.stop() == 0
    del own["comp/etc/config"]  # written from the values that it held
    for path, text in own.items():
        assert (tmp_path / path).read_text() == text, path


def _echo(ice: Any, slices: Path, port: int) -> Any:
    import Ice

    Ice.loadSlice("", [str(slices / "Echo.ice")])
    import RoboCompEcho

    return RoboCompEcho.EchoPrx.uncheckedCast(ice.stringToProxy(f"echo:tcp -h 127.0.0.1 -p {port}"))


PLAIN = "component: Lamp\nlanguage: python\n"


def test_a_window_comes_and_goes(rcyaml: Callable[..., Result], tmp_path: Path, start: Start) -> None:
    """The user's file stays as it is, byte by byte, and the component runs each time."""
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    document, worker = tmp_path / "lamp.cdsl.yaml", tmp_path / "src" / "specificworker.py"
    before = ""
    for gui in ("", "gui: {toolkit: qt, base: QDialog}\n", "gui: {toolkit: qt, base: QDialog}\nperiod: 50\n", ""):
        document.write_text(PLAIN + gui)
        compiled = rcyaml("compile")
        assert compiled.exit_code == 0, compiled.output
        before = before or worker.read_text()
        assert worker.read_text() == before
        assert (tmp_path / "generated" / "qt" / "loop.py").exists() == bool(gui)
        running = start([sys.executable, tmp_path / "bin" / "Lamp"], env={"QT_QPA_PLATFORM": "offscreen"})
        assert running.wait_for("Lamp is running").stop() == 0
    assert (tmp_path / "src" / "mainUI.ui").exists(), "it is the user's"
