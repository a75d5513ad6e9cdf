"""Components of one workspace have names of their own."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import count

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.link.workspace import root_above


def check(program: Program) -> Iterator[Diagnostic]:
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
