"""Checks the types of the user's code in Python, with ty: against the modules that a compile of the documents, as they
are now, would generate."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit import runtime
from robocomp_yaml.emit.layout import GENERATED, SOURCES
from robocomp_yaml.emit.usage.checked import CheckedCode
from robocomp_yaml.languages.python import LANGUAGE

_TOOL = "ty"
_MISSING = "`--code` needs the type checker ty, which is not installed: run `pip install 'rcyaml[code]'`"
_RUN_TIME, _TYPINGS = "runtime", "typings"
_SECONDS = 300
_PARALLEL = 4
_ERRORS = ("major", "critical", "blocker")
_IGNORED = ("lost-keyword-for-regular-parameter",)  # others call methods of the worker by position


def check(units: Sequence[CheckedCode]) -> list[Diagnostic]:
    """What ty reports about the components. Raises Refused if ty is not installed, or fails. Code for RoboComp's own
    tool, whose modules get their names at run time, is not checked."""
    own = [unit for unit in units if not unit.linked.component.compatibility]
    if not own:
        return []
    program = _program()
    with tempfile.TemporaryDirectory(prefix="rcyaml-") as folder, ThreadPoolExecutor(_PARALLEL) as pool:
        shared = os.path.join(folder, _RUN_TIME)
        _write(os.path.join(shared, GENERATED), ((file.path, file.text) for file in runtime.files(LANGUAGE.name)))
        jobs = []
        for number, unit in enumerate(own):
            place = os.path.join(folder, str(number))
            _write(place, ((one.path, one.text) for one in unit.files if one.path.startswith(f"{GENERATED}/")))
            _complete(os.path.join(place, GENERATED), os.path.join(shared, GENERATED))
            jobs.append(pool.submit(_checked, program, unit, place))
        return [diagnostic for job in jobs for diagnostic in job.result()]


def _program() -> str:
    """The path of ty: the one beside this Python, or on PATH. Raises Refused if there is none."""
    beside = shutil.which(_TOOL, path=os.path.dirname(sys.executable))
    found = beside or shutil.which(_TOOL)
    if found is None:
        raise Refused(_MISSING)
    return found


def _write(folder: str, files: Iterable[tuple[str, str]]) -> None:
    for path, text in files:
        if path.endswith((".py", ".pyi")):
            full = os.path.join(folder, path)
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, "w", encoding="utf-8") as file:
                file.write(text)


def _complete(package: str, run_time: str) -> None:
    """Makes the package one that has the run time in it: checkers do not follow a path that is computed."""
    with open(os.path.join(package, "__init__.py"), "w", encoding="utf-8"):
        pass
    for name in os.listdir(run_time):
        if not os.path.exists(os.path.join(package, name)):
            os.symlink(os.path.join(run_time, name), os.path.join(package, name))


def _checked(program: str, unit: CheckedCode, place: str) -> list[Diagnostic]:
    typings = os.path.join(place, GENERATED, _TYPINGS)
    paths = [word for path in (place, typings) for word in ("--extra-search-path", path)]
    ignored = [word for rule in _IGNORED for word in ("--ignore", rule)]
    command = [
        program, "check", "--output-format", "gitlab", "--exit-zero", "--no-progress", *ignored, *_python(unit), *paths
    ]  # fmt: skip
    try:
        done = subprocess.run(
            [*command, SOURCES], cwd=unit.root.real, capture_output=True, text=True, timeout=_SECONDS, check=False,
            stdin=subprocess.DEVNULL,
        )  # fmt: skip
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Refused(f"the type checker ty cannot run: {error}") from None
    try:
        found = json.loads(done.stdout)
        return list(_diagnostics(found, unit))
    except (ValueError, LookupError, TypeError):
        reason = " ".join((done.stderr or done.stdout).split())[:300]
        raise Refused(f"the type checker ty fails in {unit.root.path}: {reason}") from None


def _python(unit: CheckedCode) -> list[str]:
    """The Python whose modules the code imports: that which would run the component, as far as that is known without
    a search for Ice."""
    named = os.environ.get("RCYAML_PYTHON")
    own = os.path.join(unit.workspace, ".venv", "bin", "python3")
    python = _executable(named or (os.path.abspath(own) if os.path.exists(own) else "python3"))
    return ["--python", python] if python else []


@cache
def _executable(python: str) -> str:
    """The program that a command starts, which may be a script of a manager of versions; '' if it fails."""
    try:
        command = [python, "-c", "import sys; print(sys.executable)"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def _diagnostics(found: Iterable[dict[str, Any]], unit: CheckedCode) -> Iterator[Diagnostic]:
    slices = {scope.module.name for scope in unit.linked.modules()}
    for one in found:
        if one["check_name"] == "import-not-found" and slices & {*re.findall(r"`(\w+)`", one["description"])}:
            continue  # after the generated modules, it exists
        rule, place = one["check_name"], one["location"]
        begin, end = place["positions"]["begin"], place["positions"]["end"]
        text = one["description"].removeprefix(f"{rule}: ").rstrip(".")
        path = os.path.relpath(os.path.join(unit.root.real, place["path"]), unit.root.real)
        span = Span(unit.root.shown(path), begin["line"], begin["column"], end["line"], end["column"])
        code = codes.ERROR_OF_CHECKER if one["severity"] in _ERRORS else codes.WARNING_OF_CHECKER
        yield code.at(span, tool=_TOOL, text=text, rule=rule)
