"""Processes whose programs are not there, or are older than what they are made of."""

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
from robocomp_yaml.network.network import Network

_SHOWN = 3  # files that are named


class Stale(msgspec.Struct, frozen=True):
    """A component that is to be built, and the processes that start it."""

    unit: Unit
    look: ProgramState
    processes: tuple[str, ...]


def stale(network: Network, units: Iterable[Unit], names: Collection[str]) -> list[Stale]:
    """Those of the components that these processes start on this machine, by the programs that are built there."""
    inputs = Inputs()
    by_program = {_real(unit.program): unit for unit in units if unit.language.build}
    starting: dict[str, list[str]] = {}
    for process in network.enabled():
        program = _real(process.command[0]) if process.component and process.name in names else ""
        if program in by_program and is_this_machine(network.address(process)):
            starting.setdefault(program, []).append(process.name)
    looks = ((program, stamps.inspect(by_program[program], inputs)) for program in starting)
    return [
        Stale(by_program[program], look, tuple(starting[program])) for program, look in looks if not look.is_current
    ]


def told(network: Network, found: Iterable[Stale]) -> Iterator[Diagnostic]:
    """What is wrong with programs that are there; of one that is not, the engine says so."""
    for one in found:
        if not one.look.is_there:
            continue
        first = network.processes[one.processes[0]]
        shown = list(map(shown_path, one.look.changed))
        more = f" and {len(shown) - _SHOWN} more" if len(shown) > _SHOWN else ""
        type_ = f" --type {one.look.type}" if one.look.type not in ("", RELEASE) else ""
        yield deploying.STALE.at(
            first.span, name=first.name, changed=", ".join(shown[:_SHOWN]) + more, hint=f"`{one.unit.command}{type_}`",
            related=[Related("started as this too", network.processes[name].span) for name in one.processes[1:_SHOWN]],
        )  # fmt: skip


def _real(program: str) -> str:
    """By its folder, whatever leads there; the program itself may be a link."""
    folder, name = os.path.split(program)
    return os.path.join(os.path.realpath(folder), name)
