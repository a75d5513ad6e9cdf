"""The state machine of a C++ component: its tables and events."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass

from robocomp_yaml.emit.machines import lower, views
from robocomp_yaml.emit.render import View, render
from robocomp_yaml.languages._shared.text import IN
from robocomp_yaml.languages.cpp.names import parameter
from robocomp_yaml.languages.cpp.text import comment, literal, one_line
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.semantics.tables import Machine, Value
from robocomp_yaml.transactions.plan import FilePlan

WIDTH = 110
_KINDS = {"Value": "ValueKind", "Condition": "ConditionKind", "Action": "ActionKind", "State": "StateKind"}


def view(machine: StateMachine) -> View:
    return views.view(machine, parameter, lambda text: comment(text, "    "), "events.")


def files(machine: StateMachine) -> list[FilePlan]:
    """The files with the tables of the component's machine."""
    shown = View(
        source=one_line(machine.path.rpartition("/")[2]),
        events=views.events(machine, parameter),
        functions=functions(lower.lower(machine), "makeTables"),
    )
    return [
        FilePlan("generated/statemachine.h", render("cpp/statemachine.h.j2", shown)),
        FilePlan("generated/statemachine.cpp", render("cpp/statemachine.cpp.j2", shown)),
    ]


def text(table: object, indent: str = "") -> str:
    """The table as an aggregate, without trailing fields that have their default; a long one has a line per field."""
    if isinstance(table, tuple):
        return _braces("", [text(item, indent + "    ") for item in table], indent)
    if isinstance(table, bool):
        return "true" if table else "false"
    if isinstance(table, str):
        return literal(table)
    if not is_dataclass(table):
        return str(table)
    inner = indent + "    "
    shown = list(fields(table))
    while shown and type(table).__name__ != "Action" and getattr(table, shown[-1].name) == shown[-1].default:
        shown.pop()
    parts = [_field(table, field.name, inner) for field in shown]
    return _braces(type(table).__name__, parts, indent) if parts else "{}"


def functions(machine: Machine, name: str) -> str:
    """A function that creates the tables of a machine, after the functions for the machines that it invokes.

    It has one statement for each state: compilers need ten times as long for a single expression.
    """
    inner = [functions(invoked, f"{name}_{number}") for number, invoked in enumerate(machine.machines, 1)]
    head = Machine(machine.name, machine.datamodel, machine.late, (), (), machine.scripts)
    lines = [f"Machine made = {text(head, IN)};"]
    lines += [f"made.states.push_back({text(state, IN)});" for state in machine.states]
    lines += [f"made.transitions.push_back({text(transition, IN)});" for transition in machine.transitions]
    lines += [f"made.machines.push_back({name}_{number}());" for number in range(1, len(inner) + 1)]
    body = "".join(f"{IN}{line}\n" for line in [*lines, "return made;"])
    return "\n".join([*inner, f"Machine {name}()\n{{\n{body}}}\n"])


def _field(table: object, name: str, indent: str) -> str:
    value = getattr(table, name)
    if name == "kind":
        return f"{_KINDS[type(table).__name__]}::{value.capitalize()}"
    if isinstance(table, Value) and name == "text" and table.kind == "literal":
        decoded = json.loads(value)
        return literal(decoded if isinstance(decoded, str) else value)
    return "{}" if value in ("", ()) or value == Value() else text(value, indent)


def _braces(head: str, items: list[str], indent: str) -> str:
    line = f"{head}{{{', '.join(items)}}}"
    if "\n" not in line and len(indent) + len(line) <= WIDTH:
        return line
    inner = indent + "    "
    return f"{head}{{\n" + "".join(f"{inner}{item},\n" for item in items) + f"{indent}}}"
