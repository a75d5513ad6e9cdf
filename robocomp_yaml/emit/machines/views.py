"""Views of a component's state machine for templates: the worker's part of it, and its events."""

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


class OlderSignal(msgspec.Struct, frozen=True):
    """The name that an older version of RoboComp's tool gave a signal."""

    name: str
    signal: str


class MachineView(msgspec.Struct, frozen=True):
    """The states, and the names of guards and actions. `called` are all actions, with those of every worker. `fires` is
    an example of code that fires an event. `member` and the signals are for code for RoboComp's own tool."""

    states: list[StateView]
    guards: list[str]
    actions: list[str]
    called: list[str]
    fires: str
    member: str
    signals: list[str]
    older_signals: list[OlderSignal]


def view(
    machine: StateMachine, in_code: Callable[[str], str], comment: Callable[[str], str], events_of: str
) -> MachineView:
    """The view of a machine. `in_code` makes names in the language; `events_of` is the prefix of an event's name."""
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
        [OlderSignal(older, signal) for older, signal in names.older_signals(machine).items()],
    )


def events(machine: StateMachine, in_code: Callable[[str], str]) -> list[EventView]:
    """The events of a machine, with the names of their methods."""
    return [EventView(event.text.text, in_code(event.name)) for event in names.events(machine)]
