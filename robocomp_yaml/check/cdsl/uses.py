"""What a component's own code needs, as far as the document alone says."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.diag.codes import uses as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.component import LINK, PIP, Component, Library

_NUMBERS = r" *(>=|<=|==|=|>|<)? *\d+(\.\d+)* *"


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        yield from _libraries(linked.component)


def _libraries(component: Component) -> Iterator[Diagnostic]:
    by_entry: dict[int, list[Library]] = {}
    for library in component.libraries:
        by_entry.setdefault(library.entry, []).append(library)
    for libraries in by_entry.values():
        if len(libraries) > 1:
            places = " and ".join(f"`{library.kind}`" for library in libraries)
            yield codes.TWO_PLACES.at(libraries[1].span, places=places, hint="write two entries")
    for library in component.libraries:
        plain = all(re.fullmatch(_NUMBERS, part) for part in library.version.split(",")) and library.kind != LINK
        if library.version and library.kind != PIP and not plain:
            yield codes.VERSION.at(library.version_span, version=library.version.strip(), kind=f"`{library.kind}`")
