"""How the worker of a generation of RoboComp is started: the compiler decides, by what the class has."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from conftest import ROOT
from cpp_programs import needs_cpp

PROGRAM = """
#include <robocomp/starting.h>
struct Map {}; struct Tuple {};
struct Generic
{
    void startMachine();
    virtual void initialize();
    virtual void initialize(int);
};
#define IS(worker, how) static_assert(robocomp::startingOf<worker, Map>() == robocomp::Starting::how)
struct Oldest : Generic { Oldest(Map&); };
IS(Oldest, itself);
struct Checked : Generic { Checked(Map&, bool); };
IS(Checked, itself);
struct Period : Generic { Period(Map&); void initialize(int) override; };
IS(Period, period);
struct Steps : Generic { Steps(Tuple, bool); void initialize() override; };
IS(Steps, machine);
struct Hidden : Generic { Hidden(Map&); private: void initialize() noexcept override; };
IS(Hidden, machine);
struct Both : Generic { Both(Tuple, bool); void initialize() override; void initialize(int) override; };
IS(Both, machine);
struct Bare : Generic { Bare(Tuple, bool); };
IS(Bare, machine);
"""


@needs_cpp
@pytest.mark.slow
def test_each_generation_is_started_its_way(tmp_path: Path) -> None:
    (tmp_path / "main.cpp").write_text(PROGRAM)
    folder = ROOT / "robocomp_yaml/languages/cpp/templates"
    words = ["g++", "-std=c++17", "-fsyntax-only", "-fno-access-control", f"-I{folder}", "main.cpp"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
