"""Components built by the commands that their languages' records name, some at a time."""

from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor

from robocomp_yaml.building.job import Job, Made, Step
from robocomp_yaml.building.said import Said
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors

_LAST = 10  # lines that are shown of what failed without a word that is understood


def build(job: Job, units: list[Unit]) -> dict[Unit, Made]:
    done: dict[Unit, Made] = {}
    with ThreadPoolExecutor(job.jobs) as pool:
        running = {unit: pool.submit(_run, job, unit) for unit in units}
        try:
            for number, (unit, future) in enumerate(running.items()):
                job.report(Step(number, len(units), f"Building {unit.name}"))
                done[unit] = _told(job, unit, future)
        except BaseException:
            job.processes.end()
            raise
    return done


def _told(job: Job, unit: Unit, future: Future[tuple[int, float, list[str]]]) -> Made:
    try:
        code, cpu, lines = future.result()
    except OSError as error:
        job.failed(unit, (error.strerror or str(error)).lower())
        return Made(False)
    found: list[Diagnostic] = list(Said(unit.folder, f"the {unit.language.title} compiler").diagnostics(lines))
    job.tell(found)
    if code == 0 and os.path.exists(unit.program):
        return Made(True, cpu)
    if not has_errors(found):
        reason = f"its build ended with exit code {code}" if code else f"its build left no {unit.program}"
        job.failed(unit, reason, more=lines[-_LAST:])
    return Made(False, cpu)


def _run(job: Job, unit: Unit) -> tuple[int, float, list[str]]:
    lines: list[str] = []
    cpu = 0.0
    for words in unit.language.build:
        command = [word.format(folder=os.path.abspath(unit.folder)) for word in words]
        ended = job.processes.run(command, lines.append)
        cpu += ended.cpu
        if ended.code:
            return ended.code, cpu, lines
    return 0, cpu, lines
