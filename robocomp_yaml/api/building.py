"""Building components: the results as data."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.api.refusals import require
from robocomp_yaml.building import builder
from robocomp_yaml.building.job import FAILED, RELEASE, TYPES, BuildEvent, BuildResult, Job
from robocomp_yaml.building.unit import Unit, unit_of
from robocomp_yaml.deploy.outdated import outdated_components
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.grouping import grouped
from robocomp_yaml.source.discover import kind_of, of_kind

if TYPE_CHECKING:
    from robocomp_yaml.deploy.stale import StaleComponent
    from robocomp_yaml.link.program import LinkedComponent
    from robocomp_yaml.pipeline import Analysis


class Built(msgspec.Struct, frozen=True):
    """The result of a build: its components in the order of their documents, the diagnostics of compilers and of
    rcyaml, and the CPU time in seconds."""

    type: str
    components: tuple[BuildResult, ...]
    diagnostics: tuple[Diagnostic, ...]
    cpu: float

    @property
    def has_errors(self) -> bool:
        return has_errors(self.diagnostics) or any(one.state == FAILED for one in self.components)


def units(analysis: Analysis, components: Iterable[LinkedComponent] | None = None) -> list[Unit]:
    """These components as they are built; by default, the requested ones."""
    chosen = _components(analysis) if components is None else components
    return [unit_of(linked, analysis.workspaces.of(linked.component.path)) for linked in chosen]


def _components(analysis: Analysis, documents: Iterable[str] = ()) -> list[LinkedComponent]:
    """The components of these documents, which may be deployments; by default, the requested ones. Those of a
    deployment are all that it starts, also on other hosts, to which `deploy push` brings what is built here."""
    components, deployments = analysis.program.components, analysis.program.deployments
    chosen = [os.path.realpath(path) for path in documents] or analysis.program.requested_components()
    linked = {real: components[real] for real in chosen if real in components}
    started = [one for real in chosen if real in deployments for one in deployments[real].instances.values()]
    every = {*linked.values(), *(one.component for one in started if one.component is not None)}
    return sorted(every, key=lambda linked: linked.component.path)


def _unread(analysis: Analysis, documents: Iterable[str]) -> list[Diagnostic]:
    """The diagnostics of documents that cannot be read. The other components are built all the same."""
    known = {*analysis.program.components, *analysis.program.deployments}
    unread = {path for path in documents if os.path.realpath(path) not in known}
    return [one for one in analysis.diagnostics if one.span.file in unread]


def build(
    analysis: Analysis, documents: Sequence[str], *, build_type: str = RELEASE, jobs: int | None = None,
    defines: Sequence[str] = (), report: Callable[[BuildEvent], None] | None = None,
) -> Built:  # fmt: skip
    """Builds the components of these documents, by default the requested ones. `jobs` is how many steps run at once, by
    default one a processor; `report` gets each event. Raises Refused if the build type is unknown, Faulty if none of
    the documents can be read."""
    require("build type", build_type, TYPES)
    before = _cpu()

    def forward(event: BuildEvent) -> None:
        if report is not None:
            report(analysis.redacted([event])[0] if isinstance(event, Diagnostic) else event)

    job = Job(build_type, jobs or len(os.sched_getaffinity(0)), forward, tuple(defines))
    components = _components(analysis, documents)
    if documents and not components:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    job.add([*_unread(analysis, documents), *outdated_components(components)])
    results = builder.build(job, units(analysis, components))
    return Built(build_type, tuple(results), tuple(analysis.redacted(job.diagnostics)), round(_cpu() - before, 2))


def build_stale(
    analysis: Analysis, stale: Iterable[StaleComponent], build_type: str | None = None,
    report: Callable[[BuildEvent], None] | None = None,
) -> list[Built]:  # fmt: skip
    """Builds stale components, each with its last build type unless one is set. Returns one result for each type."""
    by_type = grouped((build_type or one.look.type or RELEASE, one.unit.document) for one in stale)
    return [build(analysis, paths, build_type=type_, report=report) for type_, paths in by_type.items()]


def _cpu() -> float:
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


def documents(names: Sequence[str]) -> list[str]:
    """The documents of components, by name, folder or document, and those of deployments, which stand for all that they
    start; by default, all components below the working folder. Raises Refused if a name is unknown."""
    from robocomp_yaml.api import which

    paths: dict[str, None] = {}
    for name in names or (".",):
        below = of_kind(name, "cdsl") if os.path.isdir(name) else []
        if kind_of(name) == "ddsl" and os.path.isfile(name):
            below = [name]
        paths |= dict.fromkeys(below or ([which.component(name)] if names else []))
    return list(paths)


def clean(
    analysis: Analysis, documents: Sequence[str], build_type: str | None = None, *, everything: bool = False
) -> list[str]:
    """Removes the build trees of these components, or whole trees if they are `everything` that is built there. Returns
    the removed folders."""
    return builder.clean(units(analysis, _components(analysis, documents)), everything, build_type)
