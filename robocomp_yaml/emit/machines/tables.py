"""A state machine as tables, in which states and transitions point at each other by number.

The run time of each language has the same tables, field by field (`machine/tables.py`, `machine/tables.h` of its
templates), which its `statemachine` writes.
"""

from __future__ import annotations

from dataclasses import dataclass

NOWHERE = -1


@dataclass(frozen=True, slots=True)
class Value:
    kind: str = "none"
    text: str = ""
    machine: int = NOWHERE


@dataclass(frozen=True, slots=True)
class Param:
    name: str
    value: Value


@dataclass(frozen=True, slots=True)
class Condition:
    kind: str = "always"
    name: str = ""
    state: int = NOWHERE
    parts: tuple[Condition, ...] = ()


@dataclass(frozen=True, slots=True)
class Send:
    event: Value
    target: Value = Value()
    type: Value = Value()
    delay: Value = Value()
    id: str = ""
    id_location: str = ""
    params: tuple[Param, ...] = ()
    content: Value = Value()


@dataclass(frozen=True, slots=True)
class Branch:
    condition: Condition
    actions: tuple[Action, ...] = ()


@dataclass(frozen=True, slots=True)
class Action:
    kind: str
    name: str = ""
    value: Value = Value()
    index: str = ""
    send: tuple[Send, ...] = ()
    branches: tuple[Branch, ...] = ()


@dataclass(frozen=True, slots=True)
class Transition:
    source: int
    events: tuple[str, ...] = ()
    condition: Condition = Condition()
    targets: tuple[int, ...] = ()
    internal: bool = False
    actions: tuple[Action, ...] = ()


@dataclass(frozen=True, slots=True)
class Block:
    actions: tuple[Action, ...] = ()


@dataclass(frozen=True, slots=True)
class Invoke:
    type: Value = Value()
    source: Value = Value()
    id: str = ""
    id_location: str = ""
    params: tuple[Param, ...] = ()
    content: Value = Value()
    autoforward: bool = False
    finalize: tuple[Action, ...] = ()


@dataclass(frozen=True, slots=True)
class State:
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


@dataclass(frozen=True, slots=True)
class Machine:
    name: str
    datamodel: str
    late: bool
    states: tuple[State, ...]
    transitions: tuple[Transition, ...]
    scripts: tuple[Action, ...] = ()
    machines: tuple[Machine, ...] = ()
