"""The state machine of a C++ component: its tables and events, and the interpreter that is copied along."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.machines import lower
from robocomp_yaml.emit.render import render
from robocomp_yaml.languages.cpp import machine_text
from robocomp_yaml.languages.cpp.names import parameter
from robocomp_yaml.languages.cpp.text import comment, one_line
from robocomp_yaml.model import machine_names as names
from robocomp_yaml.model.statemachine import State, StateMachine
from robocomp_yaml.transactions.plan import FilePlan


class EventView(msgspec.Struct, frozen=True):
    name: str
    method: str


class StateView(msgspec.Struct, frozen=True):
    name: str
    comment: str


class MachineView(msgspec.Struct, frozen=True):
    """What the worker has of a machine: states, names of guards and actions; `called` are all actions, also those that
    every worker has. `fires` is an example of how to fire an event. `member` and `signals` are for code for RoboComp's
    own tool."""

    states: list[StateView]
    guards: list[str]
    actions: list[str]
    called: list[str]
    fires: str
    member: str
    signals: list[str]


class TablesView(msgspec.Struct, frozen=True):
    source: str
    events: list[EventView]
    functions: str


def view(machine: StateMachine) -> MachineView:
    called = [action.name for action in names.actions(machine)]
    return MachineView(
        [StateView(state.id, _comment(state)) for state in names.with_handler(machine)],
        [guard.name for guard in names.guards(machine)],
        [name for name in called if name not in names.CALLABLE],
        called,
        next((f"events.{event.method}()" for event in _events(machine)), "there are none"),
        parameter(names.robocomps_machine(machine)),
        names.robocomps_signals(machine),
    )


def _comment(state: State) -> str:
    return comment(f"The state '{state.id}' has been entered.\n\n{state.doc}", "    ")


def files(machine: StateMachine) -> list[FilePlan]:
    """The tables of the component's machine."""
    shown = TablesView(
        source=one_line(machine.path.rpartition("/")[2]),
        events=_events(machine),
        functions=machine_text.functions(lower.lower(machine), "makeTables"),
    )
    return [
        FilePlan("generated/statemachine.h", render("cpp/statemachine.h.j2", shown)),
        FilePlan("generated/statemachine.cpp", render("cpp/statemachine.cpp.j2", shown)),
    ]


def _events(machine: StateMachine) -> list[EventView]:
    return [EventView(event.text.text, parameter(event.name)) for event in names.events(machine)]
