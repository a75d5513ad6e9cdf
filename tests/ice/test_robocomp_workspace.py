"""Specific code for RoboComp's own tool in a workspace, whose components share the run time: each has its own folder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import write_tree
from cpp_programs import needs_cpp
from robocomp_yaml.cli import group

HEAD = "component: {}\nlanguage: python\ncompatibility: robocomp\n"
IDSL = "module: RoboCompArm\ntypes: {Path: {sequence: int}}\ninterfaces: {Arm: {methods: {go: }}}\n"
INIT = "    def __init__(self, proxy_map, startup_check=False):\n        super().__init__(proxy_map)\n"


def run(
    tmp_path: Path, code: str, more: str = "", files: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Compiles a workspace with two components, and makes the startup check of the first one."""
    write_tree(tmp_path, {
        "rcyaml.yaml": "interfaces: [interfaces]\n", "interfaces/Arm.idsl.yaml": IDSL,
        "robot/arm/arm.cdsl.yaml": HEAD.format("Arm") + more, "robot/leg/leg.cdsl.yaml": HEAD.format("Leg"),
        "robot/arm/src/specificworker.py": code, **(files or {}),
    })  # fmt: skip
    done = CliRunner().invoke(group, ["compile", str(tmp_path)])
    assert done.exit_code == 0, done.output
    return subprocess.run(
        [sys.executable, tmp_path / "robot/arm/bin/Arm", "--startup-check"], capture_output=True, text=True, timeout=60,
        cwd=tmp_path, env={"QT_QPA_PLATFORM": "offscreen", "PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}, check=False,
    )  # fmt: skip


def test_code_opens_files_of_its_component(tmp_path: Path) -> None:
    code = f"from genericworker import *\nclass SpecificWorker(GenericWorker):\n{INIT}        print(open('src/names.txt').read())\n"
    done = run(tmp_path, code, files={"robot/arm/src/names.txt": "left right"})
    assert done.returncode == 0 and "left right" in done.stdout, done.stderr


def test_sequences_are_names_of_interfaces(tmp_path: Path) -> None:
    code = (
        "from genericworker import *\nfrom interfaces import Path, RoboCompArm\nimport interfaces as ifaces\n"
        f"class SpecificWorker(GenericWorker):\n{INIT}"
        "        assert Path is RoboCompArm.Path is ifaces.RoboCompArm.Path\n        print('path', Path([1, 2]))\n"
    )
    done = run(tmp_path, code, "imports: [Arm]\nrequires: [{Arm: {interface: Arm, absent: ignore}}]\n")
    assert done.returncode == 0 and "path [1, 2]" in done.stdout, done.stderr


@pytest.mark.parametrize("version", ["PySide2", "PySide6"])
def test_a_window_has_its_own_form_and_the_names_of_qt(tmp_path: Path, version: str) -> None:
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    code = (
        f"from {version}.QtCore import QTimer\nfrom {version}.QtWidgets import QApplication\nfrom genericworker import *\n"
        f"class SpecificWorker(GenericWorker):\n{INIT}"
        "        print('form', self.windowTitle(), type(QLabel('x')).__name__, QPoint(1, 2).x())\n"
    )
    done = run(tmp_path, code, "gui: {toolkit: qt, base: QWidget}\n")
    assert done.returncode == 0 and "form Arm QLabel 1" in done.stdout, done.stderr
    assert done.stderr.count("PySide6 is used") == (version == "PySide2")


def test_the_oldest_names_of_qt(tmp_path: Path) -> None:
    """PySide had the widgets in QtGui."""
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    code = (
        "from PySide import QtGui, QtCore\nfrom PySide.QtGui import QColor, QLabel\nfrom genericworker import *\n"
        f"class SpecificWorker(GenericWorker):\n{INIT}        print('old', QtGui.QPushButton is not None, QtCore.QTimer is not None)\n"
    )
    done = run(tmp_path, code)
    assert done.returncode == 0 and "old True True" in done.stdout, done.stderr


def test_a_missing_part_of_qt_is_named(tmp_path: Path) -> None:
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    code = "from genericworker import *\nfrom PySide2.QtCharts import QtCharts\nclass SpecificWorker(GenericWorker): pass\n"
    done = run(tmp_path, code)
    assert (
        done.returncode == 1 and 'pip install "PySide6-Addons<6.11"' in done.stderr and "Traceback" not in done.stderr
    )


@pytest.mark.parametrize(("line", "told"), [
    ("import no_such_library", "src/specificworker.py, line 2, imports no_such_library, which "),
    ("from pydsr import *", "imports pydsr (the DSR library of RoboComp's agents, https://github.com/robocomp/cortex), which "),
    ("import more", "src/more.py, line 1, imports no_such_library, which "),
])  # fmt: skip
def test_a_missing_library_is_named(tmp_path: Path, line: str, told: str) -> None:
    code = f"from genericworker import *\n{line}\nclass SpecificWorker(GenericWorker): pass\n"
    done = run(tmp_path, code, files={"robot/arm/src/more.py": "import no_such_library\n"})
    assert done.returncode == 1 and told in done.stderr and "does not have" in done.stderr, done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("line", ["print 'hello'", "try:\n    pass\nexcept (ValueError), error:\n    pass"])
def test_python_2_is_named(tmp_path: Path, line: str) -> None:
    code = f"from genericworker import *\n{line}\nclass SpecificWorker(GenericWorker):\n{INIT}        pass\n"
    done = run(tmp_path, code)
    assert done.returncode == 1 and "is Python 2 code" in done.stderr and "2to3 -w src" in done.stderr
    assert "Traceback" not in done.stderr
    if line.startswith("print"):
        checked = CliRunner().invoke(group, ["check", str(tmp_path)])
        assert "RC6207" in checked.output and "specificworker.py:2:1" in checked.output


def test_python_2_is_all_that_is_said(tmp_path: Path) -> None:
    """In code of Python 2, tabs and blanks mean blocks that no grammar of today sees: it seems to have no methods."""
    body = "  \tseen = []\n\tdef Arm_go(self):\n                print 1\n"
    code = f"from genericworker import *\nclass SpecificWorker(GenericWorker):\n{body}"
    run(tmp_path, code, "imports: [Arm]\nimplements: [Arm]\n")
    said = CliRunner().invoke(group, ["check", str(tmp_path)]).output
    assert "RC6207" in said and "RC6201" not in said and "RC6202" not in said, said


def test_a_constructor_that_does_not_call_the_base(tmp_path: Path) -> None:
    code = (
        "from genericworker import *\nclass SpecificWorker(GenericWorker):\n"
        "    def __init__(self, proxy_map, params, startup_check=False):\n        print('own', sorted(params)[:0], startup_check)\n"
    )
    done = run(tmp_path, code)
    assert done.returncode == 0 and "own [] True" in done.stdout, done.stderr


AGENT = """\
#include <genericworker.h>
// AGMModel is a class of AGM
{}
class SpecificWorker : public GenericWorker {{
Q_OBJECT
public:
    SpecificWorker(TuplePrx tprx, bool startup_check) : GenericWorker(tprx) {{}}
public slots:
    void compute() {{}}
}};
"""


@needs_cpp
@pytest.mark.slow
@pytest.mark.parametrize(("line", "library"), [
    ("#include <dsr/api/dsr_api.h>", "the DSR library of RoboComp's agents (https://github.com/robocomp/cortex)"),
    ('#include "agm.h"', "AGM (https://github.com/ljmanso/AGM)"),
    ("void changed(const AGMModel::SPtr &model);", "AGM (https://github.com/ljmanso/AGM)"),
])  # fmt: skip
def test_a_missing_library_of_agents_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: str, library: str
) -> None:
    write_tree(tmp_path, {
        "agent.cdsl.yaml": "component: Agent\nlanguage: cpp\ncompatibility: robocomp\noptions: [dsr]\n",
        "src/specificworker.h": AGENT.format(line), "src/specificworker.cpp": '#include "specificworker.h"\n',
    })  # fmt: skip
    monkeypatch.chdir(tmp_path)
    runner = CliRunner()
    assert runner.invoke(group, ["compile"]).exit_code == 0
    built = runner.invoke(group, ["build"])
    assert built.exit_code == 1 and built.output.count("error[") == 1
    assert f"Agent needs {library}, which is not installed: src/specificworker.h has {line}" in built.output
