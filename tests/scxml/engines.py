"""Both interpreters outside of a component: what they make of tables, in a clock that jumps."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from robocomp_yaml import semantics
from robocomp_yaml.emit.machines import lower
from robocomp_yaml.languages import language
from robocomp_yaml.languages.cpp import statemachine as cpp_statemachine
from robocomp_yaml.languages.python.statemachine import tables
from robocomp_yaml.model.statemachine import StateMachine


@dataclass(frozen=True)
class Trace:
    """What a machine did: the states that it entered, and what it logged."""

    entered: list[str]
    logged: list[str]

    @property
    def last(self) -> str:
        return self.entered[-1] if self.entered else ""


HERE = Path(__file__).resolve().parent
PYTHON = Path(language("python").templates) / "machine"
SEMANTICS = Path(semantics.__file__).parent
CPP = Path(language("cpp").templates) / "machine"
_OF_WORKERS = {"reports.cpp", "worker.cpp"}  # they need Ice


def package(folder: Path) -> Path:
    """The package `generated` with the interpreter."""
    generated = folder / "generated"
    shutil.copytree(PYTHON, generated / "machine", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(SEMANTICS, generated / "runtime" / "semantics", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(PYTHON.parent / "runtime" / "stopping.py", generated / "runtime")
    for folder in (generated, generated / "runtime"):
        (folder / "__init__.py").touch()
    return generated


def run_python(machines: Mapping[str, StateMachine], folder: Path) -> dict[str, Trace]:
    generated = package(folder)
    for name, machine in machines.items():
        (generated / f"{name}.py").write_text(tables(machine, name), encoding="utf-8")
    printed = json.loads(python(HERE / "run_cases.py", *machines, folder=folder))
    return {name: Trace(**trace) for name, trace in printed.items()}


def python(script: Path, *arguments: str, folder: Path) -> str:
    """Runs a script that imports `generated`. Returns what it prints."""
    done = subprocess.run(
        [sys.executable, "-W", "error", str(script), *arguments],
        env={**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def run_cpp(machines: Mapping[str, StateMachine], folder: Path) -> dict[str, Trace]:
    """The same, with one program for all."""
    folder.mkdir(exist_ok=True)
    (folder / "cases.h").write_text(
        '#pragma once\n#include "machine/tables.h"\n#include <map>\n'
        "namespace machine { const std::map<std::string, Machine>& cases(); }\n"
    )
    functions = "\n".join(cpp_statemachine.functions(lower.lower(machine), name) for name, machine in machines.items())
    entries = ", ".join(f'{{"{name}", {name}()}}' for name in machines)
    (folder / "cases.cpp").write_text(
        f'#include "cases.h"\nnamespace machine {{\nnamespace {{\n{functions}\n}}\n'
        "const std::map<std::string, Machine>& cases()\n"
        f"{{\nstatic const std::map<std::string, Machine> all = {{{entries}}};\nreturn all;\n}}\n}}\n",
        encoding="utf-8",
    )
    done = subprocess.run([build_cpp(folder)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    rows = (line.split("\t") for line in done.stdout.splitlines())
    return {name: Trace(entered.split(","), logged.split(",")) for name, entered, logged in rows}


def build_cpp(folder: Path) -> Path:
    """The program of this folder's `cases.cpp` with the interpreter; any warning fails."""
    shutil.copytree(CPP, folder / "machine")
    interpreter = [path for path in sorted((folder / "machine").glob("*.cpp")) if path.name not in _OF_WORKERS]
    whole = folder / "whole.cpp"  # one unit, as in components
    whole.write_text("".join(f'#include "{source}"\n' for source in (*interpreter, HERE / "run_cases.cpp")))
    program = folder / "run_cases"
    command = ["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-O0", "-I", folder]
    for words in (
        ["-fno-exceptions", "-c", folder / "cases.cpp", "-o", folder / "cases.o"],  # tables: twice as fast so
        [whole, folder / "cases.o", "-o", program],
    ):
        done = subprocess.run([*command, *words], capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
    return program
