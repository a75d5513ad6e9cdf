"""State machines: where transitions go, and what states, events, guards and actions are called, in code too."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import meaning, suggest
from robocomp_yaml.languages import with_capability
from robocomp_yaml.languages.record import STATEMACHINE, TargetLanguage
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.model import machine_names as names
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import MANY, MachineIndex
from robocomp_yaml.model.statemachine import FINAL, HISTORY, PARALLEL, State, StateMachine, Transition

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_EVENT = re.compile(r"(?!__)[A-Za-z_][A-Za-z0-9_-]*(\.[A-Za-z0-9_-]+)*")
_WORKERS = frozenset(
    "communicator compute events getPeriod initialize killYourSelf log mutex self setPeriod statemachine worker".split()
)


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        if linked.machine is not None:
            yield from _of(linked.machine, is_invoked=False)
            yield from _events(linked.machine)
            more = program.plugins_of(linked.component.path).languages
            yield from _in_code(linked, linked.machine, with_capability(STATEMACHINE, more))


def _of(machine: StateMachine, is_invoked: bool) -> Iterator[Diagnostic]:
    index = MachineIndex(machine)
    if not any(state.kind != HISTORY for state in machine.root.states):
        yield codes.NO_STATE.at(machine.span)
        return
    yield from _names(index, is_invoked)
    yield from _strays(index)
    for state in index.states:
        yield from _kind(index, state)
        yield from _initial(index, state)
        yield from _final(index, state)
    for _, transition in index.transitions():
        yield from _targets(index, transition)
    for invoked in index.invoked():
        yield from _of(invoked, is_invoked=True)


def _names(index: MachineIndex, is_invoked: bool) -> Iterator[Diagnostic]:
    for state in index.machine.states:
        first = index.by_id.get(state.id, state)
        if first is not state:
            yield codes.DUPLICATE_STATE.at(state.span, id=state.id, related=[Related("the first one", first.span)])
        elif state.id and not is_invoked and not _NAME.fullmatch(state.id):
            mended = re.sub(r"\W", "_", state.id, flags=re.ASCII)
            hint = f"call it '{mended}'" if _NAME.fullmatch(mended) else ""
            yield codes.STATE_NAME.at(state.span, id=state.id, hint=hint)


def _unknown(index: MachineIndex, name: Text, inside: State | None = None) -> Diagnostic:
    hint = index.similar(name.text, inside)
    if not hint and index.machine.inline:
        hint = Hint("write it under `states:`" + (", or one that stands there" if inside is not None else ""))
    return codes.UNKNOWN_STATE.at(name.span, id=name.text, hint=hint)


def _strays(index: MachineIndex) -> Iterator[Diagnostic]:
    """Where no states are listed, a start that no transition knows may itself be the name that is misspelled."""
    strays, start = index.machine.strays, index.machine.root.initial
    meant = None
    if start is not None and strays and not any(state.transitions for state in index.machine.states):
        name = start.targets[0]
        meant = suggest(name.text, [stray.text for stray in strays[:MANY]])
        if meant:
            yield codes.UNKNOWN_STATE.at(name.span, id=name.text, hint=meaning(name.text, meant))
    for stray in strays:
        if stray.text != meant:
            yield _unknown(index, stray)


def _kind(index: MachineIndex, state: State) -> Iterator[Diagnostic]:
    """What a final state and a history may have; SCXML's shape says this for documents of its own."""
    lists: dict[str, tuple[Any, ...]] = {
        "states": state.states, "transitions": state.transitions, "entry or exit actions": state.entry or state.exit
    }  # fmt: skip
    if state.kind == FINAL:
        for what in ("states", "transitions"):
            if lists[what]:
                place = lists[what][0].span
                yield codes.FINAL_LEFT.at(place, id=state.id, what=what)
    if state.kind == HISTORY:
        for what, found in lists.items():
            if found and what != "transitions":  # those of a history are counted in `order`
                place = found[0].span if what == "states" else found[0][0].span
                yield codes.INLINE_HISTORY.at(place, what=what)
        if index.parent(state) is index.machine.root:
            yield codes.NO_PARENT.at(state.span)


def _initial(index: MachineIndex, state: State) -> Iterator[Diagnostic]:
    """The initial state is there and stands inside; a history may also lead to a state beside it."""
    what = _shown(state)
    children = [child for child in state.states if child.kind != HISTORY]
    home = (index.parent(state) if state.kind == HISTORY else None) or state
    if state.initial is not None:
        yield from _targets(index, state.initial, home)
        for target in state.initial.targets:
            found = index.by_id.get(target.text)
            if found is not None and home not in index.ancestors(found):
                yield codes.INITIAL_OUTSIDE.at(target.span, id=target.text, what=_shown(home))
    elif state.kind == HISTORY:
        if index.machine.inline:
            yield codes.NO_INITIAL.at(
                state.span,
                what=f"the history '{state.id}'",
                hint=f"write transitions: {{{state.id}: …}}, for when there is nothing to remember yet",
            )
    elif state.kind not in (PARALLEL, FINAL) and children:
        names = [child.id for child in children if child.id]
        if index.machine.inline:
            yield codes.NO_INITIAL.at(state.span, what=what, hint=f"write initial: {names[0]}" if names else "")
        elif len(children) > 1:
            hint = f'write initial="{names[0]}"' if names and children[0].id else ""
            yield codes.IMPLICIT_INITIAL.at(state.span, what=what, first=children[0].id, hint=hint)


