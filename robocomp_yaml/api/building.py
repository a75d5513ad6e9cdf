"""Components built, as data."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.building import builder, stamps
from robocomp_yaml.building.inputs import Inputs
from robocomp_yaml.building.job import FAILED, RELEASE, TYPES, Event, Job, Result
from robocomp_yaml.building.unit import Unit, unit_of
from robocomp_yaml.deploy.outdated import outdated_components
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.link.program import LinkedComponent
    from robocomp_yaml.pipeline import Analysis


class Built(msgspec.Struct, frozen=True):
    """What came of a build: its components in the order of their documents, what compilers and others said, and the
    seconds of processors that it took."""

    type: str
    components: tuple[Result, ...]
    diagnostics: tuple[Diagnostic, ...]
    cpu: float

    @property
    def has_errors(self) -> bool:
        return has_errors(self.diagnostics) or any(one.state == FAILED for one in self.components)


def units(analysis: Analysis, documents: Iterable[str] = ()) -> list[Unit]:
    """The components of these documents, but for those that cannot be read; without any, all that were asked for."""
    return [_unit(analysis, linked) for linked in _components(analysis, documents)]


def every_unit(analysis: Analysis) -> list[Unit]:
    """All components that were read."""
    return [_unit(analysis, linked) for linked in analysis.program.components.values()]


def _unit(analysis: Analysis, linked: LinkedComponent) -> Unit:
    return unit_of(linked, analysis.linker.workspace_of(linked.component.path))


def _components(analysis: Analysis, documents: Iterable[str] = ()) -> list[LinkedComponent]:
    components = analysis.program.components
    wanted = [os.path.realpath(path) for path in documents] or analysis.program.requested_components()
    found = [components[real] for real in wanted if real in components]
    return sorted(found, key=lambda linked: linked.component.path)


def _unread(analysis: Analysis, documents: Iterable[str]) -> list[Diagnostic]:
    """What is wrong with documents that cannot be read: the others are built all the same."""
    lost = {path for path in documents if os.path.realpath(path) not in analysis.program.components}
    return [told for told in analysis.diagnostics if told.span.file in lost]


def build(
    analysis: Analysis, documents: Sequence[str], *, build_type: str = RELEASE, jobs: int | None = None,
    defines: Sequence[str] = (), report: Callable[[Event], None] | None = None,
) -> Built:  # fmt: skip
    if build_type not in TYPES:
        meant = suggest(build_type, TYPES)
        raise Refused(
            f"there is no build type '{build_type}'; " + (f"did you mean '{meant}'?" if meant else ", ".join(TYPES))
        )
    before = _cpu()

    def told(event: Event) -> None:
        if report is not None:
            report(analysis.veiled([event])[0] if isinstance(event, Diagnostic) else event)

    job = Job(build_type, jobs or len(os.sched_getaffinity(0)), told, tuple(defines))
    components = _components(analysis, documents)
    if documents and not components:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    job.tell([*_unread(analysis, documents), *outdated_components(components)])
    found = builder.build(job, [_unit(analysis, linked) for linked in components])
    return Built(build_type, tuple(found), tuple(analysis.veiled(job.told)), round(_cpu() - before, 2))


def to_build(analysis: Analysis) -> list[str]:
    """The components whose programs are there, and are older than what they are made of."""
    inputs = Inputs()
    return [
        unit.name
        for unit in units(analysis)
        if unit.language.build and (found := stamps.look(unit, inputs)).is_there and found.changed
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
    analysis: Analysis,
    documents: Sequence[str],
    build_type: str | None = None,
    *,
    everything: bool = False,
) -> list[str]:
    """Takes the build trees of these components away; the folders that are gone. Of `everything` that was asked for,
    whole trees."""
    return builder.clean(units(analysis, documents), everything, build_type)
