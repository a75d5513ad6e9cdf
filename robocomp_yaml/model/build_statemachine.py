"""Builds a `StateMachine` from `statemachine:` of a CDSL document. The tree fits the schema.

`initial:` and `final:` may name a state that `states:` does not list, if a transition names that state, or if there is
no `states:`. A transition without event and condition waits for the event `t_SOURCE_to_TARGET`, RoboComp's name for the
signal of such a transition.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model import statemachine as model
from robocomp_yaml.model.build_interface import as_text, doc, entries, span_of, text, texts
from robocomp_yaml.model.located import Text
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence


class _StateNames(msgspec.Struct):
    """The names of states in the whole document: `transitions` by the source state, `sources` with their locations, and
    the names `listed` under any `states:`."""

    transitions: dict[str, list[model.Transition]] = {}
    sources: dict[str, Text] = {}
    listed: set[str] = set()

    @property
    def in_transitions(self) -> set[str]:
        """The states that are source or target of a transition."""
        targets = {target.text for own in self.transitions.values() for each in own for target in each.targets}
        return targets | self.transitions.keys()


def build(node: Mapping, name: str, path: str) -> model.StateMachine:
    """Returns the machine under `statemachine:` of the component `name`; `path` is the document as opened."""
    names = _StateNames()
    _collect(node, names)
    root = model.numbered(_state("", node, model.STATE, node.span, names))
    known = {state.id for state in model.walk(root.states)}
    return model.StateMachine(
        name,
        path,
        root,
        events=tuple(texts(node, "events")),
        inline=True,
        strays=tuple(source for key, source in names.sources.items() if key not in known),
        span=node.span,
    )


def _collect(node: Node, names: _StateNames) -> None:
    """Collects all transitions by source state: a state's transitions may be at any level of the document."""
    for key, value in entries(node, "transitions"):
        names.sources.setdefault(key.lexeme, Text(key.lexeme, span=key.span))
        own = names.transitions.setdefault(key.lexeme, [])
        own += (_transition(key.lexeme, item) for item in _listed(value))
    for key, state in entries(node, "states"):
        names.listed.add(key.lexeme)
        _collect(state, names)


def _state(name: str, node: Node | None, kind: str, span: Span, names: _StateNames) -> model.State:
    initial, final = _text_at(node, "initial"), _text_at(node, "final")
    own = names.transitions.get(name, []) if name else []
    history = text(node, "history")
    if history:
        kind = model.HISTORY
    elif kind == model.STATE and _is_true(node, "parallel"):
        kind = model.PARALLEL
    entered = model.Transition(targets=(initial,), span=initial.span) if initial else None
    return model.State(
        id=name,
        kind=kind,
        states=tuple(_children(node, initial, final, names)),
        transitions=tuple(own[1:] if kind == model.HISTORY else own),
        initial=_default_of_history(name, own) if kind == model.HISTORY else entered,
        final=final,
        deep=history == "deep",
        entry=_blocks(node, "entry"),
        exit=_blocks(node, "exit"),
        doc=doc(node),
        span=span,
    )


def _children(node: Node | None, initial: Text | None, final: Text | None, names: _StateNames) -> Iterator[model.State]:
    """The listed states. `initial` and `final` that no `states:` lists are added before and after them, if a transition
    names them or nothing is listed; any other such name is a misspelled one."""
    listed = {key.lexeme: (key, value) for key, value in entries(node, "states")}
    unlisted = {end.text: end for end in (final, initial) if end}
    for name in list(unlisted):
        if name in names.listed or (listed and name not in names.in_transitions):
            del unlisted[name]
    last = final.text if final else ""
    if initial and initial.text in unlisted:
        yield _state(initial.text, None, model.FINAL if initial.text == last else model.STATE, initial.span, names)
    for name, (key, value) in listed.items():
        yield _state(name, value, model.FINAL if name == last else model.STATE, key.span, names)
    if final and final.text in unlisted and not (initial and initial.text == last):
        yield _state(last, None, model.FINAL, final.span, names)


def _default_of_history(name: str, own: list[model.Transition]) -> model.Transition | None:
    """Where a history leads as long as it remembers nothing: its first transition, without an implied event."""
    if not own:
        return None
    first = own[0]
    return replace(first, events=()) if [*first.events] == [_signal(name, to) for to in first.targets[:1]] else first


def _transition(source: str, node: Node) -> model.Transition:
    if isinstance(node, Scalar):
        target = Text(node.lexeme, span=node.span)
        return model.Transition((_signal(source, target),), targets=(target,), span=node.span)
    to = node.get("to")
    targets = tuple(filter(None, map(as_text, _listed(to)))) if to else ()
    condition = _text_at(node, "if")
    if node.get("event"):
        events = model.words(text(node, "event"), span_of(node, "event"))
    else:
        events = (_signal(source, targets[0]),) if condition is None and targets else ()
    return model.Transition(
        events,
        condition,
        targets,
        internal=_is_true(node, "internal"),
        actions=_actions(node.get("do")),
        span=node.span,
    )


def _signal(source: str, target: Text) -> Text:
    return Text(f"t_{source}_to_{target.text}", span=target.span)


def _text_at(node: Node | None, key: str) -> Text | None:
    return as_text(node.get(key)) if node else None


def _is_true(node: Node | None, key: str) -> bool:
    child = node.get(key) if node else None
    return child is not None and child.data is True


def _listed(node: Node) -> list[Node]:
    return node.items if isinstance(node, Sequence) else [node]


def _blocks(node: Node | None, key: str) -> tuple[model.Block, ...]:
    block = _actions(node.get(key)) if node else ()
    return (block,) if block else ()


def _actions(node: Node | None) -> model.Block:
    return tuple(_action(item) for item in _listed(node)) if node is not None else ()


def _action(node: Node) -> model.Action:
    """A method of the worker, or {raise: …}, {send: …, after: …}, {cancel: …}."""
    if isinstance(node, Scalar):
        return model.Script(Text(node.lexeme, span=node.span), span=node.span)
    if raised := _text_at(node, "raise"):
        return model.Raise(raised, span=node.span)
    if node.get("cancel"):
        return model.Cancel(model.Value(literal=text(node, "cancel")), span=node.span)
    after = text(node, "after", "0 ms").replace(" ", "")
    return model.Send(
        model.Value(literal=text(node, "send"), span=span_of(node, "send")), model.Value(), model.Value(),
        model.Value(literal=after if after[-1].isalpha() else f"{after}ms"), id=text(node, "id"), span=node.span,
    )  # fmt: skip
