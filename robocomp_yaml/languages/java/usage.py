"""What the worker offers to code in Java, and which of that the user's code uses.

A name that the code declares anywhere may hide the worker's own, so nothing is said about it; nor is anything said near
a syntax error, which javac reports.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import partial

from msgspec.structs import replace

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Chain, CodeUsage
from robocomp_yaml.emit.usage.judge import is_nearly_proxy, is_proxy
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, WorkerOffer
from robocomp_yaml.emit.usage.types import OfferedTypes
from robocomp_yaml.languages._shared.usage_file import TEXT, WORD, unused, workers_of
from robocomp_yaml.languages.java import LANGUAGE, OBJECT_METHODS
from robocomp_yaml.languages.java.names import PACKAGE, PORTS, ice_name
from robocomp_yaml.languages.java.parameters import accessors
from robocomp_yaml.languages.java.usage_files import JavaFile
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.model.interface import Method

_METHOD = re.compile(r"\b[A-Z]\w*_\w+\b")
_OF_TYPES = frozenset("class compareTo length name ordinal this value values valueOf".split()) | OBJECT_METHODS
_MADE = ("Disp", "Helper", "Holder", "I", "NC", "Prx", "Result")
"""Endings of the names that slice2java adds."""


def offer(linked: LinkedComponent) -> WorkerOffer:
    """What the worker of a component offers."""
    ports = lowering.lower(linked, PORTS)
    types = OfferedTypes(ice_name, _is_of_every_struct, lambda name: True)
    members = offers.OfferedProxies(PORTS.called, _is_of_every_proxy, partial(_returned, types)).every(ports)
    members["parameters"] = OfferedMember(_parameters(linked))
    modules = offers.modules(
        linked, ice_name, ice_name, lambda name: name == "RoboCompCommonBehavior", types.of_definition
    )
    return WorkerOffer(
        {WORKER: Offer(offers.WORKER, linked.component.name, members, is_complete=False), MODULES: _slice(modules)},
        offers.served(ports),
    )  # fmt: skip


def _returned(types: OfferedTypes, method: Method, scope: LinkedModule) -> Offer | None:
    """What a call returns: several results are an object of a class of their own."""
    return None if method.outputs else types.result(method, scope, tuples=False)


def _slice(modules: Offer) -> Offer:
    """The modules, each with the classes that slice2java adds."""

    def made(type_: OfferedMember) -> OfferedMember:
        value = type_.value
        if type_.most:  # the constructors of a struct have an argument for each member, or none
            type_ = replace(type_, least=type_.most, can_be_empty=True)
        return replace(type_, value=replace(value, others=_is_of_every_type)) if value is not None else type_

    found = {}
    for name, module in modules.members.items():
        assert module.value is not None
        types = {key: made(one) for key, one in module.value.members.items()}
        found[name] = replace(module, value=replace(module.value, members=types, others=_is_made))
    return replace(modules, members=found)


def _is_made(name: str) -> bool:
    return name == "*" or name.startswith("_") or name.endswith(_MADE)


def _is_of_every_type(name: str) -> bool:
    return name.startswith(("_", "ice_")) or name in _OF_TYPES


def _is_of_every_struct(name: str) -> bool:
    return name.startswith(("ice_", "_")) or name in OBJECT_METHODS or name == "clone"


def _is_of_every_proxy(name: str) -> bool:
    """Methods of Ice and of every object, and Ice's asynchronous variants of the operations."""
    return name.startswith(("ice_", "_")) or name in OBJECT_METHODS


def _parameters(linked: LinkedComponent) -> Offer:
    """The getters and setters of the parameters."""
    root = linked.parameters.parameters.root
    values = offers.record(root, LANGUAGE.in_code)
    members = {
        "now": OfferedMember(_java(values), most=0),
        "set": OfferedMember(least=2, most=2, takes_path=True, signature="set(path, value)"),
        "change": OfferedMember(least=1, most=1, takes_path=True, signature="change(Map.of(path, value))"),
        "listen": OfferedMember(least=1, most=1, signature="listen(function)"),
    }
    for getter, member, setters in accessors(root):
        field = values.members[LANGUAGE.in_code(member.code_name)]
        members[getter] = replace(_java_member(field), parameter=None, read=member, most=0, signature=f"{getter}()")
        members |= offers.setters(setters)
    return Offer(
        offers.PARAMETERS, linked.component.name, members, others=lambda name: name in (*OBJECT_METHODS, "table")
    )


def _java(offer: Offer) -> Offer:
    """An offer with the methods that values have in Java: lists and maps have `get()`."""
    members = {name: _java_member(member) for name, member in offer.members.items()}
    element = _java(offer.element) if offer.element is not None else None
    if element is not None:
        members["get"] = members["getFirst"] = members["getLast"] = OfferedMember(element, most=1)
    return replace(offer, members=members, element=element, others=OBJECT_METHODS.__contains__)


def _java_member(member: OfferedMember) -> OfferedMember:
    value = _java(member.value) if member.value is not None else None
    if value is not None and member.parameter is not None and member.parameter.optional:
        inner = {name: OfferedMember(value, most=1) for name in ("get", "orElseThrow", "orElse")}
        value = Offer(offers.OTHER, is_complete=False, members=inner)
    return replace(member, value=value)


def read(files: Mapping[str, str], linked: LinkedComponent, worker: WorkerOffer) -> CodeUsage:
    """The use that the files below src/ make of the worker, by their paths there."""
    known = worker.roots[WORKER].members
    words = {word for text in files.values() for word in WORD.findall(text)}
    names = sorted(word for word in words if word in known or is_proxy(word) or is_nearly_proxy(word, known))
    parsed = [JavaFile(path, text) for path, text in files.items()]
    workers = workers_of(one for file in parsed for one in file.classes())
    if not workers:
        return CodeUsage()
    declared = {name for name in names if any(file.declares(name) for file in parsed)}
    chains = [one for file in parsed for name in names for one in file.chains(name, workers)]
    chains += (one for file in parsed for one in _of_modules(file, parsed, worker.roots[MODULES]))
    of_modules = worker.roots[MODULES].members
    chains += (one for file in parsed for module in of_modules for one in file.typed(PACKAGE, module))
    texts = {text for source in files.values() for text in TEXT.findall(source)}
    methods = unused([word for file in parsed for word in file.methods(workers)], files.values(), _METHOD)
    return CodeUsage(tuple(chains), methods, frozenset(declared), frozenset(texts), is_shared=True)


def _of_modules(file: JavaFile, every: list[JavaFile], modules: Offer) -> Iterator[Chain]:
    """The uses of Slice modules: by their full names, and of types that the file imports."""
    if not file.declares(PACKAGE):
        yield from file.qualified()
    types: dict[str, str] = {}
    for module, *rest in (one for one in file.imported() if len(one) > 1):
        of_module = modules.members.get(module)
        known = of_module.value.members if of_module is not None and of_module.value is not None else {}
        types |= {name: module for name in (known if rest == ["*"] else rest[:1]) if name in known}
    for name, module in types.items():
        if not any(one.declares(name) for one in every):
            yield from file.of_type(name, module)
            yield from file.typed(name, module)
