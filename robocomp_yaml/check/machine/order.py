"""State machines: transitions that are never taken, because another one always is, and repetitions."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.check import repeated
from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, Related
from robocomp_yaml.diag.fix import removal
from robocomp_yaml.link.program import Program
from robocomp_yaml.model import conditions
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import indexes, is_unconditional, prefixes
from robocomp_yaml.model.statemachine import HISTORY, PYTHON, State, StateMachine, Transition
from robocomp_yaml.semantics.events import beginning

_AT_ONCE = "an event"  # stands for the event of a transition without events


class _Claim(msgspec.Struct, frozen=True):
    """A transition that takes an event from all later transitions."""

    transition: Transition
    event: Text


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        if linked.machine is not None:
            yield from _listed_twice(linked.machine)
        for index in indexes(linked.machine):
            for state in index.states:
                yield from _history(state) if state.kind == HISTORY else _dead(state, index.machine)


def _listed_twice(machine: StateMachine) -> Iterator[Diagnostic]:
    for other, event in repeated(machine.events, lambda event: event.text):
        yield codes.EVENT_TWICE.at(
            event.span,
            event=event.text,
            hint="remove it, or correct the name",
            related=[Related("the first one", other.span)] if other.span != event.span else [],
            fixes=[removal(event.span, safe=False)],
        )


def _history(state: State) -> Iterator[Diagnostic]:
    """Reports events, conditions and further transitions of a history, which has one plain transition."""
    first = state.initial
    if first is not None and (first.events or first.condition):
        span = first.condition.span if first.condition else first.events[0].span
        yield codes.HISTORY_WAITS.at(span, id=state.id, hint="write only its target and its actions")
    for transition in state.transitions:
        yield codes.HISTORY_TWICE.at(transition.span, id=state.id, hint="keep one of them")


def _dead(state: State, machine: StateMachine) -> Iterator[Diagnostic]:
    """Reports transitions that are never taken. Of a state's transitions, SCXML takes the first that matches, in the
    order of the document; those without an event come before all events. Transitions of inner states are not
    compared."""
    certain: dict[str, _Claim] = {}  # by event, without a condition
    guarded: dict[tuple[str, object], _Claim] = {}
    eventless = next((t for t in state.transitions if not t.events and is_unconditional(t, machine.datamodel)), None)
    for transition in state.transitions:
        is_certain = is_unconditional(transition, machine.datamodel)
        condition = _meaning(transition.condition)
        heads = {beginning(event.text): event for event in transition.events}
        if not transition.events:
            heads = {_AT_ONCE: Text("", span=transition.span)}
        for head, event in heads.items():
            wider = [_AT_ONCE, *(() if head == _AT_ONCE else prefixes(head))]
            first = next((certain[one] for one in wider if one in certain), None)
            first = first or next((guarded[one, condition] for one in wider if (one, condition) in guarded), None)
            if first is not None:
                yield _never_taken(machine, state, _Claim(transition, event), first)
            elif eventless is not None and head != _AT_ONCE:
                claim = _Claim(eventless, Text("", span=eventless.span))
                yield _never_taken(machine, state, _Claim(transition, event), claim, "later")
        for head, event in heads.items():
            if is_certain:
                certain.setdefault(head, _Claim(transition, event))
            elif machine.datamodel != PYTHON:  # a condition in Python may change its result
                guarded.setdefault((head, condition), _Claim(transition, event))


def _meaning(condition: Text | None) -> object:
    """A value that is equal for equal conditions, such as `near` and `near()`, or `not near` and `!near`."""
    try:
        return conditions.condition(condition.text) if condition else None
    except conditions.NullSyntaxError:
        return condition


def _never_taken(
    machine: StateMachine, state: State, dead: _Claim, first: _Claim, which: str = "earlier"
) -> Diagnostic:  # fmt: skip
    guard = "`if:`" if machine.inline else "`cond`"
    event, takes = dead.event, first.event
    is_guarded = not is_unconditional(first.transition, machine.datamodel)
    is_same = bool(takes.text) == bool(event.text) and beginning(takes.text) == beginning(event.text)
    if is_guarded:
        hint = "remove one of them, or change its condition"
    elif takes.text and not is_same:
        hint = f"move it before the other one, or add {guard} to that one"
    elif first.transition.condition is not None:
        hint = f"change the condition of the {which} one, or remove one of them"
    else:
        hint = f"add {guard} to the {which} one, or remove one of them"
    why = f"{'an' if which == 'earlier' else 'a'} {which} one "
    why += f"takes '{takes.text}'" if takes.text else "is taken at once"
    leads = " and ".join(f"'{target.text}'" for target in first.transition.targets)
    fault = codes.DEAD_TRANSITION.at(
        event.span, state=f"'{state.id}'" if state.id else "the machine",
        when=f" for '{event.text}'" if event.text else "",
        why=f"{why} under the same condition" if is_guarded else why, hint=hint,
        related=[Related("this one is taken" + (f", and leads to {leads}" if leads else ""), takes.span)],
    )  # fmt: skip
    # SCXML allows this, and editors write such files. It is an error only if a transition for the same event is lost.
    is_lost = is_same and not is_guarded and _effect(dead.transition) != _effect(first.transition)
    return fault if machine.inline or is_lost else fault.as_severity(WARNING)


def _effect(transition: Transition) -> object:
    return transition.targets, transition.internal, transition.actions
