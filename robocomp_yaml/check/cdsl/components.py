"""Components: names, folders, ports and libraries."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterator
from itertools import count

from robocomp_yaml.check import repeated
from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.codes.files import NAME_TOO_LONG
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import removal
from robocomp_yaml.grouping import grouped
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.model.component import LINK, LISTS, PIP, Component
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.file_names import LONGEST_NAME, is_too_long, shortened

_NUMBERS = r" *(>=|<=|==|=|>|<)? *\d+(\.\d+)* *"
_LONGEST_SUFFIX = "_autogen"  # CMake's folder for generated Qt code


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        component = linked.component
        if is_too_long(component.name + _LONGEST_SUFFIX):
            limit = LONGEST_NAME - len(_LONGEST_SUFFIX)
            yield NAME_TOO_LONG.at(component.span, name=shortened(component.name), limit=limit, hint="shorten it")
        yield from _names(linked)
        yield from _topics(linked)
        yield from _libraries(component)
    components = sorted((linked.component for linked in program.components.values()), key=lambda each: each.path)
    for first, component in repeated(components, lambda each: os.path.dirname(each.path)):
        yield codes.SAME_FOLDER.at(
            component.span,
            name=component.name,
            other=first.name,
            hint="give each component a folder of its own",
            related=[Related("the other component", first.span)],
        )
    yield from _same_names(components, program.disk)


def _same_names(components: list[Component], disk: Disk) -> Iterator[Diagnostic]:
    """A component's name is unique in its workspace, except that the same component may be in several languages.
    Documents without a workspace count as one workspace. The component with the longer path is reported, because copies
    are called `speech2`, `speech (copy)` or `old/speech`."""

    def identity(component: Component) -> tuple[str, str, str]:
        root = root_above(os.path.dirname(component.path), disk)
        return component.name, component.language.name, "" if root is None else disk.real(root)

    names = Counter(component.name for component in components)
    same = [component for component in components if names[component.name] > 1]
    for other, component in repeated(sorted(same, key=lambda each: len(each.path)), identity):
        free = next(f"{component.name}{n}" for n in count(2) if f"{component.name}{n}" not in names)
        names[free] = 1
        yield codes.SAME_NAME.at(
            component.span,
            name=component.name,
            other=other.path,
            related=[Related("the other component", other.span)],
            hint=f"rename the copy: `component: {free}`",
        )


def _names(linked: LinkedComponent) -> Iterator[Diagnostic]:
    """Names are unique in a list, and so are the names of proxies in code."""
    for list_ in LISTS:
        names: dict[str, Port] = {}
        accessors: dict[str, Port] = {}
        for port in getattr(linked, list_):
            if port.interface.name == "CommonBehavior" and list_ == "implements":
                yield codes.COMMON_BEHAVIOR.at(port.use.span, hint="remove it", fixes=[removal(port.use.span)])
            if port.name in names:
                free = next(f"{port.name}{n}" for n in range(1, 1000) if f"{port.name}{n}" not in names)
                entry = f"{{{free}: {port.use.interface}}}"
                yield codes.DUPLICATE_PORT.at(
                    port.use.span,
                    name=port.name,
                    list=list_,
                    hint="remove it" if list_ != "requires" else f"write {entry}, or remove it",
                    related=[Related("the first one", names[port.name].use.span)],
                    fixes=[removal(port.use.span, safe=list_ != "requires" and port.use == names[port.name].use)],
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
                    hint=f"rename one of them: {{{port.name}2: {port.use.interface}}}",
                    related=[Related(f"'{other.name}'", other.use.span)],
                )


def _topics(linked: LinkedComponent) -> Iterator[Diagnostic]:
    """Topics are published and subscribed; what is published has no results."""
    for port in (*linked.publishes, *linked.subscribes):
        lost = [method.name for method in port.interface.methods if not method.can_be_published]
        if lost and not port.interface.is_topic:
            yield codes.PARTLY_PUBLISHED.at(port.use.span, name=port.interface.name, methods=", ".join(lost))
    for ports, done in ((linked.implements, "implemented"), (linked.requires, "required")):
        for port in ports:
            if port.interface.is_topic:
                yield codes.TOPIC_IMPLEMENTED.at(port.use.span, name=port.interface.name, done=done)


def _libraries(component: Component) -> Iterator[Diagnostic]:
    for libraries in grouped((library.entry, library) for library in component.libraries).values():
        if len(libraries) > 1:
            kinds = " and ".join(f"`{library.kind}`" for library in libraries)
            yield codes.LIBRARY_OF_TWO_KINDS.at(libraries[1].span, places=kinds, hint="write two elements")
    for library in component.libraries:
        is_numeric = all(re.fullmatch(_NUMBERS, part) for part in library.version.split(",")) and library.kind != LINK
        if library.version and library.kind != PIP and not is_numeric:
            yield codes.LIBRARY_VERSION.at(
                library.version_span, version=library.version.strip(), kind=f"`{library.kind}`"
            )
