"""What the generated worker has for the user's code: a tree of offers, which is made from the linked documents.

The languages differ in names, which they pass, and in what is a call.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import msgspec
from msgspec import structs

from robocomp_yaml.emit.lowering.parameters import Setter
from robocomp_yaml.emit.lowering.ports import LoweredPorts
from robocomp_yaml.emit.usage.code import Step
from robocomp_yaml.emit.usage.kinds import Kind, kind_of
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.model import machine_names
from robocomp_yaml.model.interface import Enum, ExceptionType, Interface, Member, Method, Struct
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ResolvedMember,
    Type,
)

WORKER, PROXY, TOPIC, PARAMETERS, RECORD, EVENTS, MODULES, MODULE, ENUM, STRUCT, RESULTS = (
    "worker", "proxy", "topic", "parameters", "record", "events", "modules", "module", "enum", "struct", "results",
)  # fmt: skip
PLAIN, LIST, MAP, TOOL, FUTURE, OTHER = "plain", "list", "map", "tool", "future", "other"


class Offer(msgspec.Struct, frozen=True):
    """What a value has. `name` is what messages call it by. Unless it `is_complete`, it may have other members, too;
    `others` says whether a name is one of them. `element` is what an index leads to, `each` what a loop leads to.
    `count` is the number of RESULTS of a call, and `items` are what these are. `lacks` are names that a list surely
    does not have, each with a hint."""

    kind: str
    name: str = ""
    members: Mapping[str, OfferedMember] = {}
    is_complete: bool = True
    others: Callable[[str], bool] = lambda name: name.startswith("_")
    element: Offer | None = None
    each: Offer | None = None
    count: int = 0
    items: tuple[Offer | None, ...] = ()
    lacks: Mapping[str, str] = {}

    def at(self, step: Step) -> Offer | None:
        """What an index leads to, or a loop."""
        if step.is_each:
            return self.each
        if self.kind == MAP and step.place is not None and step.shown is None:
            return None  # a variable to which a mapping is unpacked is one of its keys
        if self.items:
            place = len(self.items) if step.place is None else step.place
            return self.items[place] if 0 <= place < len(self.items) else None
        return self.element


class OfferedMember(msgspec.Struct, frozen=True):
    """One member. `value` is what it is, or returns; `result` what only a call returns. A call has at least `least` and
    at most `most` arguments, by position or with the `keywords`; None: unknown. `signature` is for messages.
    `takes_path`: its argument is the path of a parameter, or a mapping of such paths; `is_state`: the name of a state.
    `parameter` is what an assignment, or a setter, sets, and `read` what a getter returns; `path` its path. `inputs`
    are the first parameters of an operation, or the members of a struct. `can_be_empty`: no arguments are right, too.
    Unless `instead` is '', it exists in annotations only, and elsewhere, `instead` is the hint. `instance` is what a
    value has that an annotation with this name allows."""

    value: Offer | None = None
    result: Offer | None = None
    inputs: tuple[Member, ...] = ()
    least: int = 0
    most: int | None = None
    keywords: frozenset[str] | None = None
    signature: str = ""
    takes_path: bool = False
    is_state: bool = False
    parameter: ResolvedMember | None = None
    read: ResolvedMember | None = None
    path: str = ""
    can_be_empty: bool = False
    instead: str = ""
    instance: Offer | None = None


class ServedInterface(msgspec.Struct, frozen=True):
    """An interface whose methods the user's class has: `prefix` is what their names begin with, `methods` are all."""

    name: str
    prefix: str
    methods: tuple[str, ...]
    is_topic: bool = False


class WorkerOffer(msgspec.Struct, frozen=True):
    """All that code can use: by the root of its chains. `handlers` are the methods that the state machine calls;
    `states` its states, `answering` the methods that others expect results of, each with names and kinds of these.
    `is_exact`: the language converts no number."""

    roots: Mapping[str, Offer]
    served: tuple[ServedInterface, ...] = ()
    handlers: tuple[str, ...] = ()
    states: tuple[str, ...] = ()
    answering: Mapping[str, tuple[tuple[str, Kind | None], ...]] = {}
    is_exact: bool = False


ASYNC = "Async"
"""What Ice appends to the name of an operation for its asynchronous variant."""

NOTHING = Offer(OTHER, is_complete=False)


Returned = Callable[[Method, LinkedModule], Offer | None]
Natives = Mapping[str, Mapping[str, OfferedMember]]
"""The members that values of basic types, lists and maps have in a language, if they are known."""
UNKNOWN: Natives = {}


def plain(name: str, natives: Natives) -> Offer:
    """What a value of a basic type has."""
    return Offer(PLAIN, name, natives.get(name, {}), is_complete=name in natives)


