"""State machines: targets of transitions, and names of states, events, guards and actions, also in code."""

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
from robocomp_yaml.model.machine_index import MANY, MachineIndex, indexes
from robocomp_yaml.model.statemachine import FINAL, HISTORY, PARALLEL, State, StateMachine, Transition

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_EVENT = re.compile(r"(?!__)[A-Za-z_][A-Za-z0-9_-]*(\.[A-Za-z0-9_-]+)*")
_WORKERS = frozenset(
    "communicator compute events getPeriod initialize killYourSelf log mutex self setPeriod statemachine worker".split()
)


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        if linked.machine is not None:
            for index in indexes(linked.machine):
                yield from _states(index, is_invoked=index.machine is not linked.machine)
            yield from _events(linked.machine)
            more = program.plugins_of(linked.component.path).languages
            yield from _in_code(linked, linked.machine, with_capability(STATEMACHINE, more))


def _states(index: MachineIndex, is_invoked: bool) -> Iterator[Diagnostic]:
    if all(state.kind == HISTORY for state in index.machine.root.states):
        yield codes.NO_STATE.at(index.machine.span)
        return
    yield from _names(index, is_invoked)
    yield from _strays(index)
    for state in index.states:
        yield from _kind(index, state)
        yield from _initial(index, state)
        yield from _final(index, state)
    for _, transition in index.transitions():
        yield from _targets(index, transition)


def _names(index: MachineIndex, is_invoked: bool) -> Iterator[Diagnostic]:
    for state in index.machine.states:
        first = index.by_id.get(state.id, state)
        if first is not state:
            yield codes.DUPLICATE_STATE.at(state.span, id=state.id, related=[Related("the first one", first.span)])
        elif state.id and not is_invoked and not _NAME.fullmatch(state.id):
            mended = re.sub(r"\W", "_", state.id, flags=re.ASCII)
            hint = f"rename it to '{mended}'" if _NAME.fullmatch(mended) else ""
            yield codes.STATE_NAME.at(state.span, id=state.id, hint=hint)


def _unknown(index: MachineIndex, name: Text, inside: State | None = None) -> Diagnostic:
    hint = index.similar(name.text, inside)
    if not hint and index.machine.inline:
        hint = Hint("add it under `states:`" + (", or name a state that is listed there" if inside is not None else ""))
    return codes.UNKNOWN_STATE.at(name.span, id=name.text, hint=hint)


def _strays(index: MachineIndex) -> Iterator[Diagnostic]:
    """Reports unknown names under `transitions:`. If no state is listed, `initial:` may be the misspelled name."""
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
    """Reports what a final state or a history cannot have. For SCXML files, `scxml_shape` does so."""
    lists: dict[str, tuple[Any, ...]] = {
        "states": state.states, "transitions": state.transitions, "entry or exit actions": state.entry or state.exit
    }  # fmt: skip
    if state.kind == FINAL:
        for what in ("states", "transitions"):
            if lists[what]:
                span = lists[what][0].span
                yield codes.FINAL_LEFT.at(span, id=state.id, what=what)
    if state.kind == HISTORY:
        for what, parts in lists.items():
            if parts and what != "transitions":  # `order` checks the transitions of a history
                span = parts[0].span if what == "states" else parts[0][0].span
                yield codes.INLINE_HISTORY.at(span, what=what)
        if index.parent(state) is index.machine.root:
            yield codes.NO_PARENT.at(state.span)


def _initial(index: MachineIndex, state: State) -> Iterator[Diagnostic]:
    """Checks the initial state: it is inside of the state or, for a history, inside of the parent."""
    what = _shown(state)
    children = [child for child in state.states if child.kind != HISTORY]
    scope = (index.parent(state) if state.kind == HISTORY else None) or state
    if state.initial is not None:
        yield from _targets(index, state.initial, scope)
        for target in state.initial.targets:
            initial = index.by_id.get(target.text)
            if initial is not None and scope not in index.ancestors(initial):
                yield codes.INITIAL_OUTSIDE.at(target.span, id=target.text, what=_shown(scope))
    elif state.kind == HISTORY:
        if index.machine.inline:
            yield codes.NO_INITIAL.at(
                state.span,
                what=f"the history '{state.id}'",
                hint=f"write transitions: {{{state.id}: …}}, for the first time, when it remembers nothing",
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
    """Checks that `final:` names a child of the state."""
    if state.final is None:
        return
    final = index.by_id.get(state.final.text)
    if final is None:
        yield _unknown(index, state.final, state)
    elif index.parent(final) is not state:
        yield codes.INITIAL_OUTSIDE.at(state.final.span, id=final.id, what=_shown(state))


def _targets(index: MachineIndex, transition: Transition, inside: State | None = None) -> Iterator[Diagnostic]:
    for target in transition.targets:
        if target.text not in index.by_id:
            yield _unknown(index, target, inside)
    targets = index.targets(transition)
    for number, first in enumerate(targets):
        for second in targets[number + 1 :]:
            if not _together(index, first, second):
                span = next(target.span for target in transition.targets if target.text == second.id)
                yield codes.NOT_TOGETHER.at(span, first=first.id, second=second.id)
                return


def _together(index: MachineIndex, first: State, second: State) -> bool:
    """Whether both states can be active: their nearest common ancestor is parallel."""
    if first is second:
        return True
    ancestors = [first, *index.ancestors(first)]
    nearest = next(state for state in [second, *index.ancestors(second)] if state in ancestors)
    return nearest.kind == PARALLEL and nearest is not first and nearest is not second


def _events(machine: StateMachine) -> Iterator[Diagnostic]:
    """Reports illegal names of events; a transition's event may also end in `.*` or be `*`."""
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
    """The names that a worker has because of its interfaces."""
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
            hint="rename one of them",
            related=[Related(f"{first.kind} '{first.text}'", first.text.span)],
        )