def _shown(state: State) -> str:
    return f"the state '{state.id}'" if state.id else "the machine"


def _final(index: MachineIndex, state: State) -> Iterator[Diagnostic]:
    """What `final:` names is one of the states directly in it."""
    if state.final is None:
        return
    found = index.by_id.get(state.final.text)
    if found is None:
        yield _unknown(index, state.final, state)
    elif index.parent(found) is not state:
        yield codes.INITIAL_OUTSIDE.at(state.final.span, id=found.id, what=_shown(state))


def _targets(index: MachineIndex, transition: Transition, inside: State | None = None) -> Iterator[Diagnostic]:
    for target in transition.targets:
        if target.text not in index.by_id:
            yield _unknown(index, target, inside)
    found = index.targets(transition)
    for number, first in enumerate(found):
        for second in found[number + 1 :]:
            if not _together(index, first, second):
                place = next(target.span for target in transition.targets if target.text == second.id)
                yield codes.NOT_TOGETHER.at(place, first=first.id, second=second.id)
                return


def _together(index: MachineIndex, first: State, second: State) -> bool:
    """Whether both can be active: the nearest state around both is parallel."""
    if first is second:
        return True
    around = index.ancestors(first)
    nearest = next(state for state in [second, *index.ancestors(second)] if state in [first, *around])
    return nearest.kind == PARALLEL and nearest is not first and nearest is not second


def _events(machine: StateMachine) -> Iterator[Diagnostic]:
    """Names that are none; a transition's may end in `.*` or be `*`."""
    index = MachineIndex(machine)
    for _, transition in index.transitions():
        for event in transition.events:
            plain = event.text.removesuffix(".*").removesuffix(".")
            if event.text not in ("*", ".*") and not _EVENT.fullmatch(plain):
                yield codes.EVENT_NAME.at(event.span, event=event.text)
    for event in (*machine.events, *(event for event, _ in index.sends())):
        if not _EVENT.fullmatch(event.text):
            yield codes.EVENT_NAME.at(event.span, event=event.text)


def _in_code(linked: LinkedComponent, machine: StateMachine, known: list[TargetLanguage]) -> Iterator[Diagnostic]:
    taken = {named.name: named for named in _of_ports(linked)}
    guards, actions = names.guards(machine), names.actions(machine)
    reserved = _WORKERS.union(*(language.keywords for language in known))
    reserved |= linked.component.language.target.taken
    if linked.component.compatibility:
        reserved |= names.ROBOCOMP_NAMES
    for named in (*guards, *actions):
        is_own = named.kind == names.ACTION and named.name in names.CALLABLE
        if named.name in reserved and not is_own:
            yield codes.METHOD_NAME.at(named.text.span, name=named.name)
    handlers = [
        names.NamedPart(names.STATE, Text(state.id, span=state.span), name)
        for state in {state.id: state for state in names.states_with_handlers(machine)}.values()
        for name in (names.entry_handler(state.id), names.exit_handler(state.id), names.period_handler(state.id))
    ]
    for named in (*handlers, *guards, *actions):
        yield from _clash(named, taken)
    fired: dict[str, names.NamedPart] = {}
    for event in names.events(machine):
        yield from _clash(event, fired)


def _of_ports(linked: LinkedComponent) -> Iterator[names.NamedPart]:
    """What the worker has of interfaces."""
    for port in (*linked.implements, *linked.subscribes):
        for method in port.interface.methods:
            name = f"{port.interface.name}_{method.name}"
            yield names.NamedPart("the method", Text(name, span=port.use.span), name)
    for port in (*linked.requires, *linked.publishes):
        name = f"{port.name.lower()}_proxy"
        yield names.NamedPart("the proxy", Text(port.name, span=port.use.span), name)


def _clash(named: names.NamedPart, taken: dict[str, names.NamedPart]) -> Iterator[Diagnostic]:
    first = taken.setdefault(named.name, named)
    if first is not named:
        yield codes.SAME_IN_CODE.at(
            named.text.span,
            first=f"{first.kind} '{first.text}'",
            second=f"{named.kind} '{named.text}'",
            name=named.name,
            hint="give one of them another name",
            related=[Related(f"{first.kind} '{first.text}'", first.text.span)],
        )
