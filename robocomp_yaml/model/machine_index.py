"""Facts that follow from the tree of a state machine: parents, initial states, events that are sent."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.fix import NO_HINT, Hint
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.model import conditions
from robocomp_yaml.model import statemachine as model
from robocomp_yaml.model.located import Text

MANY = 500  # at most so many names are compared with a misspelled one, to stay fast


class MachineIndex(msgspec.Struct, frozen=True):
    """States are identified by their numbers, because an id may be missing or, in a machine with errors, be used twice.
    `parents` maps the number of each state to its parent."""

    machine: model.StateMachine
    by_id: dict[str, model.State] = {}
    parents: dict[int, model.State] = {}

    def __post_init__(self) -> None:
        for state in self.states:
            self.parents.update((child.number, state) for child in state.states)
            if state.id and state.number:
                self.by_id.setdefault(state.id, state)

    @property
    def states(self) -> Iterator[model.State]:
        """The root and all states, in the document's order."""
        yield self.machine.root
        yield from self.machine.states

    def parent(self, state: model.State) -> model.State | None:
        """The parent of a state; None for the root."""
        return self.parents.get(state.number)

    def similar(self, name: str, inside: model.State | None = None) -> Hint:
        """A hint at a state with a similar name, only among those in the state `inside` if it is set."""
        ids = [id_ for id_, state in self.by_id.items() if inside is None or inside in self.ancestors(state)]
        return did_you_mean(name, ids, open_=True) if len(ids) < MANY else NO_HINT

    def ancestors(self, state: model.State) -> list[model.State]:
        """From the parent to the root."""
        found = []
        parent = self.parent(state)
        while parent is not None:
            found.append(parent)
            parent = self.parent(parent)
        return found

    def targets(self, transition: model.Transition) -> list[model.State]:
        return [self.by_id[target.text] for target in transition.targets if target.text in self.by_id]

    def defaults(self, state: model.State) -> list[model.State]:
        """The states that are entered with a state by default."""
        children = [child for child in state.states if child.kind != model.HISTORY]
        if state.kind == model.PARALLEL:
            return children
        if state.initial is not None:
            return self.targets(state.initial)
        return children[:1]

    def transitions(self) -> Iterator[tuple[model.State, model.Transition]]:
        """Every transition with its state, but for the transitions of `initial`."""
        for state in self.states:
            for transition in state.transitions:
                yield state, transition

    def actions(self) -> Iterator[model.Action]:
        """Every action of the machine, without those of the machines that it invokes."""
        yield from model.actions(self.machine.scripts)
        for state in self.states:
            for block in model.blocks(state):
                yield from model.actions(block)

    def sends(self) -> Iterator[tuple[Text, bool]]:
        """The events that the machine raises or sends by name, and whether it sends them to itself."""
        for action in self.actions():
            if isinstance(action, model.Raise):
                yield action.event, True
            elif isinstance(action, model.Send) and action.event.literal:
                is_own = action.target.expr is None and action.target.literal in (None, "", "#_internal")
                yield Text(action.event.literal, span=action.event.span), is_own

    def invokes(self) -> Iterator[model.Invoke]:
        for state in self.states:
            yield from state.invokes

    def invoked(self) -> Iterator[model.StateMachine]:
        """The machines that the machine invokes, if the document contains them."""
        for invoke in self.invokes():
            for value in (invoke.source, invoke.payload.content):
                if value is not None and value.machine is not None:
                    yield value.machine

    def can_be_done(self, state: model.State) -> bool:
        """Whether the event `done.state.X` of the state can occur."""
        if state.kind == model.PARALLEL:
            children = [child for child in state.states if child.kind != model.HISTORY]
            return bool(children) and all(self.can_be_done(child) for child in children)
        return any(child.kind == model.FINAL for child in state.states)


def indexes(machine: model.StateMachine | None) -> Iterator[MachineIndex]:
    """The indexes of a machine, and of the machines that it invokes, directly or not."""
    if machine is not None:
        index = MachineIndex(machine)
        yield index
        for invoked in index.invoked():
            yield from indexes(invoked)


def is_unconditional(transition: model.Transition, datamodel: str) -> bool:
    """Whether the transition has no condition, or one that is always true."""
    if transition.condition is None:
        return True
    text = transition.condition.text.strip()
    if datamodel == model.PYTHON:
        return text == "True"
    try:
        return conditions.always(conditions.condition(text))
    except conditions.NullSyntaxError:
        return False


def prefixes(event: str) -> list[str]:
    """The descriptors that match an event: '' (for every event), `door` and `door.open` for `door.open`."""
    words = event.split(".")
    return ["", *(".".join(words[:number]) for number in range(1, len(words) + 1))]
