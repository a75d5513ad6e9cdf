"""Parameters that somebody declared already: a PDSL of 2011, or a document that the user wrote."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence

from robocomp_yaml.legacy.settings.plan import Config, ParameterPlan
from robocomp_yaml.legacy.settings.planning import keep_as_properties
from robocomp_yaml.legacy.settings.shapes import ScalarShape
from robocomp_yaml.parameters.types import BASIC_TYPES
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.disk import names_in
from robocomp_yaml.source.heading import component_in, root_of

Types = dict[str, str]
"""The types of plain parameters by their paths."""


def types(document: object) -> Types:
    """The plain parameters of the data of a PDSL document, groups opened."""
    return dict(_plain(document.get("parameters"), "")) if isinstance(document, dict) else {}


def beside(component: str) -> Iterator[str]:
    """The PDSL documents in the folder of a component's document that name it as theirs."""
    folder = os.path.dirname(component)
    for path in (os.path.join(folder, name) for name in names_in(folder) if kind_of(name) == "pdsl"):
        said = component_in(path)
        if said and os.path.realpath(os.path.join(folder, said)) == os.path.realpath(component):
            yield path


def of_document(path: str) -> Types:
    """The same of a file."""
    root = root_of(path)
    return types(root.data) if root is not None else {}


def _plain(members: object, prefix: str) -> Iterator[tuple[str, str]]:
    for name, body in members.items() if isinstance(members, dict) else ():
        if isinstance(body, dict) and "group" in body:
            yield from _plain(body["group"], f"{prefix}{name}.")
        else:
            kind = body.get("type") if isinstance(body, dict) else body
            if kind in BASIC_TYPES:
                yield f"{prefix}{name}", str(kind)


def fitted(plans: Sequence[ParameterPlan], known: Mapping[str, str], configs: Sequence[Config]) -> list[ParameterPlan]:
    """The plans that are declared, by their declared types; what the others hold goes back to the configs."""
    kept = []
    for plan in plans:
        kind = known.get(".".join(plan.path))
        if plan.built_in and plan.spelled is None:
            kept.append(plan)
        elif kind is not None and plan.spelled is None and isinstance(plan.shape, ScalarShape):
            plan.shape, plan.guessed = ScalarShape(kind), ""
            kept.append(plan)
        else:
            keep_as_properties(plan, configs)
    return kept
