"""What the build of C++ for RoboComp's own tool reads from the code's headers: the version of Qt, and Eigen. Nothing is
compiled: CMake says how it would be."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import write_tree
from cpp_programs import needs_cpp
from robocomp_yaml.cli import group

WORKER = """\
#include <genericworker.h>
{}
class SpecificWorker : public GenericWorker {{
Q_OBJECT
public:
    SpecificWorker(TuplePrx tprx, bool startup_check) : GenericWorker(tprx) {{}}
public slots:
    void compute() {{}}
}};
"""
CLASSES = {
    "robocomp/classes/viewer/viewer.h": "#include <QWidget>\n#include <QGLWidget>\n",
    "robocomp/classes/view/view.h": '#include "../viewer/viewer.h"\n',
    "robocomp/classes/grid/grid.h": "#include <Eigen/Dense>\n",
    "robocomp/classes/plain/plain.h": "#include <QWidget>\n// #include <QGLWidget>\n",
    "robocomp/classes/plain/plain.cpp": '#include "plain.h"\n',
}

QT5, EIGEN = list(Path("/usr/lib").glob("*/cmake/Qt5/Qt5Config.cmake")), Path("/usr/include/eigen3").exists()
pytestmark = [needs_cpp, pytest.mark.slow]


def commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, headers: str, lists: str, more: str = "") -> str:
    """The commands that compile a worker with these lines; `more` is the generic part that RoboComp's tool left."""
    write_tree(tmp_path, {
        **CLASSES, "bot/bot.cdsl.yaml": "component: Bot\nlanguage: cpp\ncompatibility: robocomp\n",
        "bot/src/specificworker.h": WORKER.format(headers), "bot/src/CMakeListsSpecific.txt": lists,
        "bot/src/specificworker.cpp": '#include "specificworker.h"\n',
        **({"bot/src/genericworker.h": more} if more else {}),
    })  # fmt: skip
    monkeypatch.setenv("ROBOCOMP", str(tmp_path / "robocomp"))
    assert CliRunner().invoke(group, ["compile", str(tmp_path / "bot")]).exit_code == 0
    words = ["cmake", "-S", tmp_path / "bot", "-B", tmp_path / "b", "-G", "Ninja", "-DCMAKE_EXPORT_COMPILE_COMMANDS=1"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads((tmp_path / "b/compile_commands.json").read_text())
    return "".join(one["command"] for one in found if one["file"].startswith(str(tmp_path / "bot/src")))


@pytest.mark.skipif(not QT5, reason="qtbase5-dev is not installed")
@pytest.mark.parametrize(("headers", "lists", "version"), [
    ("", "", 6),
    ("#include <viewer/viewer.h>", "", 5),
    ('#include "view/view.h"', "", 5),
    ("#include <plain/plain.h>", "", 6),
    ("", "SET ( SOURCES\n specificworker.cpp\n $ENV{ROBOCOMP}/classes/viewer/viewer.h )\n", 5),
    ("", "SET ( SOURCES\n specificworker.cpp\n #$ENV{ROBOCOMP}/classes/viewer/viewer.h\n )\n", 6),
    ("", "SET (LIBS ${LIBS} QGLViewer-qt5 )\n", 5),
    ("#include <viewer/viewer.h>", "find_package(Qt6 COMPONENTS Core)\n", 6),
    ("  #  include <QtCore/QRegExp>", "", 5),
])  # fmt: skip
def test_the_version_of_qt(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, headers: str, lists: str, version: int
) -> None:
    made = commands(tmp_path, monkeypatch, headers, lists)
    assert f"/qt{version}/" in made, made
    assert f"/qt{11 - version}/" not in made, made


@pytest.mark.skipif(not EIGEN, reason="libeigen3-dev is not installed")
@pytest.mark.parametrize(("headers", "is_used"), [("", False), ("#include <grid/grid.h>", True),
                                                  ("#include <Eigen/Core>", True)])  # fmt: skip
def test_eigen_is_on_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, headers: str, is_used: bool) -> None:
    assert ("eigen3" in commands(tmp_path, monkeypatch, headers, "")) == is_used


def test_headers_of_qt_4_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The preprocessor finds them."""
    headers = "#include <qt4/QtGui/QFrame>\n#include <qt4/Qt/qdebug.h>\n#include <qt4/QtCore/QMap>\n"
    made = commands(tmp_path, monkeypatch, headers, "")
    folders = [word for each in re.findall(r"-I\S+|-isystem \S+", made) for word in each.split()]
    (tmp_path / "x.cpp").write_text(headers)
    words = ["g++", "-fPIC", "-E", *folders, tmp_path / "x.cpp"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0 and "QFrame :" in done.stdout, done.stderr


@pytest.mark.parametrize(("more", "is_used"), [
    ("", False), ("using namespace std;\nclass GenericWorker {};\n", False),
    ("using namespace std;\nusing namespace RoboCompLaser;\nclass GenericWorker {};\n", True),
])  # fmt: skip
def test_types_without_their_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: str, is_used: bool) -> None:
    """The first generation with TuplePrx had `using namespace`, as the one with MapPrx."""
    assert ("ROBOCOMP_UNQUALIFIED" in commands(tmp_path, monkeypatch, "", "", more)) == is_used
