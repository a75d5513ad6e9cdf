"""The CDSL's inline state machine as a `StateMachine`. The tree has the schema's shape.

States that `initial:` and `final:` name need not be listed. A transition that says neither on which event nor on what
condition is caused by the event `t_HERE_to_THERE`, which is what RoboComp calls the signal of such a transition.
"""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.build_interface import doc, entries, items, span_of, text
from robocomp_yaml.model.statemachine import (
    FINAL,
    HISTORY,
    PARALLEL,
    STATE,
    Action,
    Block,
    Cancel,
    Raise,
    Script,
    Send,
    State,
    StateMachine,
    Text,
    Transition,
    Value,
    walk,
)
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

Transitions = dict[str, list[Transition]]


def build(node: Mapping, name: str, path: str) -> StateMachine:
    """The machine under `statemachine:` of the component `name`."""
    sources: dict[str, tuple[Text, list[Transition]]] = {}
    _collect(node, sources)
    transitions = {source: found for source, (_, found) in sources.items()}
    root = _state("", node, STATE, node.span, transitions)
    known = {state.id for state in walk(root.states)}
    return StateMachine(
        name,
        path,
        root,
        events=tuple(Text(item.lexeme, item.span) for item in items(node, "events") if isinstance(item, Scalar)),
        inline=True,
        strays=tuple(source for key, (source, _) in sources.items() if key not in known),
        span=node.span,
    )


def _collect(node: Node, sources: dict[str, tuple[Text, list[Transition]]]) -> None:
    """All transitions by their source: those of one state may stand at any level."""
    for key, value in entries(node, "transitions"):
        if not key.lexeme.startswith("x-"):
            _, found = sources.setdefault(key.lexeme, (Text(key.lexeme, key.span), []))
            found += (_transition(key.lexeme, item) for item in _listed(value))
    for _, state in entries(node, "states"):
        _collect(state, sources)


def _state(name: str, node: Node | None, kind: str, span: Span, transitions: Transitions) -> State:
    initial = _named(node, "initial")
    own = transitions.get(name, []) if name else []
    history = text(node, "history")
    if history:
        kind = HISTORY
    elif kind == STATE and _is_true(node, "parallel"):
        kind = PARALLEL
    entered = Transition(targets=(initial,), span=initial.span) if initial else None
    return State(
        id=name,
        kind=kind,
        states=tuple(_children(node, initial, _named(node, "final"), transitions)),
        transitions=() if kind == HISTORY else tuple(own),
        initial=_remembered(own) if kind == HISTORY else entered,
        deep=history == "deep",
        entry=_blocks(node, "entry"),
        exit=_blocks(node, "exit"),
        doc=doc(node),
        span=span,
    )


def _children(
    node: Node | None, initial: Text | None, final: Text | None, transitions: Transitions
) -> Iterator[State]:
    """The states listed, and around them those that are only named."""
    listed = {key.lexeme: (key, value) for key, value in entries(node, "states") if not key.lexeme.startswith("x-")}
    if initial and initial.text not in listed:
        yield _state(initial.text, None, FINAL if initial == final else STATE, initial.span, transitions)
    for name, (key, value) in listed.items():
        kind = FINAL if final and name == final.text else STATE
        yield _state(name, value, kind, key.span, transitions)
    if final and final.text not in listed and final != initial:
        yield _state(final.text, None, FINAL, final.span, transitions)


def _remembered(own: list[Transition]) -> Transition | None:
    """Where a history leads before anything is remembered."""
    if not own:
        return None
    return Transition(targets=own[0].targets, actions=own[0].actions, span=own[0].span)


def _transition(source: str, node: Node) -> Transition:
    if isinstance(node, Scalar):
        target = Text(node.lexeme, node.span)
        return Transition((_signal(source, target),), targets=(target,), span=node.span)
    assert isinstance(node, Mapping)
    to = node.get("to")
    targets = tuple(Text(item.lexeme, item.span) for item in _listed(to) if isinstance(item, Scalar)) if to else ()
    condition = _named(node, "if")
    if node.get("event"):
        place = span_of(node, "event")
        events = tuple(Text(word, place) for word in text(node, "event").split())
    else:
        events = (_signal(source, targets[0]),) if condition is None and targets else ()
    return Transition(
        events,
        condition,
        targets,
        internal=_is_true(node, "internal"),
        actions=_actions(node.get("do")),
        span=node.span,
    )


def _signal(source: str, target: Text) -> Text:
    return Text(f"t_{source}_to_{target.text}", target.span)


def _named(node: Node | None, key: str) -> Text | None:
    child = node.get(key) if isinstance(node, Mapping) else None
    return Text(child.lexeme, child.span) if isinstance(child, Scalar) else None


def _is_true(node: Node | None, key: str) -> bool:
    child = node.get(key) if isinstance(node, Mapping) else None
    return child is not None and child.data is True


def _listed(node: Node) -> list[Node]:
    return node.items if isinstance(node, Sequence) else [node]


def _blocks(node: Node | None, key: str) -> tuple[Block, ...]:
    found = _actions(node.get(key)) if isinstance(node, Mapping) else ()
    return (found,) if found else ()


def _actions(node: Node | None) -> Block:
    return tuple(_action(item) for item in _listed(node)) if node is not None else ()


def _action(node: Node) -> Action:
    """A method of the worker, or {raise: …}, {send: …, after: …}, {cancel: …}."""
    if isinstance(node, Scalar):
        return Script(Text(node.lexeme, node.span), span=node.span)
    assert isinstance(node, Mapping)
    if raised := _named(node, "raise"):
        return Raise(raised, span=node.span)
    if node.get("cancel"):
        return Cancel(Value(literal=text(node, "cancel")), span=node.span)
    after = text(node, "after", "0 ms").replace(" ", "")
    return Send(
        Value(literal=text(node, "send"), span=span_of(node, "send")), Value(), Value(),
        Value(literal=after if after[-1].isalpha() else f"{after}ms"), id=text(node, "id"), span=node.span,
    )  # fmt: skip
