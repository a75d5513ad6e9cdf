"""Components: what their lists may say together."""

from __future__ import annotations

import os
from collections.abc import Iterator

from msgspec.structs import replace

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.codes.files import NAME_TOO_LONG
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import removal
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.source.file_names import LONGEST_NAME, is_too_long, shortened

_LONGEST_SUFFIX = "_autogen"  # the folder of what CMake makes for Qt
LISTS = ("implements", "requires", "publishes", "subscribes")


def check(program: Program) -> Iterator[Diagnostic]:
    folders: dict[str, LinkedComponent] = {}
    for linked in sorted(program.components.values(), key=lambda c: c.component.path):
        component = linked.component
        if is_too_long(component.name + _LONGEST_SUFFIX):
            limit = LONGEST_NAME - len(_LONGEST_SUFFIX)
            yield NAME_TOO_LONG.at(component.span, name=shortened(component.name), limit=limit, hint="shorten it")
        yield from _names(linked)
        yield from _topics(linked)
        folder = os.path.dirname(linked.component.path)
        first = folders.setdefault(folder, linked).component
        if first is not linked.component:
            yield codes.SAME_FOLDER.at(
                linked.component.span,
                name=linked.component.name,
                other=first.name,
                hint="give each component a folder of its own",
                related=[Related("the other one", first.span)],
            )


def _is_same(one: Port, other: Port) -> bool:
    return replace(one.use, span=other.use.span) == other.use


def _names(linked: LinkedComponent) -> Iterator[Diagnostic]:
    """Each entry has a name of its own in its list, and each proxy a name of its own in code."""
    for list_ in LISTS:
        names: dict[str, Port] = {}
        accessors: dict[str, Port] = {}
        for port in getattr(linked, list_):
            if port.interface.name == "CommonBehavior" and list_ == "implements":
                yield codes.COMMON_BEHAVIOR.at(port.use.span, hint="leave it out", fixes=[removal(port.use.span)])
            if port.name in names:
                free = next(f"{port.name}{n}" for n in range(1, 1000) if f"{port.name}{n}" not in names)
                entry = f"{{{free}: {port.use.interface}}}"
                yield codes.DUPLICATE_PORT.at(
                    port.use.span,
                    name=port.name,
                    list=list_,
                    hint="leave it out" if list_ != "requires" else f"write {entry}, or leave it out",
                    related=[Related("it stands here first", names[port.name].use.span)],
                    fixes=[removal(port.use.span, safe=list_ != "requires" and _is_same(port, names[port.name]))],
                )
                continue
            names[port.name] = port
            if list_ not in ("requires", "publishes"):
                continue
            accessor = f"{port.name.lower()}_proxy"
            other = accessors.setdefault(accessor, port)
            if other is not port:
                yield codes.ACCESSOR_CLASH.at(
                    port.use.span,
                    name=port.name,
                    other=other.name,
                    accessor=accessor,
                    hint=f"give one of them a name of its own: {{{port.name}2: {port.use.interface}}}",
                    related=[Related(f"'{other.name}' stands here", other.use.span)],
                )


def _topics(linked: LinkedComponent) -> Iterator[Diagnostic]:
    """What is published goes one way; what is a topic is not called."""
    for port in (*linked.publishes, *linked.subscribes):
        lost = [method.name for method in port.interface.methods if not method.can_be_published]
        if lost and not port.interface.is_topic:
            yield codes.PARTLY_PUBLISHED.at(port.use.span, name=port.interface.name, methods=", ".join(lost))
    for ports, done in ((linked.implements, "implemented"), (linked.requires, "required")):
        for port in ports:
            if port.interface.is_topic:
                yield codes.TOPIC_IMPLEMENTED.at(port.use.span, name=port.interface.name, done=done)