class OfferedProxies(msgspec.Struct, frozen=True):
    """How a language offers proxies. `called` makes the name of an operation, and `returned` what a call returns;
    `others` are methods of every proxy; `of_ice` are known ones of these, and whether they return a proxy like it.
    `future` makes what an asynchronous call returns. With `outputs`, calls have arguments for them. Every call may have
    a context, and those by keyword have the `keywords`."""

    called: Callable[[str], str]
    others: Callable[[str], bool]
    returned: Returned
    outputs: bool = False
    keywords: Callable[[Method], Iterable[str]] | None = None
    future: Callable[[Offer | None], Offer] | None = None
    of_ice: Mapping[str, bool] = {}

    def every(self, ports: LoweredPorts) -> dict[str, OfferedMember]:
        """The proxies of the worker."""
        found = {}
        for one, kind in [*((one, PROXY) for one in ports.requires), *((one, TOPIC) for one in ports.publishes)]:
            made = self.of(one.port.interface, one.port.scope)
            found[one.name] = OfferedMember(structs.replace(made, kind=kind))
        return found

    def of(self, interface: Interface, scope: LinkedModule) -> Offer:
        """A proxy of an interface."""
        methods: dict[str, OfferedMember] = {}
        for method in interface.methods:
            name, result = self.called(method.name), self.returned(method, scope)
            methods[name] = structs.replace(self._operation(method), result=result)
            later = structs.replace(methods[name], result=self.future(result)) if self.future else OfferedMember()
            methods.setdefault(f"{name}{ASYNC}", later)
        made = Offer(TOPIC if interface.is_topic else PROXY, interface.name, methods, others=self.others)
        methods |= {name: OfferedMember(result=made if is_same else None) for name, is_same in self.of_ice.items()}
        return made

    def _operation(self, method: Method) -> OfferedMember:
        members = [*method.inputs, *(method.outputs if self.outputs else ())]
        return OfferedMember(
            least=len(members), most=len(members) + 1, inputs=method.inputs,
            keywords=frozenset(("context", *self.keywords(method))) if self.keywords else None,
            signature=f"{self.called(method.name)}({', '.join(f'{one.name}: {one.type.text}' for one in members)})",
        )  # fmt: skip


def answering(ports: LoweredPorts, *, outputs: bool = True) -> dict[str, tuple[tuple[str, Kind | None], ...]]:
    """The methods of the user's class that return something, with the names and kinds of the results; with `outputs`,
    they return these, too."""
    found = {}
    for called in (called for service in ports.implements for called in service.methods):
        method, scope = called.method, called.port.scope
        every = [] if method.returns is None else [("the result", kind_of(method.returns, scope))]
        every += ((one.name, kind_of(one.type, scope)) for one in method.outputs if outputs)
        if every:
            found[called.name] = tuple(every)
    return found


def served(ports: LoweredPorts) -> tuple[ServedInterface, ...]:
    """The interfaces and topics whose methods the user's class has."""
    return tuple(
        ServedInterface(
            service.port.interface.name, f"{service.port.interface.name}_",
            tuple(called.name for called in service.methods), is_topic=service in ports.subscribes,
        )
        for service in (*ports.implements, *ports.subscribes)
    )  # fmt: skip


def record(
    type_: RecordType, in_code: Callable[[str], str], path: str = "", name: str = "", natives: Natives = UNKNOWN
) -> Offer:  # fmt: skip
    """The members of a record of parameters, as attributes. `path` is the one of the group, '' also in a struct."""
    members = {}
    for member in type_.members:
        below = f"{path}.{member.name}" if path else member.name
        is_known = bool(path) or not name
        members[in_code(member.code_name)] = OfferedMember(
            value(member.type, in_code, below if is_known and member.is_group else "", natives),
            parameter=member,
            path=below if is_known else "",
        )
    return Offer(RECORD, name or (f"the group {path}" if path else ""), members)


def setters(made: Iterable[Setter]) -> dict[str, OfferedMember]:
    """The setters of a parameter."""
    return {
        name: OfferedMember(least=1, most=1, signature=f"{name}(value)", parameter=member, path=path)
        for name, member, path in made
    }


_ELEMENTS = ("at", "back", "front")
"""Methods of lists in C++ that return an element."""


def of_list(element: Offer | None, lists: Mapping[str, str] = {}, natives: Natives = UNKNOWN) -> Offer:
    """What a list has. `lists` are names that no list has in the language; it also lacks those of its elements."""
    own = dict.fromkeys(element.members, "its elements have it") if element is not None and (lists or natives) else {}
    lacks = {name: hint for name, hint in {**own, **lists}.items() if not hasattr(list, name)}
    members = natives.get(LIST, {} if lists else dict.fromkeys(_ELEMENTS, OfferedMember(result=element)))
    name = "a tuple" if members and "append" not in members else "a list"
    return Offer(LIST, name, members, LIST in natives, element=element, each=element, lacks=lacks)


def of_map(element: Offer | None, natives: Natives = UNKNOWN) -> Offer:
    """What a mapping has."""
    if MAP not in natives:
        return Offer(MAP, is_complete=False, element=element)
    more = of_values(element).members
    members = {name: more.get(name, member) for name, member in natives[MAP].items()}
    return Offer(MAP, "a mapping", members, element=element)


