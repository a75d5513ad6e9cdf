"""Which of the worker's methods a servant calls: the compiler decides, by what the user's class has."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from conftest import ROOT
from cpp_programs import needs_cpp
from in_memory import program
from robocomp_yaml.languages.cpp import qt
from robocomp_yaml.languages.cpp.ports import port_views

IDSL = """\
module: RoboCompArm
interfaces:
  Arm:
    methods:
      stop: {}
      open: {in: {width: float}}
      say: {in: {text: string}}
      read: {returns: int, out: {rest: int}}
"""
CDSL = "component: Bot\nlanguage: cpp\nimports: [Arm]\nimplements: [Arm]\ncompatibility: robocomp\n"
NAMES = ["stop", "open", "say", "read"]
METHODS = {
    "stop": "void {}() {{ puts(\"stop\"); }}", "open": "void {}(const float width) {{ puts(\"open\"); }}",
    "say": "void {}(std::string text) {{ puts(\"say\"); }}", "read": "int {}(int& rest) {{ puts(\"read\"); return rest; }}",
}  # fmt: skip
PROGRAM = """
#include <robocomp/calling.h>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
namespace Ice {{ struct Current; }}
struct GenericWorker
{{
    virtual ~GenericWorker() = default;
protected:
    {generic}
}};
struct SpecificWorker : GenericWorker
{{
private:
    {specific}
}};
int main()
{{
    auto worker_ = std::make_unique<SpecificWorker>();
    float width = 0.5;
    std::string text;
    int rest = 0;
    try
    {{
        {calls}
    }}
    catch (const std::logic_error& problem)
    {{
        fprintf(stderr, "%s\\n", problem.what());
        return 1;
    }}
}}
"""


def compile_and_run(folder: Path, names: list[str], *more: str) -> subprocess.CompletedProcess[str]:
    """Calls all methods of a worker that has these."""
    linked = next(iter(program({"Arm.idsl.yaml": IDSL, "bot.cdsl.yaml": CDSL}).components.values()))
    view = qt.robocomp_view(linked, port_views(linked))
    assert view is not None
    calls = [f"[&] {{ {one.body} }}();" for service in view.services for one in service.operations]
    own = [METHODS[name.rpartition("_")[2]].format(name) for name in names]
    parts = {"generic": view.methods, "specific": [*own, *more], "calls": calls}
    text = PROGRAM.format(**{name: "\n    ".join(lines) for name, lines in parts.items()})
    (folder / "main.cpp").write_text(text)
    include = f"-I{ROOT / 'robocomp_yaml/languages/cpp/templates'}"
    built = subprocess.run(
        ["g++", "-std=c++17", "-fno-access-control", include, "main.cpp", "-o", "main"],
        cwd=folder, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    return built if built.returncode else subprocess.run(
        [folder / "main"], capture_output=True, text=True, timeout=60, check=False
    )  # fmt: skip


@needs_cpp
@pytest.mark.parametrize("prefix", ["", "Arm_"])
def test_methods_with_and_without_the_name_of_the_interface(tmp_path: Path, prefix: str) -> None:
    done = compile_and_run(tmp_path, [f"{prefix}{name}" for name in NAMES])
    assert (done.returncode, done.stdout.split()) == (0, NAMES), done.stderr


@needs_cpp
@pytest.mark.parametrize("missing", NAMES)
def test_a_missing_method(tmp_path: Path, missing: str) -> None:
    """It compiles, as everywhere (RC6201), and a call says what is missing."""
    done = compile_and_run(tmp_path, [f"Arm_{name}" for name in NAMES if name != missing])
    assert done.returncode == 1 and done.stderr == f"Arm_{missing}() is missing\n", done.stderr


@needs_cpp
@pytest.mark.parametrize("wrong", ["void Arm_open(float, bool) {}", "void Arm_open(std::string) {}"])
def test_a_method_that_does_not_match_is_an_error_of_the_compiler(tmp_path: Path, wrong: str) -> None:
    done = compile_and_run(tmp_path, ["Arm_stop", "Arm_say", "Arm_read"], wrong)
    assert done.returncode == 1 and "a method of SpecificWorker does not match its interface" in done.stderr


@needs_cpp
def test_a_method_of_the_old_name_for_another_interface(tmp_path: Path) -> None:
    """Which has other parameters, so that the one that is asked for is missing."""
    done = compile_and_run(tmp_path, ["Arm_stop", "Arm_say", "Arm_read"], "void open(float, float, float) {}")
    assert done.returncode == 1 and done.stderr == "Arm_open() is missing\n", done.stderr
