"""State machines: unreachable states, endless circles, events that are lost or never sent."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import MANY, MachineIndex, indexes, is_unconditional, prefixes
from robocomp_yaml.model.statemachine import HISTORY, PARALLEL, Send, State, StateMachine, Transition
from robocomp_yaml.semantics.events import beginning

_PLATFORM = ("done.", "error", "*", ".*")


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        for index in indexes(linked.machine):
            if index.machine.root.states:
                yield from _unreachable(index)
                yield from _endless(index)
                yield from _unheard(index)
                yield from _never_sent(index)


def _unreachable(index: MachineIndex) -> Iterator[Diagnostic]:
    """Reports the outermost unreachable states. If a name is unknown, none is reported, because too many would be."""
    if index.machine.strays or any(
        target.text not in index.by_id
        for state in index.states
        for transition in (*state.transitions, *((state.initial,) if state.initial else ()))
        for target in transition.targets
    ):
        return
    targets = {target.number for _, transition in index.transitions() for target in index.targets(transition)}
    reached: set[int] = set()
    todo = [index.machine.root]
    while todo:
        state = todo.pop()
        if state.number in reached:
            continue
        reached.add(state.number)
        if state.kind == HISTORY:
            parent = index.ancestors(state)[0]
            todo += index.targets(state.initial) if state.initial else index.defaults(parent)
            continue
        ancestors = index.ancestors(state)
        todo += ancestors
        for parent in ancestors:
            if parent.kind == PARALLEL:
                todo += index.defaults(parent)
        if state.number in targets or not any(child.number in reached for child in state.states):
            todo += index.defaults(state)  # it may be entered by itself, not only with a state inside
        for transition in state.transitions:
            todo += index.targets(transition)
    for state in index.machine.states:
        is_unreachable = state.number not in reached
        if (
            is_unreachable
            and state.kind != HISTORY
            and all(one.number in reached for one in index.ancestors(state)[:1])
        ):
            yield codes.UNREACHABLE.at(state.span, id=state.id or "(without a name)")


def _endless(index: MachineIndex) -> Iterator[Diagnostic]:
    """Reports circles of transitions that are taken at once."""
    seen: set[int] = set()
    for start in index.machine.states:
        path: dict[int, State] = {}
        state: State | None = start
        while state is not None and state.number not in seen:
            seen.add(state.number)
            path[state.number] = state
            state = _at_once(index, state)
        if state is not None and state.number in path:
            members = list(path.values())
            circle = members[list(path).index(state.number) :]
            span = next(t.span for s in [state, *index.ancestors(state)] for t in s.transitions if not t.events)
            names = " → ".join(member.id or "(without a name)" for member in (*circle, state))
            yield codes.ENDLESS.at(span, circle=names, hint="give one of the transitions an event or a condition")


def _at_once(index: MachineIndex, state: State) -> State | None:
    """The state to which the machine always goes on at once; None if there is none, or if it depends."""
    while state.states:
        inner = index.defaults(state)
        if state.kind == PARALLEL or len(inner) != 1 or inner[0].kind == HISTORY:
            return None
        state = inner[0]
    ancestors = [state, *index.ancestors(state)]
    if any(ancestor.kind == PARALLEL for ancestor in ancestors):
        return None
    transition = next((t for source in ancestors for t in source.transitions if not t.events), None)
    if transition is None or not is_unconditional(transition, index.machine.datamodel):
        return None
    targets = index.targets(transition) if transition.targets else [state]
    return targets[0] if len(targets) == 1 and targets[0].kind != HISTORY else None


def _sent(machine: StateMachine) -> tuple[list[Text], bool]:
    """The events that a machine and its invoked machines raise or send, and whether these are all."""
    events: list[Text] = []
    complete = True
    for index in indexes(machine):
        events += (event for event, _ in index.sends())
        complete &= not any(isinstance(action, Send) and action.event.expr for action in index.actions())
        complete &= all(invoke.source.expr is None for invoke in index.invokes())
    return events, complete


def _unheard(index: MachineIndex) -> Iterator[Diagnostic]:
    """Reports events that the machine sends to itself and no transition waits for."""
    heard = [event.text for _, transition in index.transitions() for event in transition.events]
    known = {beginning(descriptor) for descriptor in heard}
    named = [descriptor for descriptor in known if descriptor and not descriptor.startswith(_PLATFORM)]
    for event, is_own in index.sends():
        if is_own and known.isdisjoint(prefixes(event.text)):
            hint = did_you_mean(event.text, sorted(named)[:MANY], open_=True)
            yield codes.UNHEARD.at(event.span, event=event.text, hint=hint)


def _never_sent(index: MachineIndex) -> Iterator[Diagnostic]:
    sent, complete = _sent(index.machine)
    fired = [event.text for event in index.machine.events]
    known = [*fired, *(event.text for event in sent)]
    heads = {prefix for event in known for prefix in prefixes(event)}
    listed = "`events:`" if index.machine.inline else "`rc:events`"
    for state, transition in index.transitions():
        signals = {f"t_{state.id}_to_{target.text}" for target in transition.targets}  # RoboComp's code fires these
        for event in transition.events:
            if event.text in signals:
                continue
            if event.text.startswith(_PLATFORM):
                yield from _platform(index, transition, event)
            elif fired and complete and beginning(event.text) not in heads:
                hint = did_you_mean(
                    event.text,
                    known[:MANY],
                    open_=True,
                    otherwise=f"list it under {listed}, if the component's code fires it",
                )
                yield codes.NEVER_SENT.at(event.span, event=event.text, why="", hint=hint)


def _platform(index: MachineIndex, transition: Transition, event: Text) -> Iterator[Diagnostic]:
    kind, _, rest = event.text.removesuffix(".*").partition(".")
    what, _, name = rest.partition(".")
    if kind != "done" or not name:
        return
    if what == "state":
        state = index.by_id.get(name)
        if state is None:
            why = f": unknown state '{name}'"
            yield codes.NEVER_SENT.at(event.span, event=event.text, why=why, hint=index.similar(name))
        elif not index.can_be_done(state):
            why = f": '{name}' has no final state in " + ("each of its parts" if state.kind == PARALLEL else "it")
            yield codes.NEVER_SENT.at(event.span, event=event.text, why=why)
    elif what == "invoke":
        if all(invoke.id and name not in prefixes(invoke.id) for invoke in index.invokes()):
            yield codes.NEVER_SENT.at(event.span, event=event.text, why=": no invocation has this id")
