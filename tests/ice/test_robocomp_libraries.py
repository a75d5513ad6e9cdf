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

LIBRARY = {
    "robocomp/libs/CMakeLists.txt": "project(libs LANGUAGES CXX)\nadd_library(innermodel SHARED model.cpp)\n",
    "robocomp/libs/model.cpp": "int model() { return 1; }\n",
    "robocomp/libs/innermodel/include/innermodel/innermodel.h": "struct InnerModel {};\n",
}
OSG = Path("/usr/include/osg/Node").exists() and Path("/usr/include/gsl/gsl_math.h").exists()
QT5, EIGEN = list(Path("/usr/lib").glob("*/cmake/Qt5/Qt5Config.cmake")), Path("/usr/include/eigen3").exists()
OPENGL = list(Path("/usr/lib").glob("*/cmake/Qt5OpenGL/Qt5OpenGLConfig.cmake"))
pytestmark = [needs_cpp, pytest.mark.slow]


def commands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, headers: str, lists: str, uses: str = "", **more: str
) -> str:
    """The commands that compile a worker with these lines; `more` are further files in its folder `src`, by the names
    of their headers."""
    write_tree(tmp_path, {
        **CLASSES, "bot/bot.cdsl.yaml": "component: Bot\nlanguage: cpp\ncompatibility: robocomp\n" + uses,
        "bot/src/specificworker.h": WORKER.format(headers), "bot/src/CMakeListsSpecific.txt": lists,
        "bot/src/specificworker.cpp": '#include "specificworker.h"\n',
        **{f"bot/src/{name}.h": text for name, text in more.items()},
    })  # fmt: skip
    monkeypatch.setenv("ROBOCOMP", str(tmp_path / "robocomp"))
    assert CliRunner().invoke(group, ["compile", str(tmp_path / "bot")]).exit_code == 0
    words = ["cmake", "-S", tmp_path / "bot", "-B", tmp_path / "b", "-G", "Ninja", "-DCMAKE_EXPORT_COMPILE_COMMANDS=1"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    if done.returncode:
        return " ".join(done.stderr.split())
    found = json.loads((tmp_path / "b/compile_commands.json").read_text())
    own = (str(tmp_path / "bot/src"), str(tmp_path / "robocomp"))
    return "".join(one["command"] for one in found if one["file"].startswith(own))


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


@pytest.mark.skipif(not OPENGL, reason="libqt5opengl5-dev is not installed")
@pytest.mark.parametrize(("headers", "is_used"), [("#include <osgviewer/view.h>", True), ("#include <QWidget>", False)])
def test_modules_of_qt_that_headers_of_robocomp_need(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, headers: str, is_used: bool
) -> None:
    write_tree(tmp_path, {"robocomp/libs/osgviewer/include/osgviewer/view.h": "#include <QGLWidget>\n"})
    made = commands(tmp_path, monkeypatch, headers, "find_package(Qt5 COMPONENTS Core)\n")
    assert ("/QtOpenGL" in made) == is_used, made


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
    assert ("ROBOCOMP_UNQUALIFIED" in commands(tmp_path, monkeypatch, "", "", genericworker=more)) == is_used


@pytest.mark.skipif(not (QT5 and OSG), reason="qtbase5-dev, libopenscenegraph-dev or libgsl-dev is not installed")
@pytest.mark.parametrize(("member", "is_used"), [("InnerModel *model;", True), ("// InnerModel *model;", False)])
def test_robocomp_libraries_that_are_not_installed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, member: str, is_used: bool
) -> None:
    """They are compiled from RoboComp's sources, for code that uses them."""
    write_tree(tmp_path, LIBRARY)
    commands(tmp_path, monkeypatch, f"#include <innermodel/innermodel.h>\n{member}", "")
    assert ("robocomp_libs/libinnermodel.so" in (tmp_path / "b/build.ninja").read_text()) == is_used


