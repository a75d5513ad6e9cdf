"""The model of a state machine: what SCXML says (https://www.w3.org/TR/scxml/), from a file or written in the CDSL.

Expressions are kept as they are spelled: what they mean depends on the data model. `null` is the one that both
languages have: conditions are names of guards joined by `and`, `or` and `not`, values are literals, a script is a list
of names of actions. With `python`, expressions are Python's, run by the component.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import count

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.located import Spanned, Text

STATE, PARALLEL, FINAL, HISTORY = "state", "parallel", "final", "history"
NULL, PYTHON = "null", "python"


def words(text: str, span: Span) -> tuple[Text, ...]:
    """The words of a text that stands here, each at its own place where nothing in it is escaped or on a line of its
    own."""
    quotes = span.end_column - span.column - len(text)
    is_plain = span.line == span.end_line and quotes in (0, 2)
    start = span.column + quotes // 2

    def place(found: re.Match[str]) -> Span:
        return replace(span, column=start + found.start(), end_column=start + found.end()) if is_plain else span

    return tuple(Text(found[0], span=place(found)) for found in re.finditer(r"\S+", text))


class Value(Spanned, frozen=True):
    """What may be given as an expression or as it stands; `machine` where it is a whole machine."""

    expr: Text | None = None
    literal: str | None = None
    machine: StateMachine | None = None


class Param(Spanned, frozen=True):
    """A named value of an event or of an invocation; from `location` where it has no value."""

    name: str
    value: Value


class Payload(msgspec.Struct, frozen=True):
    """What goes along: named values, or one content."""

    params: tuple[Param, ...] = ()
    content: Value | None = None


class Raise(Spanned, frozen=True):
    event: Text


class Send(Spanned, frozen=True):
    """`event`, `target`, `type` and `delay` are literals or, in the fields beside them, expressions. `delay` is as
    spelled: `100ms`, `1.5s`."""

    event: Value
    target: Value
    type: Value
    delay: Value
    id: str = ""
    id_location: Text | None = None
    payload: Payload = Payload()


class Cancel(Spanned, frozen=True):
    id: Value


class Log(Spanned, frozen=True):
    label: str
    value: Value | None = None


class Assign(Spanned, frozen=True):
    location: Text
    value: Value


class Script(Spanned, frozen=True):
    """A piece of the data model's language; with `null`, names of actions."""

    code: Text


class If(Spanned, frozen=True):
    """Conditions with what is done under them; the last one may have none."""

    branches: tuple[tuple[Text | None, Block], ...]


class Foreach(Spanned, frozen=True):
    array: Text
    item: Text
    index: Text | None
    actions: Block


Action = Raise | Send | Cancel | Log | Assign | Script | If | Foreach
Block = tuple[Action, ...]


class Transition(Spanned, frozen=True):
    """Without `events` it is taken as soon as its condition holds; without `targets` the state stays."""

    events: tuple[Text, ...] = ()
    condition: Text | None = None
    targets: tuple[Text, ...] = ()
    internal: bool = False
    actions: Block = ()


class Data(Spanned, frozen=True):
    id: Text
    value: Value


class Invoke(Spanned, frozen=True):
    """A machine that runs while its state is active."""

    type: Value
    source: Value
    id: str = ""
    id_location: Text | None = None
    payload: Payload = Payload()
    autoforward: bool = False
    finalize: Block | None = None


class State(Spanned, frozen=True):
    """A state, of a `kind`; `id` is '' where it has none. `initial` is what is entered with it, `final` what the CDSL
    names as the one that ends it. A history's `initial` is what it stands for before anything is remembered. `number`
    tells it from all others of its machine: its place in the document's order, with the root as 0."""

    id: str
    kind: str = STATE
    states: tuple[State, ...] = ()
    transitions: tuple[Transition, ...] = ()
    initial: Transition | None = None
    final: Text | None = None
    deep: bool = False
    entry: tuple[Block, ...] = ()
    exit: tuple[Block, ...] = ()
    data: tuple[Data, ...] = ()
    invokes: tuple[Invoke, ...] = ()
    done: Payload = Payload()
    doc: str = ""
    number: int = 0


class StateMachine(Spanned, frozen=True):
    """`root` holds the states. `events` are those that the component's code is said to fire; empty: any. `inline` where
    the machine stands in the CDSL, the document at `path`; `strays` are then names under `transitions:` that no state
    has."""

    name: str
    path: str
    root: State
    datamodel: str = ""
    late: bool = False
    scripts: Block = ()
    events: tuple[Text, ...] = ()
    inline: bool = False
    strays: tuple[Text, ...] = ()
    datamodel_span: Span = Span("")

    @property
    def states(self) -> Iterator[State]:
        """All states in the document's order, without the root."""
        yield from walk(self.root.states)


def numbered(root: State) -> State:
    """A whole tree of states with their numbers."""
    numbers = count()

    def with_number(state: State) -> State:
        own = next(numbers)
        return replace(state, number=own, states=tuple(with_number(child) for child in state.states))

    return with_number(root)


def walk(states: tuple[State, ...]) -> Iterator[State]:
    for state in states:
        yield state
        yield from walk(state.states)


def blocks(state: State) -> Iterator[Block]:
    """Every block of actions of a state, not of those in it."""
    yield from state.entry
    yield from state.exit
    for transition in (*state.transitions, *((state.initial,) if state.initial else ())):
        yield transition.actions
    for invoke in state.invokes:
        yield invoke.finalize or ()


def actions(block: Block) -> Iterator[Action]:
    """The actions of a block with those inside of them."""
    for action in block:
        yield action
        if isinstance(action, If):
            for _, inner in action.branches:
                yield from actions(inner)
        elif isinstance(action, Foreach):
            yield from actions(action.actions)
