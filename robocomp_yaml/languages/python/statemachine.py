"""The state machine of a Python component: its tables and events."""

from __future__ import annotations

import json
import re
from dataclasses import MISSING, fields, is_dataclass

from robocomp_yaml.emit.machines import lower, views
from robocomp_yaml.emit.render import View, render
from robocomp_yaml.languages.python.names import python_name
from robocomp_yaml.languages.python.text import docstring, folded, one_line
from robocomp_yaml.model.machine_index import MachineIndex
from robocomp_yaml.model.statemachine import PYTHON, StateMachine
from robocomp_yaml.transactions.plan import FilePlan


def text(table: object, indent: str = "") -> str:
    """A constructor call without arguments that have their default; a long one has a line per argument."""
    inner = indent + "    "
    if isinstance(table, tuple):
        return folded("(", [text(item, inner) for item in table], ",)" if len(table) == 1 else ")", indent)
    if isinstance(table, str):
        return json.dumps(table, ensure_ascii=False)
    if not is_dataclass(table):
        return repr(table)
    set_ = [f for f in fields(table) if f.default is MISSING or getattr(table, f.name) != f.default]
    parts = [f"{f.name}={text(getattr(table, f.name), inner)}" for f in set_]
    return folded(f"{type(table).__name__}(", parts, ")", indent)


def view(machine: StateMachine) -> View:
    return views.view(machine, python_name, lambda text: docstring(text, " " * 8), "self.events.")


def files(machine: StateMachine, component: str) -> list[FilePlan]:
    """The files with the tables of the component's machine."""
    return [FilePlan("generated/statemachine.py", tables(machine, component))]


def tables(machine: StateMachine, component: str) -> str:
    """The module with the tables."""
    literal = text(lower.lower(machine))
    return render(
        "python/statemachine.py.j2",
        source=one_line(machine.path.rpartition("/")[2]),
        name=component,
        scripting=scripts(machine),
        tables=", ".join(sorted(set(re.findall(r"\b([A-Z][a-z]+)\(", _without_texts(literal))))),
        events=views.events(machine, python_name),
        machine=literal,
    )


def _without_texts(literal: str) -> str:
    return re.sub(r"""'(?:[^'\\\n]|\\.)*'|"(?:[^"\\\n]|\\.)*\"""", "''", literal)


def scripts(machine: StateMachine) -> bool:
    """Whether a machine, or one that it invokes, has Python expressions."""
    return machine.datamodel == PYTHON or any(map(scripts, MachineIndex(machine).invoked()))
