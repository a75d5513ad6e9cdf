"""SMDSL to SCXML.

Blocks are put together by the names of states: a block's parent may be any state of the file, in whatever order.
"""

from __future__ import annotations

import msgspec
from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.digraph import reachable
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import MachineDraft, Reader
from robocomp_yaml.legacy.grammar import token, trees
from robocomp_yaml.legacy.scxmltext import ScxmlState, document


class _Block(msgspec.Struct, eq=False):
    """A machine, or what stands inside of the state `name`."""

    tree: Tree[Token]
    name: str
    parallel: bool
    initial: str = ""
    final: str = ""
    states: list[ScxmlState] = []


def convert(reader: Reader) -> MachineDraft | None:
    """The document of a file's machine."""
    tree = reader.tree
    return _Converter(reader).draft(tree)


class _Converter:
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
            self._place(block, filled)
        self._circles(top, inner)
        for block in (top, *inner):
            self._transitions(block)
        around = reader.placed.around
        notes = reader.notes(top.tree)
        text = document(top.name, top.initial, top.states, Notes([*around.head, *notes.head], notes.tail, [
            *notes.foot, *around.foot,
        ]))  # fmt: skip
        return MachineDraft(text)

    def _block(self, tree: Tree[Token]) -> _Block:
        block = _Block(tree, self.reader.name(tree), token(tree, "PARALLEL") is not None)
        for clause in trees(tree, "initial_state", "end_state"):
            self._end(block, clause)
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

    def _end(self, block: _Block, clause: Tree[Token]) -> None:
        name = self.reader.name(trees(clause, "name")[0])
        which = "initial" if clause.data == "initial_state" else "final"
        if getattr(block, which):
            self._refused("refused_two", clause, str(clause.data))
        setattr(block, which, name)

    def _declare(self, block: _Block, name: str, item: Tree[Token]) -> None:
        if name in self.known:
            self._refused("refused_twice", item, name)
            return
        state = ScxmlState(name, final=name == block.final and name != block.initial, notes=self.reader.notes(item))
        self.known[name] = state
        block.states.append(state)

    def _place(self, block: _Block, filled: set[str]) -> None:
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

    def _circles(self, top: _Block, inner: list[_Block]) -> None:
        """Every state is somewhere in the machine, not only in itself."""
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
            found = self._known(target)
            if state is None or found is None:
                continue
            if state.final:
                what = self.reader.rules.losses["lost_transition"].format(text=state.name)
                self.reader.diagnostics.append(codes.LOST.at(self.reader.span(tree), what=what))
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
        """Comments of what has no place of its own go to what is around it."""
        other.head += [*notes.head, *notes.tail]
        other.foot += notes.foot

    def _refused(self, refusal: str, at: Tree[Token], text: str) -> None:
        place = token(at, "NAME") or at
        reason = self.reader.rules.refusals[refusal].format(text=text)
        self.reader.diagnostics.append(codes.REFUSED.at(self.reader.span(place), reason=reason))
