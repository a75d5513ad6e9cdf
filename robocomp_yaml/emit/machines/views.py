"""What templates show of a component's state machine: what the worker has of it, and its events."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from robocomp_yaml.model import machine_names as names
from robocomp_yaml.model.statemachine import StateMachine


class EventView(msgspec.Struct, frozen=True):
    name: str
    method: str


class StateView(msgspec.Struct, frozen=True):
    name: str
    comment: str


class MachineView(msgspec.Struct, frozen=True):
    """States, and names of guards and actions; `called` are all actions, also those that every worker has. `fires` is
    an example of how to fire an event. `member` and `signals` are for code for RoboComp's own tool."""

    states: list[StateView]
    guards: list[str]
    actions: list[str]
    called: list[str]
    fires: str
    member: str
    signals: list[str]


def view(
    machine: StateMachine, in_code: Callable[[str], str], comment: Callable[[str], str], events_of: str
) -> MachineView:
    """`in_code` gives names as the language has them, `events_of` is what stands before the name of an event."""
    called = [action.name for action in names.actions(machine)]
    states = names.states_with_handlers(machine)
    return MachineView(
        [StateView(one.id, comment(f"The state '{one.id}' has been entered.\n\n{one.doc}")) for one in states],
        [guard.name for guard in names.guards(machine)],
        [name for name in called if name not in names.CALLABLE],
        called,
        next((f"{events_of}{event.method}()" for event in events(machine, in_code)), "there are none"),
        in_code(names.robocomp_machine(machine)),
        names.robocomp_signals(machine),
    )


def events(machine: StateMachine, in_code: Callable[[str], str]) -> list[EventView]:
    return [EventView(event.text.text, in_code(event.name)) for event in names.events(machine)]