ELSEWHERE = """\
#include </home/nobody/robocomp/classes/lake/lake.h>
#  include "/home/nobody/work/shop/etc/names.h"
#include "/nowhere/at/all.h"
"""


def test_sources_of_another_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """RoboComp, and the repository, were in another folder there."""
    write_tree(tmp_path, {"rcyaml.yaml": "", "shop/shared/more.cpp": "int more;\n"})
    listed = "/home/nobody/robocomp/classes/plain/plain.cpp /home/nobody/work/shop/shared/more.cpp"
    made = commands(tmp_path, monkeypatch, "", f"SET(SOURCES specificworker.cpp {listed})\n")
    assert f"-c {tmp_path}/robocomp/classes/plain/plain.cpp" in made
    found = json.loads((tmp_path / "b/compile_commands.json").read_text())
    assert str(tmp_path / "shop/shared/more.cpp") in [one["file"] for one in found]


def test_headers_of_another_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiler reads those that are here, and what they include, and misses those that are nowhere."""
    write_tree(tmp_path, {
        "rcyaml.yaml": "", "robocomp/classes/lake/deep.h": "int deep;\n",
        "robocomp/classes/lake/lake.h": '#pragma once\n#include "deep.h"\n', "shop/etc/names.h": "int name;\n",
    })  # fmt: skip
    commands(tmp_path, monkeypatch, ELSEWHERE, "")
    found = json.loads((tmp_path / "b/compile_commands.json").read_text())
    (one,) = [one for one in found if one["file"].endswith("src/specificworker.cpp")]
    written = (tmp_path / "bot/src/specificworker.h").read_text()
    (tmp_path / "x.cpp").write_text(written.replace("#include <genericworker.h>", ""))
    words = [word for word in one["command"].split() if word != "-include" and not word.endswith("/rcyaml.h")]
    words = [*words[: words.index("-o")], "-E", str(tmp_path / "x.cpp")]
    done = subprocess.run(words, cwd=one["directory"], capture_output=True, text=True, timeout=120, check=False)
    assert "int deep;" in done.stdout and "int name;" in done.stdout
    assert "/nowhere/at/all.h" in done.stderr and "/home/nobody" not in done.stderr


def test_files_that_slice2cpp_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They declare everything a second time."""
    left = "// Generated from file `CommonBehavior.ice'\n#ifndef __CommonBehavior_h__\n#define __CommonBehavior_h__\n#endif\n"
    write_tree(tmp_path, {"bot/src/CommonBehavior.cpp": "#error second time\n"})
    made = commands(tmp_path, monkeypatch, "#include <CommonBehavior.h>", "", CommonBehavior=left)
    assert "-D__CommonBehavior_h__" in made and "CommonBehavior.cpp" not in made
    mine = commands(tmp_path, monkeypatch, "#include <CommonBehavior.h>", "", CommonBehavior="// mine\n")
    assert "-D__" not in mine and "CommonBehavior.cpp" in mine


def test_a_library_that_describes_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """RoboComp's module for it is of another time."""
    write_tree(tmp_path, {
        "robocomp/cmake/modules/FindCloud.cmake": "message(FATAL_ERROR old)\n",
        "cloud/CloudConfig.cmake": "add_definitions(-DCLOUD)\nset(Cloud_FOUND TRUE)\n",
        "cloud/CloudConfigVersion.cmake": "set(PACKAGE_VERSION 1.13)\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n",
    })  # fmt: skip
    monkeypatch.setenv("Cloud_DIR", str(tmp_path / "cloud"))
    assert "-DCLOUD" in commands(tmp_path, monkeypatch, "", "find_package(Cloud 1.7 REQUIRED)\n# ENV{ROBOCOMP}\n")


