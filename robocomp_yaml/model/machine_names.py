"""The names of a state machine's parts in generated code, which are the same in every language."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import msgspec

from robocomp_yaml.model import conditions
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import MachineIndex, indexes
from robocomp_yaml.model.statemachine import HISTORY, PYTHON, If, Script, State, StateMachine

STATE, GUARD, ACTION, EVENT = "the state", "the guard", "the action", "the event"

# Methods of every worker that an action may call.
CALLABLE = frozenset(["compute", "killYourSelf"])

# Further names that a worker has, or gets from Qt, if its code is like that of RoboComp's own generator.
ROBOCOMP_NAMES = frozenset(
    "Period close configLoader connect disconnect emergency event hibernation hibernationCheck hibernationChecker kill "
    "parent restore setParams setupUi show startup_check states timer ui".split()
)
_DEFAULT_MACHINE = "defaultMachine"


class NamedPart(msgspec.Struct, frozen=True):
    """A part of a machine: `text` is its name in the document, `name` its name in code."""

    kind: str
    text: Text
    name: str


def entry_handler(state: str) -> str:
    """The name of the method that is called when a state is entered, as in RoboComp."""
    return f"sm_{state}"


def exit_handler(state: str) -> str:
    return f"sm_{state}_exit"


def period_handler(state: str) -> str:
    return f"sm_{state}_period"


def robocomp_machine(machine: StateMachine) -> str:
    """The member with which RoboComp's code starts the machine: the name in the SCXML file, if it is a legal one."""
    taken = ROBOCOMP_NAMES | {"communicator", "events", "log", "mutex", "parameters", "statemachine"}
    is_name = not machine.inline and re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", machine.name) and machine.name not in taken
    return machine.name if is_name else _DEFAULT_MACHINE


def robocomp_signals(machine: StateMachine) -> list[str]:
    """The events that RoboComp's code emits as signals: `t_SOURCE_to_TARGET`."""
    return [event.name for event in events(machine) if re.fullmatch(r"t_\w+_to_\w+", event.name)]


def older_signals(machine: StateMachine) -> dict[str, str]:
    """The names of the signals in an older version of RoboComp's tool: `SOURCEtoTARGET`, each with the newer one."""
    states = {state.id for state in machine.states}
    found: dict[str, str] = {}
    for signal in robocomp_signals(machine):
        parts = signal.removeprefix("t_").split("_to_")
        pairs = [("_to_".join(parts[:at]), "_to_".join(parts[at:])) for at in range(1, len(parts))]
        source, target = next((pair for pair in pairs if states.issuperset(pair)), pairs[0])
        found.setdefault(f"{source}to{target}", signal)
    return found


def states_with_handlers(machine: StateMachine) -> list[State]:
    """The states with handler methods: those with an id, without histories."""
    return [state for state in machine.states if state.id and state.kind != HISTORY]


def events(machine: StateMachine) -> list[NamedPart]:
    """The events that the component's code may fire: those that transitions wait for, without the machine's own."""
    found: dict[str, NamedPart] = {}
    listed = [event for _, transition in MachineIndex(machine).transitions() for event in transition.events]
    for event in (*machine.events, *listed):
        name = event.text.removesuffix(".*").rstrip(".")
        if name not in ("", "*", "error") and not name.startswith(("done.", "error.")):
            found.setdefault(name, NamedPart(EVENT, Text(name, span=event.span), re.sub(r"[.-]", "_", name)))
    return list(found.values())


def guards(machine: StateMachine) -> list[NamedPart]:
    """The guards: methods that return whether a condition holds."""
    return list({named.name: named for named in _methods(machine) if named.kind == GUARD}.values())


def actions(machine: StateMachine) -> list[NamedPart]:
    """The actions: methods that transitions and handlers call."""
    return list({named.name: named for named in _methods(machine) if named.kind == ACTION}.values())


def _methods(machine: StateMachine) -> Iterator[NamedPart]:
    for index in indexes(machine):
        if index.machine.datamodel == PYTHON:
            continue
        texts = [transition.condition for _, transition in index.transitions()]
        for action in index.actions():
            if isinstance(action, If):
                texts += [condition for condition, _ in action.branches]
            elif isinstance(action, Script):
                for name in _read(conditions.script, action.code):
                    yield NamedPart(ACTION, Text(name, span=action.code.span), name)
        for text in filter(None, texts):
            for name in _read(_guards, text):
                yield NamedPart(GUARD, Text(name, span=text.span), name)


def _guards(text: str) -> list[str]:
    return list(conditions.names(conditions.condition(text), conditions.GUARD))


def _read(read: Callable[[str], list[str]], text: Text) -> list[str]:
    """The names in a text; none if the text is wrong, which a check reports."""
    try:
        return read(text.text)
    except conditions.NullSyntaxError:
        return []
