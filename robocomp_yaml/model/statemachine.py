"""The model of a state machine, as SCXML defines it (https://www.w3.org/TR/scxml/): from an SCXML file or a CDSL.

Expressions are kept as spelled, because their meaning depends on the data model. With `null`, which every language
has, they are what `conditions` parses. With `python` they are Python, which the component runs.
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
    """The words of a text with the span `span`. Each word has its own span, unless the text has escapes or more than
    one line."""
    quotes = span.end_column - span.column - len(text)
    is_plain = span.line == span.end_line and quotes in (0, 2)
    start = span.column + quotes // 2

    def span_of(word: re.Match[str]) -> Span:
        return replace(span, column=start + word.start(), end_column=start + word.end()) if is_plain else span

    return tuple(Text(word[0], span=span_of(word)) for word in re.finditer(r"\S+", text))


class Value(Spanned, frozen=True):
    """A value: an expression, a literal, or a whole `machine`."""

    expr: Text | None = None
    literal: str | None = None
    machine: StateMachine | None = None


class Param(Spanned, frozen=True):
    """A named value of an event or of an invocation."""

    name: str
    value: Value


class Payload(msgspec.Struct, frozen=True):
    """The data of an event or invocation: named values, or one content."""

    params: tuple[Param, ...] = ()
    content: Value | None = None


class Raise(Spanned, frozen=True):
    event: Text


class Send(Spanned, frozen=True):
    """`delay` is as spelled: `100ms`, `1.5s`."""

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
    """Code in the language of the data model; with `null`, names of actions."""

    code: Text


class If(Spanned, frozen=True):
    """Conditions with their actions; the last branch may have no condition."""

    branches: tuple[tuple[Text | None, Block], ...]


class Foreach(Spanned, frozen=True):
    array: Text
    item: Text
    index: Text | None
    actions: Block


Action = Raise | Send | Cancel | Log | Assign | Script | If | Foreach
Block = tuple[Action, ...]


class Transition(Spanned, frozen=True):
    """Without `events`, the transition is taken as soon as its condition holds; without `targets`, the state is not
    left."""

    events: tuple[Text, ...] = ()
    condition: Text | None = None
    targets: tuple[Text, ...] = ()
    internal: bool = False
    actions: Block = ()


class Data(Spanned, frozen=True):
    id: Text
    value: Value


class Invoke(Spanned, frozen=True):
    """An invoked machine, which runs while its state is active."""

    type: Value
    source: Value
    id: str = ""
    id_location: Text | None = None
    payload: Payload = Payload()
    autoforward: bool = False
    finalize: Block | None = None


class State(Spanned, frozen=True):
    """A state; `id` is '' if it has none. `initial` leads to the states that are entered by default, or, for a history,
    to those that are entered as long as it remembers nothing. `final` is the state that `final:` of the CDSL names.
    `number` identifies the state in its machine: its position in the document's order, with the root as 0."""

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
    """`root` contains the states. `events` are those that the component's code fires; empty means any. `inline` holds
    if the machine is written in the CDSL; then `strays` are the names under `transitions:` that no state has. `path` is
    the document with the machine."""

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
        """All states in the order of the document, without the root."""
        yield from walk(self.root.states)


def numbered(root: State) -> State:
    """The same tree with numbered states."""
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
    """Every block of actions of a state, without those of the states inside."""
    yield from state.entry
    yield from state.exit
    for transition in (*state.transitions, *((state.initial,) if state.initial else ())):
        yield transition.actions
    for invoke in state.invokes:
        yield invoke.finalize or ()


def actions(block: Block) -> Iterator[Action]:
    """The actions of a block, and those inside of them."""
    for action in block:
        yield action
        if isinstance(action, If):
            for _, inner in action.branches:
                yield from actions(inner)
        elif isinstance(action, Foreach):
            yield from actions(action.actions)
