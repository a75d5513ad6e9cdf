"""What the parts of a state machine are called in code: the same in every language."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import msgspec

from robocomp_yaml.model import conditions
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import MachineIndex
from robocomp_yaml.model.statemachine import HISTORY, PYTHON, If, Script, State, StateMachine

STATE, GUARD, ACTION, EVENT = "the state", "the guard", "the action", "the event"

# Methods that every worker has and an action may call.
CALLABLE = frozenset(["compute", "killYourSelf"])

# What the worker of code for RoboComp's own tool has besides what every worker has, or calls of Qt.
ROBOCOMP_NAMES = frozenset(
    "Period close configLoader connect disconnect emergency event hibernation hibernationCheck hibernationChecker kill "
    "parent restore setParams setupUi show startup_check states timer ui".split()
)
_DEFAULT_MACHINE = "defaultMachine"


class NamedPart(msgspec.Struct, frozen=True):
    """A part of a machine, under the name that it has in the document and in code."""

    kind: str
    text: Text
    name: str


def entry_handler(state: str) -> str:
    """RoboComp's name for the method that is called when a state is entered."""
    return f"sm_{state}"


def exit_handler(state: str) -> str:
    return f"sm_{state}_exit"


def period_handler(state: str) -> str:
    return f"sm_{state}_period"


def robocomp_machine(machine: StateMachine) -> str:
    """The member that RoboComp's code starts: it has the name that the machine has in its own file."""
    taken = ROBOCOMP_NAMES | {"communicator", "events", "log", "mutex", "parameters", "statemachine"}
    is_name = not machine.inline and re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", machine.name) and machine.name not in taken
    return machine.name if is_name else _DEFAULT_MACHINE


def robocomp_signals(machine: StateMachine) -> list[str]:
    """The events that RoboComp's code emits as signals: each is named after where the machine goes."""
    return [event.name for event in events(machine) if re.fullmatch(r"t_\w+_to_\w+", event.name)]


def states_with_handlers(machine: StateMachine) -> list[State]:
    """The states that have handlers."""
    return [state for state in machine.states if state.id and state.kind != HISTORY]


def events(machine: StateMachine) -> list[NamedPart]:
    """What the component's code may fire: what transitions wait for, unless it comes from the machine itself."""
    found: dict[str, NamedPart] = {}
    listed = [event for _, transition in MachineIndex(machine).transitions() for event in transition.events]
    for event in (*machine.events, *listed):
        name = event.text.removesuffix(".*").rstrip(".")
        if name not in ("", "*", "error") and not name.startswith(("done.", "error.")):
            found.setdefault(name, NamedPart(EVENT, Text(name, span=event.span), re.sub(r"[.-]", "_", name)))
    return list(found.values())


def guards(machine: StateMachine) -> list[NamedPart]:
    """Methods that say whether a condition holds."""
    return list({named.name: named for named in _methods(machine) if named.kind == GUARD}.values())


def actions(machine: StateMachine) -> list[NamedPart]:
    """Methods that do something on the way."""
    return list({named.name: named for named in _methods(machine) if named.kind == ACTION}.values())


def _methods(machine: StateMachine) -> Iterator[NamedPart]:
    index = MachineIndex(machine)
    if machine.datamodel != PYTHON:
        texts = [transition.condition for _, transition in index.transitions()]
        for action in index.actions():
            if isinstance(action, If):
                texts += [condition for condition, _ in action.branches]
            elif isinstance(action, Script):
                for name in _read(conditions.script, action.code):
                    yield NamedPart(ACTION, Text(name, span=action.code.span), name)
        for text in texts:
            if text is not None:
                for name in _read(_guards, text):
                    yield NamedPart(GUARD, Text(name, span=text.span), name)
    for invoked in index.invoked():
        yield from _methods(invoked)


def _guards(text: str) -> list[str]:
    return list(conditions.names(conditions.condition(text), conditions.GUARD))


def _read(read: Callable[[str], list[str]], text: Text) -> list[str]:
    """Nothing where the text is wrong, of which another one tells."""
    try:
        return read(text.text)
    except conditions.NullSyntaxError:
        return []
