"""Processes whose programs are missing, or older than their sources."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator

import msgspec

from robocomp_yaml.building import stamps
from robocomp_yaml.building.inputs import Inputs
from robocomp_yaml.building.job import RELEASE
from robocomp_yaml.building.stamps import ProgramState
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.check.ddsl.files import is_this_machine
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.listing import some
from robocomp_yaml.network.network import Network

_SHOWN = 3  # files


class StaleComponent(msgspec.Struct, frozen=True):
    """A component that must be built, with the names of its processes."""

    unit: Unit
    look: ProgramState
    processes: tuple[str, ...]


def stale(network: Network, units: Iterable[Unit], names: Collection[str]) -> list[StaleComponent]:
    """The stale components of these processes on this machine."""
    inputs = Inputs()
    by_program = {_real(unit.program): unit for unit in units if unit.language.build}
    starting: dict[str, list[str]] = {}
    for process in network.enabled():
        program = _real(process.command[0]) if process.component and process.name in names else ""
        if program in by_program and is_this_machine(network.address(process)):
            starting.setdefault(program, []).append(process.name)
    looks = ((program, stamps.inspect(by_program[program], inputs)) for program in starting)
    return [
        StaleComponent(by_program[program], look, tuple(starting[program]))
        for program, look in looks
        if not look.is_current
    ]


def diagnostics(network: Network, found: Iterable[StaleComponent]) -> Iterator[Diagnostic]:
    """A diagnostic for each stale program. A missing program is reported by the engine."""
    for one in found:
        if not one.look.is_there:
            continue
        first = network.processes[one.processes[0]]
        shown = list(map(shown_path, one.look.changed))
        type_ = f" --type {one.look.type}" if one.look.type not in ("", RELEASE) else ""
        yield deploying.STALE.at(
            first.span, name=first.name, changed=some(shown, _SHOWN), hint=f"`{one.unit.command}{type_}`",
            related=[Related("also started here", network.processes[name].span) for name in one.processes[1:_SHOWN]],
        )  # fmt: skip


def _real(program: str) -> str:
    """A program's path with the real path of its folder; the program itself can be a link."""
    folder, name = os.path.split(program)
    return os.path.join(os.path.realpath(folder), name)
