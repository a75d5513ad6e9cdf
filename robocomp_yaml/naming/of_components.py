"""The names of component documents: components, their ports, and the states of their machines."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.model.component import LISTS
from robocomp_yaml.model.machine_index import indexes
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Key, Names
from robocomp_yaml.naming.of_interfaces import imports, key_of, qualified
from robocomp_yaml.source.tree import Mapping as MappingNode
from robocomp_yaml.source.tree import Node, Scalar, Sequence

_IN = re.compile(r"""\bIn\s*\(\s*(['"])(?P<state>[^'"]*)\1\s*\)""")
_SIGNAL = re.compile(r"t_(?P<source>\w+)_to_(?P<target>\w+)")


def collect(names: Names, program: Program, trees: Mapping[str, Node | None]) -> None:
    for linked in program.components.values():
        component = linked.component
        says = f"component {component.name}, in {component.language.target.title}"
        key = kinds.COMPONENT, component.path
        names.define(DefinedName(key, component.name, component.span, says, component.doc))
        imports(names, component.imports, linked.imports)
        for list_ in LISTS:
            for port in getattr(linked, list_):
                _port(names, linked, list_, port)
        if linked.machine is not None:
            _machine(names, linked, linked.machine, trees.get(component.path))


def port_key(linked: LinkedComponent, port: Port) -> Key:
    """What a port's name means: the interface, if it has no name of its own."""
    if port.use.name_span.file and port.use.name_span != port.use.span:
        return kinds.PORT, linked.component.path, port.name
    return key_of(port.scope, port.interface)


def _port(names: Names, linked: LinkedComponent, list_: str, port: Port) -> None:
    use = port.use
    qualified(names, port.scope, port.interface, use.interface, use.span)
    key = port_key(linked, port)
    if key[0] == kinds.PORT:
        says = f"{list_} {port.interface.name} as {port.name}"
        names.define(DefinedName(key, port.name, use.name_span, says, use.doc, (kinds.COMPONENT, key[1])))


# State machines


def _machine(names: Names, linked: LinkedComponent, machine: StateMachine, tree: Node | None) -> None:
    component = linked.component
    inside = kinds.COMPONENT, component.path
    states = {state.id for state in machine.states if state.id}
    of = {name: (kinds.STATE, component.path, name) for name in states}
    for state in machine.states:
        if state.id:
            names.define(DefinedName(of[state.id], state.id, state.span, f"state {state.id}", state.doc, inside))
    root = tree.get("statemachine") if machine.inline and tree is not None else None
    if root is not None:
        for text, span, is_condition in _texts(root):
            _use(names, of, text, span, is_condition=is_condition)
        return
    for index in indexes(machine):
        if index.machine is not machine:
            continue
        for _, transition in index.transitions():
            for target in transition.targets:
                _use(names, of, target.text, target.span)
            if transition.condition is not None:
                _use(names, of, transition.condition.text, transition.condition.span, is_condition=True)
    for state in (machine.root, *machine.states):
        for target in state.initial.targets if state.initial is not None else ():
            _use(names, of, target.text, target.span)


def _use(names: Names, of: Mapping[str, Key], text: str, span: Span, *, is_condition: bool = False) -> None:
    if is_condition:
        for found in _IN.finditer(text):
            names.use(of.get(found["state"]), span.inside(text, found.start("state"), found.end("state")))
    elif text in of:
        names.use(of[text], span.inside(text, 0, len(text)))
    elif (signal := _SIGNAL.fullmatch(text)) and signal["source"] in of and signal["target"] in of:
        for part in ("source", "target"):  # RoboComp's name for the signal of a transition
            names.use(of[signal[part]], span.inside(text, signal.start(part), signal.end(part)))


def _texts(node: Node) -> Iterator[tuple[str, Span, bool]]:
    """The texts of a machine in a CDSL that may be states, or conditions about them. The keys under `states:` are the
    definitions."""
    for key in ("initial", "final"):
        if isinstance(named := node.get(key), Scalar):
            yield named.lexeme, named.span, False
    for event in _listed(node.get("events")):
        if isinstance(event, Scalar):
            yield event.lexeme, event.span, False
    if isinstance(transitions := node.get("transitions"), MappingNode):
        for name, value in transitions.items():
            yield name.lexeme, name.span, False
            for item in _listed(value):
                if isinstance(item, Scalar):
                    yield item.lexeme, item.span, False
                for target in (*_listed(item.get("to")), *_listed(item.get("event"))):
                    if isinstance(target, Scalar):
                        yield target.lexeme, target.span, False
                if isinstance(condition := item.get("if"), Scalar):
                    yield condition.lexeme, condition.span, True
    if isinstance(states := node.get("states"), MappingNode):
        for _, state in states.items():
            yield from _texts(state)


def _listed(node: Node | None) -> list[Node]:
    return node.items if isinstance(node, Sequence) else [] if node is None else [node]
