"""Builds the components that are not up to date, language by language."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

from robocomp_yaml.building import stamps
from robocomp_yaml.building.compiler_output import CompilerOutput
from robocomp_yaml.building.inputs import Inputs
from robocomp_yaml.building.job import BUILT, CURRENT, FAILED, Builder, BuildResult, BuildStep, ComponentBuild, Job
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.diag.codes import building as codes
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit.layout import GENERATED, SOURCES
from robocomp_yaml.languages.record import TargetLanguage

_LAST = 10  # lines of output that are shown if a failed command printed no diagnostic


def build(job: Job, units: Sequence[Unit]) -> list[BuildResult]:
    """Builds these components. Returns their results, in their order."""
    inputs, done = Inputs(), dict[Unit, BuildResult]()
    stale: list[Unit] = []
    for unit in units:
        if not unit.is_compiled:
            _not_compiled(job, unit)
            done[unit] = _result(unit, FAILED)
        elif not job.defines and _is_current(job, unit, inputs):
            done[unit] = _result(unit, CURRENT)
        else:
            stale.append(unit)
    for result in done.values():
        job.report(result)
    try:
        for language in dict.fromkeys(unit.language for unit in stale):
            group = [unit for unit in stale if unit.language is language]
            for unit, built in _group(job, language, group, inputs).items():
                done[unit] = _result(unit, BUILT if built.is_built else FAILED, built.cpu)
                job.report(done[unit])
    finally:
        job.processes.end()
    return [done[unit] for unit in units]


def clean(units: Sequence[Unit], everything: bool, type_: str | None) -> list[str]:
    """Removes the build trees, never a program. Returns the removed folders. `everything` says that there are no other
    components."""
    gone: list[str] = []
    for language in dict.fromkeys(unit.language for unit in units):
        group = [unit for unit in units if unit.language is language]
        if language.has_building and (clean := getattr(language.part("building"), "clean", None)):
            gone += clean(group, everything, type_)
    for unit in units:
        stamps.forget(unit)
    return gone


def _is_current(job: Job, unit: Unit, inputs: Inputs) -> bool:
    found = stamps.inspect(unit, inputs)
    return found.is_current and found.is_known and found.type == job.type


def _not_compiled(job: Job, unit: Unit) -> None:
    missing = next(name for name in (GENERATED, SOURCES) if not os.path.isdir(unit.path(name)))
    hint = f"`{typed('rcyaml', 'compile', unit.document)}`"
    job.add([codes.NOT_COMPILED.at(Span(unit.document), name=unit.name, folder=unit.path(missing), hint=hint)])


def _group(job: Job, language: TargetLanguage, units: list[Unit], inputs: Inputs) -> Mapping[Unit, ComponentBuild]:
    """Builds the components of a language, and writes the stamps of those that succeed."""
    begun = {unit: stamps.take(unit, inputs, job.type) for unit in units}
    began = time.time_ns()
    builder: Builder = language.part("building").build if language.has_building else _run_commands
    done = builder(job, units)
    for unit, built in done.items():
        if built.is_built and _are_unchanged(built.read, began):
            stamps.keep(unit, stamps.with_more(unit, begun[unit], inputs, built.read))
    return done


def _are_unchanged(files: Iterable[str], began: int) -> bool:
    """Whether all these files are older than the build."""
    try:
        return all(os.stat(path).st_mtime_ns < began for path in files)
    except OSError:
        return False


def _result(unit: Unit, state: str, cpu: float = 0.0) -> BuildResult:
    return BuildResult(unit.name, unit.language.name, unit.folder, unit.program, state, round(cpu, 2))


def _run_commands(job: Job, units: list[Unit]) -> dict[Unit, ComponentBuild]:
    """Builds components by the commands of their language's record, several at once."""
    done: dict[Unit, ComponentBuild] = {}
    with ThreadPoolExecutor(job.jobs) as pool:
        running = {unit: pool.submit(_run, job, unit) for unit in units}
        try:
            for number, (unit, future) in enumerate(running.items()):
                job.report(BuildStep(number, len(units), f"Building {unit.name}"))
                done[unit] = _finish(job, unit, future)
        except BaseException:
            job.processes.end()
            raise
    return done


def _finish(job: Job, unit: Unit, future: Future[tuple[int, float, list[str]]]) -> ComponentBuild:
    try:
        code, cpu, lines = future.result()
    except OSError as error:
        job.add_failure(unit, reason_of(error))
        return ComponentBuild(False)
    found = list(CompilerOutput(unit.folder, f"the {unit.language.title} compiler").diagnostics(lines))
    job.add(found)
    if code == 0 and os.path.exists(unit.program):
        return ComponentBuild(True, cpu)
    if not has_errors(found):
        reason = f"its build failed with exit code {code}" if code else f"its build left no {unit.program}"
        job.add_failure(unit, reason, more=lines[-_LAST:])
    return ComponentBuild(False, cpu)


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
