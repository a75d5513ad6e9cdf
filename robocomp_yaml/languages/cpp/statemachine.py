"""The state machine of a C++ component: its tables and events."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.machines import lower, views
from robocomp_yaml.emit.machines.views import EventView, MachineView
from robocomp_yaml.emit.render import render
from robocomp_yaml.languages.cpp import machine_text
from robocomp_yaml.languages.cpp.names import parameter
from robocomp_yaml.languages.cpp.text import comment, one_line
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.transactions.plan import FilePlan


class TablesView(msgspec.Struct, frozen=True):
    source: str
    events: list[EventView]
    functions: str


def view(machine: StateMachine) -> MachineView:
    return views.view(machine, parameter, lambda text: comment(text, "    "), "events.")


def files(machine: StateMachine) -> list[FilePlan]:
    """The tables of the component's machine."""
    shown = TablesView(
        source=one_line(machine.path.rpartition("/")[2]),
        events=views.events(machine, parameter),
        functions=machine_text.functions(lower.lower(machine), "makeTables"),
    )
    return [
        FilePlan("generated/statemachine.h", render("cpp/statemachine.h.j2", shown)),
        FilePlan("generated/statemachine.cpp", render("cpp/statemachine.cpp.j2", shown)),
    ]
