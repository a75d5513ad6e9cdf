"""Completion of paths: documents that other documents name."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robocomp_yaml.api.completing.places import TypedPlace
from robocomp_yaml.api.completing.proposal import PATH, Proposal
from robocomp_yaml.api.completing.values import named_by, parameters_for
from robocomp_yaml.link.program import Program
from robocomp_yaml.source.disk import names_in


def paths(kind: str, path: str, place: TypedPlace, program: Program) -> Iterator[Proposal]:
    """The paths that can stand at a place of a document of this kind."""
    if place.is_key:
        return
    folder = os.path.dirname(path)
    match kind, place.keys:
        case "cdsl", ("parameters",):
            specified = (one.document for one in program.parameters.values())
            yield from _relative((one.path for one in specified if one is not None), folder, "parameters")
        case "cdsl", ("statemachine",):
            yield from _relative(
                (os.path.join(folder, name) for name in sorted(names_in(folder)) if name.endswith(".scxml")), folder,
                "state machine",
            )  # fmt: skip
        case "config", ("extends", ""):
            own = program.values.get(path)
            documents = (
                one.document.path for one in program.values.values()
                if one is not own and (own is None or one.parameters is own.parameters)
            )  # fmt: skip
            yield from _relative((one for one in documents if one != path), folder, "values")
        case "ddsl", ("components", entry, "config"):
            component = named_by(place, "components", entry)
            linked = parameters_for(program, path, component) if component else None
            if linked is not None and linked.component is not None:
                values = (one.document.path for one in program.values.values() if one.parameters is linked)
                yield from _relative(values, os.path.dirname(linked.component.component.path), "values")
        case "ddsl", ("include", _) | ("groups", _, "include"):
            documents = (one.deployment.path for one in program.deployments.values())
            yield from _relative((one for one in documents if one != path), folder, "deployment")


def _relative(found: Iterable[str], folder: str, says: str) -> Iterator[Proposal]:
    """Paths relative to a folder, those nearby first."""
    shown = {os.path.relpath(path, folder) for path in found}
    yield from (Proposal(one, PATH, says) for one in sorted(shown, key=lambda one: (one.count(os.pardir), one)))
