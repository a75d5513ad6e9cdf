"""Components: what their lists may say together."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from itertools import count

from msgspec.structs import replace

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.codes.files import NAME_TOO_LONG
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import removal
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.model.component import LINK, LISTS, PIP, Component, Library
from robocomp_yaml.source.file_names import LONGEST_NAME, is_too_long, shortened

_NUMBERS = r" *(>=|<=|==|=|>|<)? *\d+(\.\d+)* *"
_LONGEST_SUFFIX = "_autogen"  # the folder of what CMake makes for Qt


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
        yield from _libraries(component)
    yield from _same_names(program)


def _same_names(program: Program) -> Iterator[Diagnostic]:
    """The same component in several languages is one; whatever belongs to no declared workspace belongs together. Of
    two alike, the one with the longer path is told of: copies are called `speech2`, `speech (copy)` or `old/speech`."""
    by_name: dict[str, list[LinkedComponent]] = {}
    for linked in program.components.values():
        by_name.setdefault(linked.component.name, []).append(linked)
    for name, alike in by_name.items():
        if len(alike) == 1:
            continue
        first: dict[tuple[str, str], LinkedComponent] = {}
        free = (f"{name}{n}" for n in count(2) if f"{name}{n}" not in by_name)
        for linked in sorted(alike, key=lambda each: (len(each.component.path), each.component.path)):
            component = linked.component
            root = root_above(os.path.dirname(component.path))
            workspace = "" if root is None else os.path.realpath(root)
            other = first.setdefault((workspace, component.language.name), linked).component
            if other is not component:
                yield codes.SAME_NAME.at(
                    component.span,
                    name=name,
                    other=other.path,
                    related=[Related("the other one", other.span)],
                    hint=f"a copy needs a name of its own: `component: {next(free)}`",
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


def _libraries(component: Component) -> Iterator[Diagnostic]:
    by_entry: dict[int, list[Library]] = {}
    for library in component.libraries:
        by_entry.setdefault(library.entry, []).append(library)
    for libraries in by_entry.values():
        if len(libraries) > 1:
            places = " and ".join(f"`{library.kind}`" for library in libraries)
            yield codes.LIBRARY_OF_TWO_KINDS.at(libraries[1].span, places=places, hint="write two entries")
    for library in component.libraries:
        plain = all(re.fullmatch(_NUMBERS, part) for part in library.version.split(",")) and library.kind != LINK
        if library.version and library.kind != PIP and not plain:
            yield codes.LIBRARY_VERSION.at(
                library.version_span, version=library.version.strip(), kind=f"`{library.kind}`"
            )