def of_values(element: Offer | None) -> Offer:
    """What a mapping of Python has at least, if its values are these."""
    pair = Offer(OTHER, is_complete=False, items=(None, element))
    members = {
        "get": OfferedMember(result=element),
        "values": OfferedMember(result=Offer(OTHER, is_complete=False, each=element)),
        "items": OfferedMember(result=Offer(OTHER, is_complete=False, each=pair)),
    }
    return Offer(MAP, "a mapping", members, is_complete=False, element=element)


def value(type_: Type, in_code: Callable[[str], str], path: str = "", natives: Natives = UNKNOWN) -> Offer | None:
    """What a value of a type has."""
    match type_:
        case ListType(element=element):
            return of_list(value(element, in_code, natives=natives), natives=natives)
        case MapType(element=element):
            return of_map(value(element, in_code, natives=natives), natives)
        case RecordType(name=name):
            return record(type_, in_code, path, f"the struct {name}" if name else "", natives)
        case BasicType(name=name) if name in natives:
            return plain(name, natives)
        case EnumType() if natives:
            return plain("string", natives)
        case _:
            return None


def events(machine: StateMachine, in_code: Callable[[str], str]) -> Offer:
    """The events that the code may fire."""
    fired = {in_code(event.name): OfferedMember(most=1) for event in machine_names.events(machine)}
    return Offer(EVENTS, "the state machine", fired)


def handlers(machine: StateMachine) -> tuple[str, ...]:
    """The methods that a state machine calls when it enters or leaves states, and in every period."""
    made = (machine_names.entry_handler, machine_names.exit_handler, machine_names.period_handler)
    return tuple(make(state.id) for state in machine_names.states_with_handlers(machine) for make in made)


def states(machine: StateMachine) -> tuple[str, ...]:
    return tuple(state.id for state in machine.states if state.id)


def modules(
    linked: LinkedComponent, variable: Callable[[str], str], in_code: Callable[[str], str],
    others: Callable[[str], bool], instance: Callable[[object, LinkedModule], Offer | None], *,
    classes: bool = False, prx: OfferedProxies | None = None,
) -> Offer:  # fmt: skip
    """The Slice modules with their types, as attributes. Two documents may define parts of one module. `instance` makes
    what a value of a type has, and `prx` what a proxy has. With `classes`, exceptions are made like structs, and nobody
    makes a value of an enum."""
    found: dict[str, dict[str, OfferedMember]] = {}
    for scope in linked.modules():
        found.setdefault(variable(scope.module.name), {}).update(_types(scope, in_code, instance, classes, prx))
    broken = {variable(scope.module.name) for scope in linked.modules() if scope.unresolved or linked.broken}
    offers = {
        name: OfferedMember(Offer(MODULE, name, members, is_complete=name not in broken, others=_is_internal))
        for name, members in found.items()
    }
    return Offer(MODULES, linked.component.name, offers, is_complete=not linked.broken, others=others)


def _is_internal(name: str) -> bool:
    return name.startswith("_") or name.endswith(("Disp", "Holder", "Ptr")) or name == "operator"


def _types(
    scope: LinkedModule, in_code: Callable[[str], str], instance: Callable[[object, LinkedModule], Offer | None],
    classes: bool, prx: OfferedProxies | None,
) -> dict[str, OfferedMember]:  # fmt: skip
    found = {}
    for definition in scope.module.definitions:
        name = in_code(definition.name)
        match definition:
            case Enum(enumerators=enumerators):
                enumerator = OfferedMember(Offer(PLAIN, definition.name, is_complete=False))
                names = {in_code(one.name): enumerator for one in enumerators}
                value = Offer(ENUM, definition.name, names, others=_is_of_enum)
                such = f"{name}.{next(iter(names))}, or {name}.valueOf(NUMBER)" if classes and names else ""
                found[name] = OfferedMember(value, signature=such, instance=enumerator.value)
            case Struct(members=members) | ExceptionType(members=members):
                fields = frozenset(in_code(one.name) for one in members)
                is_known = classes or isinstance(definition, Struct)
                found[name] = OfferedMember(
                    result=instance(definition, scope), most=len(members) if is_known else None,
                    inputs=members if is_known else (), keywords=fields if is_known else None,
                    signature=f"{definition.name}({', '.join(one.name for one in members)})",
                    instance=instance(definition, scope),
                )  # fmt: skip
            case Interface():
                found[name] = OfferedMember(instance=NOTHING)
                made = prx.of(definition, scope) if prx is not None else None
                cast = OfferedMember(result=made)
                casts = Offer(OTHER, name, {"checkedCast": cast, "uncheckedCast": cast}, is_complete=False)
                found[f"{definition.name}Prx"] = OfferedMember(casts if made is not None else None, instance=made)
            case _:
                found[name] = OfferedMember(result=instance(definition, scope))
    return found


def _is_of_enum(name: str) -> bool:
    return name.startswith("_") or name in ("name", "value", "valueOf", "ice_id", "ice_staticId")
