"""Builds Python components: compiles them to bytecode and imports them once, with the Python that will run them."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from robocomp_yaml.building.job import BuildStep, ComponentBuild, Job
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.diag.codes import building as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.languages.python import LANGUAGE

_MARK = "\x1ercyaml "
_OUTDATED = "outdated"
_LAST = 10  # lines that are shown of an error outside of the user's code


def build(job: Job, units: list[Unit]) -> dict[Unit, ComponentBuild]:
    done: dict[Unit, ComponentBuild] = {}
    with ThreadPoolExecutor(job.jobs) as pool:
        try:
            running = {unit: pool.submit(_tried, job, unit) for unit in units}
            for number, (unit, future) in enumerate(running.items()):
                job.report(BuildStep(number, len(units), f"Trying {unit.name}"))
                code, cpu, lines = future.result()
                faults = [json.loads(line.removeprefix(_MARK)) for line in lines if line.startswith(_MARK)]
                found = list(_diagnostics(faults))
                job.add(found)
                if outdated := next((fault["text"] for fault in faults if fault["kind"] == _OUTDATED), ""):
                    command = typed("rcyaml", "compile", unit.document)
                    job.add_failure(unit, outdated.partition(": compile")[0], hint=f"`{command}`")
                elif code and not has_errors(found):
                    output = [line for line in lines if not line.startswith(_MARK)]
                    job.add_failure(unit, "its code cannot be imported", more=output[-_LAST:])
                done[unit] = ComponentBuild(code == 0, cpu)
        except BaseException:
            job.processes.end()
            raise
    return done


def _tried(job: Job, unit: Unit) -> tuple[int, float, list[str]]:
    lines: list[str] = []
    python = shutil.which("python3") or sys.executable
    try:
        ended = job.processes.run(
            [python, os.path.join(LANGUAGE.templates, "trial.py"), os.path.abspath(unit.folder), _MARK],
            lines.append,
            env={"QT_QPA_PLATFORM": "offscreen"},
        )
    except OSError as error:
        return 1, 0.0, [f"{python} cannot be started: {reason_of(error)}"]
    return ended.code, ended.cpu, lines


def _diagnostics(faults: Iterable[dict[str, Any]]) -> Iterator[Diagnostic]:
    for fault in faults:
        if fault["kind"] != _OUTDATED:
            code = codes.ERROR_OF_COMPILER if fault["kind"] == "error" else codes.WARNING_OF_COMPILER
            column = max(1, fault["column"])
            end = max(column + 1, fault["end"])
            path = os.path.relpath(fault["file"])
            file = fault["file"] if path.startswith(os.pardir) else path
            yield code.at(Span(file, fault["line"], column, fault["line"], end), tool="Python", text=fault["text"])