def test_what_a_library_looks_for_in_turn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another version than the listed one is for the listed library only, and what that one finds is its own affair:
    there, a module comes before a description that cannot be read twice."""
    write_tree(tmp_path, {
        "cloud/CloudConfig.cmake": (
            "list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})\nfind_package(Fog 3 QUIET)\nfind_package(Fog)\n"
            "add_definitions(-DCLOUD ${FOG})\nset(Cloud_FOUND ${Fog_FOUND})\n"
        ),
        "cloud/CloudConfigVersion.cmake": "set(PACKAGE_VERSION 2.0)\n",
        "cloud/FindFog.cmake": "set(FOG -DMODULE)\nset(Fog_FOUND TRUE)\n",
        "fog/FogConfig.cmake": "add_library(fog ALIAS water)\nset(Fog_FOUND TRUE)\n",
    })  # fmt: skip
    for name in ("Cloud", "Fog"):
        monkeypatch.setenv(f"{name}_DIR", str(tmp_path / name.lower()))
    made = commands(tmp_path, monkeypatch, "", "find_package(Cloud 1.7 REQUIRED)\nfind_package(Cloud 1.6 EXACT)\n")
    assert {"-DCLOUD", "-DMODULE"} <= set(made.split()), made


def test_folders_and_sources_of_the_lists(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are relative to the folder of the lists, and a source needs no suffix."""
    inner = {"inner/deep/step.h": "#pragma once\n", "inner/step.cpp": '#include "deep/step.h"\n'}
    write_tree(tmp_path, {f"bot/src/{name}": text for name, text in inner.items()})
    lists = "INCLUDE_DIRECTORIES(inner inner/deep /usr/share)\nSET(SOURCES specificworker.cpp inner/step)\n"
    made = commands(tmp_path, monkeypatch, "", lists)
    assert f"-I{tmp_path}/bot/src/inner -I{tmp_path}/bot/src/inner/deep -I/usr/share" in made
    assert f"-c {tmp_path}/bot/src/inner/step.cpp" in made


def test_what_the_lists_call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """RoboComp's macros were there before the lists. Folders and files that they look for are relative to their own."""
    inner = {
        "kit/CMakeLists.txt": "add_library(kit STATIC kit.cpp)\nadd_subdirectory(deep)\n", "kit/kit.cpp": "int kit;\n",
        "kit/deep/CMakeLists.txt": "target_sources(kit PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/more.cpp)\n",
        "kit/deep/more.cpp": "int more;\n", "parts/part.cpp": "int part;\n", "parts/part.txt": "",
        "icons.qrc": '<RCC><qresource prefix="/"><file>specificworker.h</file></qresource></RCC>\n',
    }  # fmt: skip
    write_tree(tmp_path, {f"bot/src/{name}": text for name, text in inner.items()})
    lists = (
        "QT_WRAP_UI( UI_HEADERS otherUI.ui )\nROBOCOMP_WRAP_ICE( CommonBehavior Arm )\n"
        "FILE( GLOB PARTS parts/*.cpp ${CMAKE_CURRENT_LIST_DIR}/kit/deep/*.txt)\n"
        "ADD_SUBDIRECTORY( kit )\nSET(SOURCES specificworker.cpp ${PARTS})\nSET(LIBS ${LIBS} kit)\n"
        "QT6_ADD_RESOURCES( RC_SOURCES icons.qrc )\n"
    )
    made = commands(tmp_path, monkeypatch, "", lists)
    assert "CMake Error" not in made, made
    found = json.loads((tmp_path / "b/compile_commands.json").read_text())
    files = {one["file"].removeprefix(f"{tmp_path}/bot/src/") for one in found}
    assert {"kit/kit.cpp", "kit/deep/more.cpp", "parts/part.cpp", "specificworker.cpp"} <= files, files
    rules = (tmp_path / "b/build.ninja").read_text()
    assert "libkit.a" in rules and re.search(r"build qrc_icons.cpp.*: CUSTOM_COMMAND .*src/icons.qrc", rules)


