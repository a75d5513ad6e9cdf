"""State machines: what states, events, guards and actions are called in code."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.languages import with_capability
from robocomp_yaml.languages.record import STATEMACHINE, TargetLanguage
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.model import machine_names as names
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import MachineIndex
from robocomp_yaml.model.statemachine import StateMachine

_EVENT = re.compile(r"(?!__)[A-Za-z_][A-Za-z0-9_-]*(\.[A-Za-z0-9_-]+)*")
_WORKERS = frozenset(
    "communicator compute events getPeriod initialize killYourSelf log mutex self setPeriod statemachine worker".split()
)


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        if linked.machine is not None:
            yield from _events(linked.machine)
            more = program.plugins_of(linked.component.path).languages
            yield from _in_code(linked, linked.machine, with_capability(STATEMACHINE, more))


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
        reserved |= names.ROBOCOMPS
    for named in (*guards, *actions):
        is_own = named.kind == names.ACTION and named.name in names.CALLABLE
        if named.name in reserved and not is_own:
            yield codes.METHOD_NAME.at(named.text.span, name=named.name)
    handlers = [
        names.Named(names.STATE, Text(state.id, span=state.span), name)
        for state in {state.id: state for state in names.with_handler(machine)}.values()
        for name in (names.entered(state.id), names.left(state.id), names.every_period(state.id))
    ]
    for named in (*handlers, *guards, *actions):
        yield from _clash(named, taken)
    fired: dict[str, names.Named] = {}
    for event in names.events(machine):
        yield from _clash(event, fired)


def _of_ports(linked: LinkedComponent) -> Iterator[names.Named]:
    """What the worker has of interfaces."""
    for port in (*linked.implements, *linked.subscribes):
        for method in port.interface.methods:
            name = f"{port.interface.name}_{method.name}"
            yield names.Named("the method", Text(name, span=port.use.span), name)
    for port in (*linked.requires, *linked.publishes):
        name = f"{port.name.lower()}_proxy"
        yield names.Named("the proxy", Text(port.name, span=port.use.span), name)


def _clash(named: names.Named, taken: dict[str, names.Named]) -> Iterator[Diagnostic]:
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
