"""What a C++ component says of exceptions that are no std::exception: RoboComp's libraries throw texts of their own."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from conftest import ROOT
from cpp_programs import needs_cpp

PROGRAM = r"""
#include "errors.h"
#include <iostream>
namespace lib { struct Text {}; }
template <class T> void said(const T& thrown)
{
    try { throw thrown; }
    catch (...) { std::cout << runtime::describeCaught() << "\n"; }
}
int main()
{
    said(std::string("no\n camera"));
    said("no arm");
    said(lib::Text());
    said(7);
    said(std::runtime_error("no base"));
}
"""
RUNTIME = ROOT / "robocomp_yaml/languages/cpp/templates/runtime"


@needs_cpp
@pytest.mark.slow
def test_any_exception_is_described(tmp_path: Path) -> None:
    (tmp_path / "main.cpp").write_text(PROGRAM)
    words = ["g++", "-std=c++17", "-O0", "-DICE_CPP11_MAPPING", f"-I{RUNTIME}", "main.cpp", RUNTIME / "errors.cpp"]
    subprocess.run([*words, "-lIce++11", "-o", "main"], cwd=tmp_path, check=True, timeout=300)
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.splitlines() == [
        "no camera",
        "no arm",
        "an exception of type lib::Text",
        "an exception of type int",
        "no base",
    ]
