"""The parameters of setParams() that the user's monitor reads: by its names, and with its defaults."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from conftest import ROOT
from cpp_programs import needs_cpp, needs_qt
from cpp_qt_sources import MONITOR, MONITOR_H
from robocomp_yaml import resources

MAIN = """
#define GENERICWORKER_H
#include <CommonBehavior.ice.h>
#include <QtCore>
#include <Ice/Ice.h>
#include <iostream>
#define rInfo(text)
#define rError(text)
class GenericWorker
{
public:
    bool setParams(RoboCompCommonBehavior::ParameterList) { return true; }
};
#include "specificmonitor.cpp"
int main(int argc, char* argv[])
{
    Ice::CommunicatorHolder communicator(argc, argv);
    RoboCompCommonBehavior::ParameterList params;
    GenericWorker worker;
    try
    {
        SpecificMonitor(&worker, communicator.communicator()).readConfig(params);
        for (const auto& [name, parameter] : params)
            std::cout << name << "=" << parameter.value << std::endl;
    }
    catch (const std::exception& problem)
    {
        std::cout << problem.what() << std::endl;
    }
}
"""


@needs_cpp
@needs_qt
@pytest.mark.slow
def test_parameters_of_a_monitor(tmp_path: Path) -> None:
    """With prefixes and without, set, by default, missing, and not in a list. The base is not RoboComp's own, if that is
    there, and does not need it."""
    (tmp_path / "CommonBehavior.ice").write_text(resources.text("templates/slice/CommonBehavior.ice"))
    (tmp_path / "specificmonitor.h").write_text(MONITOR_H.replace("Q_OBJECT", ""))
    (tmp_path / "specificmonitor.cpp").write_text(MONITOR)
    (tmp_path / "genericmonitor.h").write_text("#include <robocomp/genericmonitor.h>\n")
    (tmp_path / "main.cpp").write_text(MAIN)
    (tmp_path / "CMakeLists.txt").write_text(f"""
        cmake_minimum_required(VERSION 3.18)
        project(monitor CXX)
        find_package(QT NAMES Qt5 Qt6 REQUIRED COMPONENTS Core)
        find_package(Qt${{QT_VERSION_MAJOR}} REQUIRED COMPONENTS Core)
        add_executable(monitor main.cpp CommonBehavior.ice.cpp)
        target_compile_features(monitor PRIVATE cxx_std_17)
        target_compile_definitions(monitor PRIVATE ICE_CPP11_MAPPING)
        target_include_directories(monitor PRIVATE . "{ROOT / "robocomp_yaml/languages/cpp/templates"}")
        target_link_libraries(monitor PRIVATE Qt${{QT_VERSION_MAJOR}}::Core Ice++11 pthread)
    """)
    for words in (
        ["slice2cpp", "--header-ext", "ice.h", "--source-ext", "ice.cpp", "CommonBehavior.ice"],
        ["cmake", "-S", ".", "-B", "build"], ["cmake", "--build", "build"],
    ):  # fmt: skip
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
        assert done.returncode == 0, done.stdout + done.stderr

    def said(config: str) -> list[str]:
        (tmp_path / "config").write_text(config)
        command = [tmp_path / "build/monitor", f"--Ice.Config={tmp_path / 'config'}"]
        output = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False).stdout
        return output.removeprefix("Destroying SpecificMonitor\n").splitlines()

    assert said("Limits.Force=9\n") == ["Colour=blue", "Force=9", "Owner=nobody"]
    assert said('Limits.Force="9"\nColour=red\nOwner=Ann\n') == ["Colour=red", "Force=9"]
    assert said("") == ["the config has no Limits.Force, which src/specificmonitor.cpp reads"]
    assert said("Limits.Force=9\nColour=green\n") == [
        "Colour cannot be 'green': src/specificmonitor.cpp lists what it can be"
    ]
