# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""The tables of a state machine: states and transitions refer to each other by number.

The states are in the order of the document, each before its children. Number 0 is the root. The run times of other
languages have the same tables, field by field.
"""

from __future__ import annotations

from dataclasses import dataclass

NOWHERE = -1
"""The number of a missing state, transition or machine."""


@dataclass(frozen=True)
class Value:
    """`kind`: 'none', 'expr' (of the data model's language), 'literal' (JSON), 'text' (of the document), 'machine'."""

    kind: str = "none"
    text: str = ""
    machine: int = NOWHERE


@dataclass(frozen=True)
class Param:
    name: str
    value: Value


@dataclass(frozen=True)
class Condition:
    """`kind`: 'always', 'never', 'in' (a state's number is `state`), 'guard', 'not', 'and', 'or', 'expr'."""

    kind: str = "always"
    name: str = ""
    state: int = NOWHERE
    parts: tuple[Condition, ...] = ()


@dataclass(frozen=True)
class Send:
    event: Value
    target: Value = Value()
    type: Value = Value()
    delay: Value = Value()
    id: str = ""
    id_location: str = ""
    params: tuple[Param, ...] = ()
    content: Value = Value()


@dataclass(frozen=True)
class Branch:
    condition: Condition
    actions: tuple[Action, ...] = ()


@dataclass(frozen=True)
class Action:
    """`kind`: 'raise', 'send', 'cancel', 'log', 'assign', 'script', 'call', 'if', 'foreach'. `name` is the event,
    label, location, code, action or item. `index` is the index variable of foreach."""

    kind: str
    name: str = ""
    value: Value = Value()
    index: str = ""
    send: tuple[Send, ...] = ()
    branches: tuple[Branch, ...] = ()


@dataclass(frozen=True)
class Transition:
    source: int
    events: tuple[str, ...] = ()
    condition: Condition = Condition()
    targets: tuple[int, ...] = ()
    internal: bool = False
    actions: tuple[Action, ...] = ()


@dataclass(frozen=True)
class Block:
    actions: tuple[Action, ...] = ()


@dataclass(frozen=True)
class Invoke:
    type: Value = Value()
    source: Value = Value()
    id: str = ""
    id_location: str = ""
    params: tuple[Param, ...] = ()
    content: Value = Value()
    autoforward: bool = False
    finalize: tuple[Action, ...] = ()


@dataclass(frozen=True)
class State:
    """`kind`: 'state', 'parallel', 'final', 'history'. `initial` is the number of a transition."""

    id: str
    kind: str
    parent: int
    children: tuple[int, ...] = ()
    transitions: tuple[int, ...] = ()
    initial: int = NOWHERE
    deep: bool = False
    entry: tuple[Block, ...] = ()
    exit: tuple[Block, ...] = ()
    data: tuple[Param, ...] = ()
    invokes: tuple[Invoke, ...] = ()
    params: tuple[Param, ...] = ()
    content: Value = Value()


@dataclass(frozen=True)
class Machine:
    """`machines` are the invoked machines, by number."""

    name: str
    datamodel: str
    late: bool
    states: tuple[State, ...]
    transitions: tuple[Transition, ...]
    scripts: tuple[Action, ...] = ()
    machines: tuple[Machine, ...] = ()
