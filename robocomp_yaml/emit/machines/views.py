"""Views of a component's state machine for templates: the worker's part of it, and its events."""

from __future__ import annotations

from collections.abc import Callable

from robocomp_yaml.emit.render import View
from robocomp_yaml.model import machine_names as names
from robocomp_yaml.model.statemachine import StateMachine


def view(machine: StateMachine, in_code: Callable[[str], str], comment: Callable[[str], str], events_of: str) -> View:
    """The view of a machine. `in_code` makes names in the language; `events_of` is the prefix of an event's name.

    It has the states, and the names of guards and actions. `called` are all actions, with those of every worker.
    `fires` is an example of code that fires an event. `member` and the signals are for code for RoboComp's own tool;
    older versions of it had the `older_signals`."""
    called = [action.name for action in names.actions(machine)]
    states = names.states_with_handlers(machine)
    return View(
        states=[
            View(name=one.id, comment=comment(f"The state '{one.id}' has been entered.\n\n{one.doc}")) for one in states
        ],
        guards=[guard.name for guard in names.guards(machine)],
        actions=[name for name in called if name not in names.CALLABLE],
        called=called,
        fires=next((f"{events_of}{event.method}()" for event in events(machine, in_code)), "there are none"),
        member=in_code(names.robocomp_machine(machine)),
        signals=names.robocomp_signals(machine),
        older_signals=[View(name=older, signal=signal) for older, signal in names.older_signals(machine).items()],
    )


def events(machine: StateMachine, in_code: Callable[[str], str]) -> list[View]:
    """The events of a machine, with the names of their methods."""
    return [View(name=event.text.text, method=in_code(event.name)) for event in names.events(machine)]