@pytest.mark.parametrize("name", ["SOURCES", "HEADERS", "SPECIFIC_HEADERS"])
def test_listed_headers_are_for_moc(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    write_tree(tmp_path, {"robocomp/classes/led/led.h": "#pragma once\n"})
    commands(
        tmp_path, monkeypatch, "", f"SET({name} specificworker.h genericworker.h $ENV{{ROBOCOMP}}/classes/led/led.h)"
    )
    (told,) = (tmp_path / "b/CMakeFiles").glob("*Bot_autogen.dir/AutogenInfo.json")
    headers = [one[0] for one in json.loads(told.read_text())["HEADERS"]]
    assert f"{tmp_path}/robocomp/classes/led/led.h" in headers
    assert not [one for one in headers if one.endswith("src/genericworker.h")]


@pytest.mark.parametrize(("more", "standard"), [
    ({}, 17), ({"lists": "# set(CMAKE_CXX_STANDARD 20)"}, 17), ({"lists": "add_definitions(-std=c++0x -std=gnu++2a)"}, 20),
    ({"src/CMakeLists.txt": "ADD_EXECUTABLE(Bot ${SOURCES})\nSET_TARGET_PROPERTIES(Bot\n PROPERTIES\n CXX_STANDARD 20\n )"}, 20),
    ({"CMakeLists.txt": "set(CMAKE_CXX_STANDARD 20)\ninclude(generated/component.cmake)\n"}, 20),
    ({"lists": "if(0)\nset(CMAKE_CXX_STANDARD 20)\nelse()\nset(CMAKE_CXX_STANDARD 89)\nendif()"}, 20),
    ({"headers": "class ConfigLoader;"}, 23),
])  # fmt: skip
def test_the_standard_of_robocomp(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: dict[str, str], standard: int
) -> None:
    """The highest that the compiler has, of those that RoboComp's own build names, too."""
    head = "cmake_minimum_required(VERSION 3.20)\nproject(Bot LANGUAGES CXX)\n"
    files = {f"bot/{name}": text for name, text in more.items() if "/" in name}
    if "CMakeLists.txt" in more:
        files["bot/CMakeLists.txt"] = head + more["CMakeLists.txt"]
    write_tree(tmp_path, files)
    made = commands(tmp_path, monkeypatch, more.get("headers", ""), more.get("lists", ""))
    (own,) = [line for line in made.split("/usr/bin/c++") if line.rstrip().endswith("specificworker.cpp")]
    assert re.findall(r"-std=c\+\+(\w+)", own)[-1] in (str(standard), {20: "2a", 23: "2b"}.get(standard)), own


@pytest.mark.parametrize("name", ["SOURCES", "SPECIFIC_SOURCES"])
def test_sources_in_c(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    write_tree(tmp_path, {"bot/src/old.c": "int old(void) { return 1; }\n", "bot/src/older.cpp": "#error older\n"})
    made = commands(tmp_path, monkeypatch, "", f"SET({name} specificworker.cpp old.c)\n")
    assert "bot/src/old.c" in made and "older.cpp" not in made


def test_classes_and_modules_of_robocomp_that_a_document_lists(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`RoboCompClasses` and `RoboCompModules` named what is in RoboComp's own folder."""
    write_tree(tmp_path, {"robocomp/cmake/modules/cloud.cmake": "add_definitions(-DCLOUD)\n"})
    uses = "uses:\n  sources: [classes/plain/plain.h, classes/plain/plain.cpp]\n  libraries: [{link: cloud}]\n"
    made = commands(tmp_path, monkeypatch, "", "", uses)
    assert "-DCLOUD" in made and str(tmp_path / "robocomp/classes/plain/plain.cpp") in made
    generic = (tmp_path / "bot/generated/genericworker.h").read_text()
    assert "#include <plain.h>\n" in generic and "plain.cpp" not in generic
    assert "the library fog: the linker has no libfog" in commands(
        tmp_path, monkeypatch, "", "", uses.replace("cloud", "fog")
    )
