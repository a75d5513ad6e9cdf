"""State machines: what stands behind something that is always taken first, and what is said twice."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, Related
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.machine_index import MachineIndex, plain, prefixes
from robocomp_yaml.model.statemachine import HISTORY, PYTHON, State, StateMachine, Text, Transition

_AT_ONCE = "an event"  # what a transition without events does not wait for


class _Taker(msgspec.Struct, frozen=True):
    """A transition with that of its events which leaves nothing to those behind it."""

    transition: Transition
    event: Text


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        if linked.machine is not None:
            yield from _listed_twice(linked.machine)
            yield from _of(linked.machine)


def _of(machine: StateMachine) -> Iterator[Diagnostic]:
    index = MachineIndex(machine)
    for state in index.states:
        if state.kind == HISTORY:
            yield from _history(state)
        else:
            for told in _dead(state, machine):
                # SCXML has it as legal as any other transition; drawn by a tool, it may be meant as a note.
                yield told if machine.inline else told.as_severity(WARNING)
    for invoked in index.invoked():
        yield from _of(invoked)


def _listed_twice(machine: StateMachine) -> Iterator[Diagnostic]:
    first: dict[str, Text] = {}
    for event in machine.events:
        other = first.setdefault(event.text, event)
        if other is not event:
            related = [Related("it stands here first", other.span)] if other.span != event.span else []
            yield codes.EVENT_TWICE.at(
                event.span, event=event.text, hint="remove it, or name the other event that is meant", related=related
            )


def _history(state: State) -> Iterator[Diagnostic]:
    """It has one transition, which nothing else decides about."""
    first = state.initial
    if first is not None and (first.events or first.condition):
        place = first.condition.span if first.condition else first.events[0].span
        yield codes.HISTORY_WAITS.at(place, id=state.id, hint="write only where it leads, and what is done on the way")
    for transition in state.transitions:
        yield codes.HISTORY_TWICE.at(transition.span, id=state.id, hint="leave one of them")


def _dead(state: State, machine: StateMachine) -> Iterator[Diagnostic]:
    """Of the transitions of a state the first that fits is taken, in the document's order. One of a state inside comes
    before all of them, so it takes nothing away."""
    certain: dict[str, _Taker] = {}  # by what is taken whatever else holds
    guarded: dict[tuple[str, str], _Taker] = {}
    for transition in state.transitions:
        condition = " ".join(transition.condition.text.split()) if transition.condition else ""
        heads = {plain(event.text): event for event in transition.events}
        if not transition.events:
            heads = {_AT_ONCE: Text("", transition.span)}
        for head, event in heads.items():
            wider = [_AT_ONCE, *(() if head == _AT_ONCE else prefixes(head))]
            first = next((certain[one] for one in wider if one in certain), None)
            first = first or next((guarded[one, condition] for one in wider if (one, condition) in guarded), None)
            if first is not None:
                yield _told(machine, state, event, first)
        for head, event in heads.items():
            if not condition:
                certain.setdefault(head, _Taker(transition, event))
            elif machine.datamodel != PYTHON:  # Python's may say something else each time
                guarded.setdefault((head, condition), _Taker(transition, event))


def _told(machine: StateMachine, state: State, event: Text, first: _Taker) -> Diagnostic:
    guard = "`if:`" if machine.inline else "`cond`"
    is_guarded = first.transition.condition is not None
    if is_guarded:
        hint = "remove one of them, or give it another condition"
    elif first.event.text and plain(first.event.text) != plain(event.text):
        hint = f"put it before the other one, or give that one {guard}"
    else:
        hint = f"give the one before {guard}, or remove one of them"
    why = f"takes '{first.event.text}'" if first.event.text else "is taken at once"
    where = " and ".join(f"'{target.text}'" for target in first.transition.targets)
    return codes.DEAD_TRANSITION.at(
        event.span, state=f"'{state.id}'" if state.id else "the machine",
        when=f" for '{event.text}'" if event.text else "",
        why=f"{why} on the same condition" if is_guarded else why, hint=hint,
        related=[Related("this one is taken" + (f", and leads to {where}" if where else ""), first.event.span)],
    )  # fmt: skip
