"""Parameters that are declared already: by a PDSL of 2011, or by a document that the user wrote."""

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
"""The types of plain parameters by path."""


def types(document: object) -> Types:
    """Return the types of the plain parameters of a PDSL document, those in groups included. `document` is its data."""
    return dict(_plain(document.get("parameters"), "")) if isinstance(document, dict) else {}


def beside(component: str) -> Iterator[str]:
    """Yield the PDSL documents in a component's folder that refer to the component."""
    folder = os.path.dirname(component)
    for path in (os.path.join(folder, name) for name in names_in(folder) if kind_of(name) == "pdsl"):
        component_path = component_in(path)
        if component_path and os.path.realpath(os.path.join(folder, component_path)) == os.path.realpath(component):
            yield path


def of_document(path: str) -> Types:
    """Return the types of the plain parameters of the PDSL document at a path."""
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
    """Return the plans of declared parameters, with the declared types. The settings of the others become properties of
    the configs."""
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
