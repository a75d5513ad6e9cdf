"""Components built, as data."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.api.refusals import require
from robocomp_yaml.building import builder, stamps
from robocomp_yaml.building.inputs import Inputs
from robocomp_yaml.building.job import FAILED, RELEASE, TYPES, BuildEvent, BuildResult, Job
from robocomp_yaml.building.unit import Unit, unit_of
from robocomp_yaml.deploy.outdated import outdated_components
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.link.program import LinkedComponent
    from robocomp_yaml.pipeline import Analysis


class Built(msgspec.Struct, frozen=True):
    """What came of a build: its components in the order of their documents, what compilers and others said, and the
    seconds of processors that it took."""

    type: str
    components: tuple[BuildResult, ...]
    diagnostics: tuple[Diagnostic, ...]
    cpu: float

    @property
    def has_errors(self) -> bool:
        return has_errors(self.diagnostics) or any(one.state == FAILED for one in self.components)


def units(analysis: Analysis, components: Iterable[LinkedComponent] | None = None) -> list[Unit]:
    """These components as they are built; by default, all that were asked for."""
    chosen = _components(analysis) if components is None else components
    return [unit_of(linked, analysis.linker.workspace_of(linked.component.path)) for linked in chosen]


def _components(analysis: Analysis, documents: Iterable[str] = ()) -> list[LinkedComponent]:
    components = analysis.program.components
    wanted = [os.path.realpath(path) for path in documents] or analysis.program.asked_components()
    found = [components[real] for real in wanted if real in components]
    return sorted(found, key=lambda linked: linked.component.path)


def _unread(analysis: Analysis, documents: Iterable[str]) -> list[Diagnostic]:
    """What is wrong with documents that cannot be read: the others are built all the same."""
    lost = {path for path in documents if os.path.realpath(path) not in analysis.program.components}
    return [told for told in analysis.diagnostics if told.span.file in lost]


def build(
    analysis: Analysis, documents: Sequence[str], *, build_type: str = RELEASE, jobs: int | None = None,
    defines: Sequence[str] = (), report: Callable[[BuildEvent], None] | None = None,
) -> Built:  # fmt: skip
    require("build type", build_type, TYPES)
    before = _cpu()

    def told(event: BuildEvent) -> None:
        if report is not None:
            report(analysis.redacted([event])[0] if isinstance(event, Diagnostic) else event)

    job = Job(build_type, jobs or len(os.sched_getaffinity(0)), told, tuple(defines))
    components = _components(analysis, documents)
    if documents and not components:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    job.add([*_unread(analysis, documents), *outdated_components(components)])
    found = builder.build(job, units(analysis, components))
    return Built(build_type, tuple(found), tuple(analysis.redacted(job.diagnostics)), round(_cpu() - before, 2))


def to_build(analysis: Analysis) -> list[str]:
    """The components whose programs are there, and are older than what they are made of."""
    inputs = Inputs()
    return [
        unit.name
        for unit in units(analysis)
        if unit.language.build and (found := stamps.inspect(unit, inputs)).is_there and found.changed
    ]


def _cpu() -> float:
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


def documents(names: Sequence[str]) -> list[str]:
    """The documents of the components that are meant: by name, folder or document; without any, all below the working
    folder. Raises Refused."""
    from robocomp_yaml.api import which

    found: dict[str, None] = {}
    for name in names or (".",):
        below = of_kind(name, "cdsl") if os.path.isdir(name) else []
        found |= dict.fromkeys(below or ([which.component(name)] if names else []))
    return list(found)


def clean(
    analysis: Analysis, documents: Sequence[str], build_type: str | None = None, *, everything: bool = False
) -> list[str]:
    """Takes the build trees of these components away; the folders that are gone. Of `everything` that was asked for,
    whole trees."""
    return builder.clean(units(analysis, _components(analysis, documents)), everything, build_type)
