"""Completion in deployments: hosts, components and entries, what an entry can be connected to, ports, topics and values
of its component, and what groups expose."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robocomp_yaml.api.completing import values
from robocomp_yaml.api.completing.places import MARK, TypedPlace, items_of, keys_of, siblings
from robocomp_yaml.api.completing.proposal import Proposal
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.naming import names
from robocomp_yaml.naming.names import Names
from robocomp_yaml.source.tree import Mapping, Scalar, value_at


def proposals(path: str, place: TypedPlace, known: Names, program: Program | None) -> Iterator[Proposal]:
    """Names that can stand at a place of a deployment."""
    yield from _entries_and_hosts(path, place, known, program)
    if program is not None:
        yield from _values(path, place, program)
        yield from _ports(path, place, program)
    yield from _of_groups(place, program)


def _entries_and_hosts(path: str, place: TypedPlace, known: Names, program: Program | None) -> Iterator[Proposal]:
    keys, root = place.keys, place.root
    entries = [name for name in keys_of(root, "components") if keys[:2] != ("components", name)]
    others = [*keys_of(root, "groups"), *keys_of(root, "services")]
    match keys:
        case ("components" | "groups" | "services", _, *_, "host") if not place.is_key:
            yield from (Proposal(name, names.HOST) for name in keys_of(root, "hosts"))
        case ("components", _, "component") | ("groups", _, "as") if not place.is_key:
            for one in known.of_kinds(names.COMPONENT):
                folder = os.path.relpath(os.path.dirname(one.span.file), os.path.dirname(path))
                yield Proposal(folder, names.COMPONENT, one.says, one.doc)
        case ("components", entry, "connect", port) if not place.is_key:
            servers = _servers(path, place, entry, port, entries, program)
            yield from (Proposal(name, names.ENTRY) for name in (*servers, *keys_of(root, "groups")))
        case ("components", _, "process", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in (*entries, *keys_of(root, "groups")))
        case ("components", _, "after", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in (*entries, *others))
        case ("groups", _, "components", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in entries)


def _servers(
    path: str, place: TypedPlace, user: str, port: str, entries: Iterable[str], program: Program | None
) -> Iterator[str]:  # fmt: skip
    """The entries that may serve what another one requires at a port: all of which the documents do not say it."""
    by_path = values.components_by_path(program) if program is not None else {}
    user_component = _component(path, place, user, by_path)
    required = user_component.requires if user_component is not None else ()
    interface = next((one.interface.name for one in required if one.name == port), "")
    for name in entries:
        component = _component(path, place, name, by_path)
        endpoints = value_at(place.root, "components", name, "endpoints")
        served = [key.lexeme for key, _ in endpoints.items()] if isinstance(endpoints, Mapping) else []
        served += [one.interface.name for one in component.implements] if component is not None else []
        is_known = component is not None or value_at(place.root, "components", name, "program") is not None
        if not is_known or (interface in served if interface else served):
            yield name


def _component(
    path: str, place: TypedPlace, entry: str, by_path: dict[str, LinkedComponent]
) -> LinkedComponent | None:  # fmt: skip
    named = values.named_by(place, "components", entry)
    return by_path.get(values.document_at(path, named)) if named else None


def _values(path: str, place: TypedPlace, program: Program) -> Iterator[Proposal]:
    """Parameters under `set:` of an entry and their values, which no schema knows."""
    found = values.parameters_at(path, "ddsl", place, program)
    if found is not None and (found[1] or place.is_key):
        yield from values.at_parameter(found[0], place, found[1])


def _ports(path: str, place: TypedPlace, program: Program) -> Iterator[Proposal]:
    """The ports of an entry's component, as keys; and the topics of a deployment."""
    match place.keys:
        case ("components", entry, "connect" | "topics" | "ports" | "endpoints" as section) if place.is_key:
            component = _component(path, place, entry, values.components_by_path(program))
            if component is None:
                return
            lists = {
                "connect": (("requires", component.requires),),
                "topics": (("publishes", component.publishes), ("subscribes", component.subscribes)),
            }.get(section, (("implements", component.implements), ("subscribes", component.subscribes)))  # fmt: skip
            present = siblings(place)
            for what, ports in lists:
                for port in ports:
                    if port.name not in present:
                        yield Proposal(port.name, names.INTERFACE, f"{what} {port.interface.name}", port.interface.doc)
        case ("components", _, "topics", name) if not place.is_key:
            yield from (Proposal(topic, names.TOPIC, "topic of this deployment") for topic in _topics(place.root, name))


def _topics(root: Mapping, own: str) -> list[str]:
    """The names of topics that a deployment writes; that of the port itself comes first."""
    found = {own: None}
    components = root.get("components")
    for _, entry in components.items() if isinstance(components, Mapping) else ():
        topics = entry.get("topics")
        for _, value in topics.items() if isinstance(topics, Mapping) else ():
            if isinstance(value, Scalar) and value.lexeme and MARK not in value.lexeme:
                found[value.lexeme] = None
    return list(found)


def _of_groups(place: TypedPlace, program: Program | None) -> Iterator[Proposal]:
    """Members and methods of what a group exposes."""
    match place.keys:
        case ("groups", group, "expose", _) | ("groups", group, "expose", _, "member") if not place.is_key:
            listed = items_of(value_at(place.root, "groups", group), "components")
            yield from (Proposal(name, names.ENTRY) for name in listed)
        case ("groups", _, "expose", interface, "allow", *_) if not place.is_key and program is not None:
            for scope in program.modules.values():
                for one in scope.module.interfaces:
                    if one.name == interface:
                        yield from (Proposal(each.name, names.METHOD, "", each.doc) for each in one.methods)
