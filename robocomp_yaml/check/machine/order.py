"""State machines: what stands behind something that is always taken first, and what is said twice."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, Related
from robocomp_yaml.diag.fix import removal
from robocomp_yaml.link.program import Program
from robocomp_yaml.model import conditions
from robocomp_yaml.model.machine_index import MachineIndex, is_unconditional, prefixes
from robocomp_yaml.model.statemachine import HISTORY, PYTHON, State, StateMachine, Text, Transition
from robocomp_yaml.semantics.events import beginning

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
            yield from _dead(state, machine)
    for invoked in index.invoked():
        yield from _of(invoked)


def _listed_twice(machine: StateMachine) -> Iterator[Diagnostic]:
    first: dict[str, Text] = {}
    for event in machine.events:
        other = first.setdefault(event.text, event)
        if other is not event:
            related = [Related("it stands here first", other.span)] if other.span != event.span else []
            yield codes.EVENT_TWICE.at(
                event.span,
                event=event.text,
                hint="remove it, or name the other event that is meant",
                related=related,
                fixes=[removal(event.span, safe=False)],
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
    before all of them, so it takes nothing away. One that waits for nothing is asked before any event is handled."""
    certain: dict[str, _Taker] = {}  # by what is taken whatever else holds
    guarded: dict[tuple[str, object], _Taker] = {}
    restless = next((t for t in state.transitions if not t.events and is_unconditional(t, machine.datamodel)), None)
    for transition in state.transitions:
        is_certain = is_unconditional(transition, machine.datamodel)
        condition = _meaning(transition.condition)
        heads = {beginning(event.text): event for event in transition.events}
        if not transition.events:
            heads = {_AT_ONCE: Text("", transition.span)}
        for head, event in heads.items():
            wider = [_AT_ONCE, *(() if head == _AT_ONCE else prefixes(head))]
            first = next((certain[one] for one in wider if one in certain), None)
            first = first or next((guarded[one, condition] for one in wider if (one, condition) in guarded), None)
            if first is not None:
                yield _told(machine, state, _Taker(transition, event), first)
            elif restless is not None and head != _AT_ONCE:
                taker = _Taker(restless, Text("", restless.span))
                yield _told(machine, state, _Taker(transition, event), taker, "behind")
        for head, event in heads.items():
            if is_certain:
                certain.setdefault(head, _Taker(transition, event))
            elif machine.datamodel != PYTHON:  # Python's may say something else each time
                guarded.setdefault((head, condition), _Taker(transition, event))


def _meaning(condition: Text | None) -> object:
    """The same for `near` and `near()`, `not near` and `!near`."""
    try:
        return conditions.condition(condition.text) if condition else None
    except conditions.NotInLanguage:
        return condition


def _told(machine: StateMachine, state: State, dead: _Taker, first: _Taker, where: str = "before") -> Diagnostic:
    guard = "`if:`" if machine.inline else "`cond`"
    event, takes = dead.event, first.event
    is_guarded = not is_unconditional(first.transition, machine.datamodel)
    is_same = bool(takes.text) == bool(event.text) and beginning(takes.text) == beginning(event.text)
    if is_guarded:
        hint = "remove one of them, or give it another condition"
    elif takes.text and not is_same:
        hint = f"put it before the other one, or give that one {guard}"
    elif first.transition.condition is not None:
        hint = f"give the one {where} another condition, or remove one of them"
    else:
        hint = f"give the one {where} {guard}, or remove one of them"
    why = f"one {where} it " + (f"takes '{takes.text}'" if takes.text else "is taken at once")
    leads = " and ".join(f"'{target.text}'" for target in first.transition.targets)
    told = codes.DEAD_TRANSITION.at(
        event.span, state=f"'{state.id}'" if state.id else "the machine",
        when=f" for '{event.text}'" if event.text else "",
        why=f"{why} on the same condition" if is_guarded else why, hint=hint,
        related=[Related("this one is taken" + (f", and leads to {leads}" if leads else ""), takes.span)],
    )  # fmt: skip
    # SCXML takes it as legal, and tools draw such files: what is lost must be what somebody wrote for that very event.
    is_lost = is_same and not is_guarded and _effect(dead.transition) != _effect(first.transition)
    return told if machine.inline or is_lost else told.as_severity(WARNING)


def _effect(transition: Transition) -> object:
    return transition.targets, transition.internal, transition.actions
