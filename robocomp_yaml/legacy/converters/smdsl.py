"""Convert SMDSL to SCXML.

Blocks are nested by the names of states: a block's parent may be any state of the file, in any order.
"""

from __future__ import annotations

import msgspec
from lark import Token, Tree

from robocomp_yaml.digraph import reachable
from robocomp_yaml.emit.xml_text import HEAD, comment, element
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import MachineDraft, Reader
from robocomp_yaml.legacy.grammar import token, trees

NAMESPACE = "http://www.w3.org/2005/07/scxml"


class ScxmlState(msgspec.Struct, eq=False):
    """A state to write. `transitions` are the names of target states, with comments."""

    name: str
    final: bool = False
    parallel: bool = False
    initial: str = ""
    states: list[ScxmlState] = []
    transitions: list[tuple[str, Notes]] = []
    notes: Notes = msgspec.field(default_factory=Notes)


class _Block(msgspec.Struct, eq=False):
    """A machine, or the states inside of the state `name`."""

    tree: Tree[Token]
    name: str
    parallel: bool
    initial: str = ""
    final: str = ""
    states: list[ScxmlState] = []


def convert(reader: Reader) -> MachineDraft | None:
    """Return the SCXML of a file's machine."""
    return _SmdslConverter(reader).draft(reader.tree)


class _SmdslConverter:
    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.known: dict[str, ScxmlState] = {}
        self.joined: set[tuple[str, str]] = set()  # by a transition

    def draft(self, tree: Tree[Token]) -> MachineDraft:
        reader = self.reader
        top = self._block(trees(tree, "machine")[0])
        inner = [self._block(block) for block in trees(tree, "submachine")]
        filled: set[str] = set()
        for block in inner:
            self._nest(block, filled)
        self._cycles(top, inner)
        for block in (top, *inner):
            self._transitions(block)
        around = reader.placed.around
        notes = reader.notes(top.tree)
        attributes = {"xmlns": NAMESPACE, "version": "1.0", "name": top.name, "initial": top.initial}
        machine = element("scxml", attributes, [line for state in top.states for line in _state_lines(state)])
        above = [*comment([*around.head, *notes.head]), *comment(notes.tail)]
        return MachineDraft(HEAD + "\n".join([*above, *machine, *comment([*notes.foot, *around.foot])]) + "\n")

    def _block(self, tree: Tree[Token]) -> _Block:
        block = _Block(tree, self.reader.name(tree), token(tree, "PARALLEL") is not None)
        for clause in trees(tree, "initial_state", "end_state"):
            which = "initial" if clause.data == "initial_state" else "final"
            if getattr(block, which):
                self._refused("refused_two", clause, str(clause.data))
            setattr(block, which, self.reader.name(trees(clause, "name")[0]))
        listed: dict[str, Tree[Token]] = {}
        for clause in trees(tree, "states"):
            self._comments_to(self.reader.notes(clause), self.reader.notes(tree))
            for item in trees(clause, "name"):
                name = self.reader.name(item)
                if name in (block.initial, block.final):
                    self.reader.repaired("lenient_listed", item, name)
                elif name in listed:
                    self.reader.repaired("lenient_state_twice", item, name)
                else:
                    listed[name] = item
        ends: dict[str, Tree[Token]] = {}
        for clause in trees(tree, "initial_state", "end_state"):
            item = trees(clause, "name")[0]
            self._comments_to(self.reader.notes(clause), self.reader.notes(item))
            ends[self.reader.name(item)] = item
        names = dict.fromkeys([block.initial, *listed, block.final])
        places = {**listed, **ends}
        for name in filter(None, names):
            self._declare(block, name, places[name])
        if not block.states:
            self._refused("refused_empty", tree, block.name)
        elif not block.parallel and not block.initial:
            self._refused("refused_no_initial", tree, block.name)
        if block.parallel and ends:
            for name, item in ends.items():
                self.reader.repaired("lenient_in_parallel", item, name)
            for state in block.states:
                state.final = False
            block.initial = ""
        return block

    def _declare(self, block: _Block, name: str, item: Tree[Token]) -> None:
        if name in self.known:
            self._refused("refused_twice", item, name)
            return
        state = ScxmlState(name, final=name == block.final and name != block.initial, notes=self.reader.notes(item))
        self.known[name] = state
        block.states.append(state)

    def _nest(self, block: _Block, filled: set[str]) -> None:
        parent = self.known.get(block.name)
        if parent is None:
            self._refused("refused_parent", block.tree, block.name)
        elif block.name in filled:
            self._refused("refused_second_block", block.tree, block.name)
        elif parent.final:
            self._refused("refused_in_end", block.tree, block.name)
        else:
            filled.add(block.name)
            parent.states, parent.initial, parent.parallel = block.states, block.initial, block.parallel
            self._comments_to(self.reader.notes(block.tree), parent.notes)

    def _cycles(self, top: _Block, inner: list[_Block]) -> None:
        """Report states that are nested only in themselves."""
        placed = reachable(top.states, lambda state: state.states)
        for block in inner:
            parent = self.known.get(block.name)
            if parent is not None and parent not in placed:
                self._refused("refused_circle", block.tree, block.name)

    def _transitions(self, block: _Block) -> None:
        for clause in trees(block.tree, "transitions", "lenient_transition"):
            self._comments_to(self.reader.notes(clause), self.reader.notes(block.tree))
            for transition in trees(clause, "transition"):
                self._transition(transition)

    def _transition(self, tree: Tree[Token]) -> None:
        source, *targets = trees(tree, "name")
        state = self._known(source)
        notes = self.reader.notes(tree)
        for target in targets:
            name = self.reader.name(target)
            target_state = self._known(target)
            if state is None or target_state is None:
                continue
            if state.final:
                self.reader.lost("lost_transition", tree, state.name)
            elif (state.name, name) in self.joined:
                self.reader.repaired("lenient_transition_twice", target, name)
                state.transitions[-1][1].add(notes)
            else:
                self.joined.add((state.name, name))
                state.transitions.append((name, notes))
                self._comments_to(self.reader.notes(target), notes)
            notes = Notes()

    def _known(self, item: Tree[Token]) -> ScxmlState | None:
        name = self.reader.name(item)
        if name not in self.known:
            self._refused("refused_undeclared", item, name)
        return self.known.get(name)

    def _comments_to(self, notes: Notes, other: Notes) -> None:
        """Move comments to another construct."""
        other.head += [*notes.head, *notes.tail]
        other.foot += notes.foot

    def _refused(self, refusal: str, at: Tree[Token], text: str) -> None:
        self.reader.refused(refusal, token(at, "NAME") or at, text)


def _state_lines(state: ScxmlState) -> list[str]:
    name = "final" if state.final else "parallel" if state.parallel else "state"
    attributes = {"id": state.name, **({"initial": state.initial} if state.initial else {})}
    inside: list[str] = []
    for target, notes in state.transitions:
        transition = {"event": f"t_{state.name}_to_{target}", "target": target}
        inside += [*comment([*notes.head, *notes.tail]), *element("transition", transition), *comment(notes.foot)]
    inside += [line for child in state.states for line in _state_lines(child)]
    inside += comment(state.notes.foot)
    return [*comment([*state.notes.head, *state.notes.tail]), *element(name, attributes, inside)]
