"""The stamp of a build: what a program was built from, so that a stale program is detected.

It is in `.rcyaml/builds/` of the component, which is not under version control. If the program is the one of the stamp,
or a copy of it, contents are compared, so that touching a file has no effect. Any other program, such as one that CMake
built directly, is up to date if it is younger than all its inputs.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml.building.inputs import Inputs, State, state
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.regular import regular
from robocomp_yaml.transactions import whole_file

FOLDER = ".rcyaml/builds"
_NAME = f"{FOLDER}/stamp.json"


class BuildStamp(msgspec.Struct, frozen=True):
    """`program` is the state of the built program, `digest` the one of its content; `inputs` are the files that it was
    built from, relative to the folder of the component, each with state and digest; `more` are those of them that only
    the build knows."""

    type: str
    program: State
    inputs: dict[str, tuple[State, str]]
    more: tuple[str, ...] = ()
    digest: str = ""


class ProgramState(msgspec.Struct, frozen=True):
    """The program of a component: whether it exists (`is_there`), and which inputs have `changed` since it was built.
    `type` is the last build type, '' if unknown; `is_known` says that the program is the one of the last build."""

    is_there: bool
    changed: tuple[str, ...] = ()
    type: str = ""
    is_known: bool = False

    @property
    def is_current(self) -> bool:
        return self.is_there and not self.changed


def stale(units: Iterable[Unit]) -> list[Unit]:
    """Those whose programs exist, but were built from other inputs."""
    inputs = Inputs()
    return [unit for unit in units if (state := inspect(unit, inputs)).is_there and state.changed]


def inspect(unit: Unit, inputs: Inputs) -> ProgramState:
    program, stamp = state(unit.program), load(unit)
    type_ = stamp.type if stamp else ""
    if program is None:
        return ProgramState(False, type=type_)
    if stamp is not None and stamp.program == program:
        return ProgramState(True, _changed(unit, inputs, stamp), type_, is_known=True)
    if stamp is not None and _is_copy(unit, inputs, stamp, program) and not _changed(unit, inputs, stamp):
        return ProgramState(True, (), type_, is_known=True)
    return ProgramState(True, tuple(sorted(_younger(unit, inputs, program))), type_)


def _is_copy(unit: Unit, inputs: Inputs, stamp: BuildStamp, program: State) -> bool:
    """Whether a program has the content of the one of a stamp, as in a copy of a workspace."""
    return (
        bool(stamp.digest) and stamp.program[0] == program[0] and inputs.digest(unit.program, program) == stamp.digest
    )


def _changed(unit: Unit, inputs: Inputs, stamp: BuildStamp) -> tuple[str, ...]:
    """The inputs that are not those of a stamp."""
    files = {path: os.path.normpath(os.path.join(unit.folder, path)) for path in stamp.inputs}
    now = inputs.of(unit, (files[path] for path in stamp.more))
    changed = set(files.values()) ^ now.keys()
    for path, (known, known_digest) in stamp.inputs.items():
        file = files[path]
        if file in now and now[file] != known and inputs.digest(file, now[file]) != known_digest:
            changed.add(file)
    return tuple(sorted(changed))


def _younger(unit: Unit, inputs: Inputs, program: State) -> list[str]:
    return [path for path, (_, changed, _) in inputs.of(unit).items() if changed > program[1]]


def take(unit: Unit, inputs: Inputs, type_: str) -> BuildStamp:
    """The stamp of a build that begins now."""
    return BuildStamp(type_, (0, 0, 0), _known(unit, inputs, inputs.of(unit)))


def with_more(unit: Unit, begun: BuildStamp, inputs: Inputs, more: Iterable[str]) -> BuildStamp:
    """A stamp with more files that the build has read."""
    others = {path: found for path in more if (found := state(path)) is not None}
    known = _known(unit, inputs, others)
    return msgspec.structs.replace(
        begun, inputs={**known, **begun.inputs}, more=tuple(sorted(known.keys() - begun.inputs.keys()))
    )


def _known(unit: Unit, inputs: Inputs, files: Mapping[str, State]) -> dict[str, tuple[State, str]]:
    return {os.path.relpath(path, unit.folder): (found, inputs.digest(path, found)) for path, found in files.items()}


def keep(unit: Unit, begun: BuildStamp) -> None:
    """Writes the stamp, with the current state of the program. If it cannot be written, the next build compares
    times."""
    program = state(unit.program)
    if program is None or not stays_inside(unit.folder, _NAME):
        return
    with contextlib.suppress(OSError):
        os.makedirs(unit.path(FOLDER), exist_ok=True)
        whole_file.ignore_all(unit.path(FOLDER))
        kept = msgspec.structs.replace(begun, program=program, digest=Inputs().digest(unit.program, program))
        text = json.dumps(msgspec.to_builtins(kept), separators=(",", ":"))
        whole_file.put(unit.path(_NAME), text.encode("utf-8", "surrogateescape"))


def load(unit: Unit) -> BuildStamp | None:
    try:
        with open(unit.path(_NAME), "rb", opener=regular) as file:
            return msgspec.convert(json.loads(file.read().decode("utf-8", "surrogateescape")), BuildStamp)
    except (OSError, ValueError, RecursionError):
        return None


def forget(unit: Unit) -> None:
    with contextlib.suppress(OSError):
        os.unlink(unit.path(_NAME))
