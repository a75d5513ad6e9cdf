"""A build: its options, its events and its results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import msgspec

from robocomp_yaml.building.processes import Processes
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.diag.codes import building as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span

BUILT, CURRENT, FAILED = "built", "up to date", "failed"
RELEASE = "Release"
TYPES = (RELEASE, "Debug", "RelWithDebInfo", "MinSizeRel")


class BuildResult(msgspec.Struct, frozen=True):
    """The result of a component: its `state` is `built`, `up to date` or `failed`; `cpu` is its CPU time in seconds, as
    far as it can be measured by component."""

    name: str
    language: str
    folder: str
    program: str
    state: str
    cpu: float = 0.0


class BuildStep(msgspec.Struct, frozen=True):
    """The progress of a build: `done` of `total` steps, and the current step."""

    done: int
    total: int
    what: str


BuildEvent = BuildStep | Diagnostic | BuildResult


class ComponentBuild(msgspec.Struct, frozen=True):
    """What the build of a language did with a component; `read` are files that it read besides the known inputs."""

    is_built: bool
    cpu: float = 0.0
    read: tuple[str, ...] = ()


class Job(msgspec.Struct):
    """A running build. `defines` are the -D options for CMake. `diagnostics` are those so far; `report` gets each new
    event."""

    type: str
    jobs: int
    report: Callable[[BuildEvent], None]
    defines: tuple[str, ...] = ()
    processes: Processes = msgspec.field(default_factory=Processes)
    diagnostics: list[Diagnostic] = []

    def add(self, diagnostics: Iterable[Diagnostic]) -> None:
        for one in diagnostics:
            if one not in self.diagnostics:
                self.diagnostics.append(one)
                self.report(one)

    def add_failure(self, unit: Unit, reason: str, *, hint: str = "", more: Iterable[str] = ()) -> None:
        """Reports why a component is not built, if no compiler did."""
        self.add([codes.FAILED.at(Span(unit.document), name=unit.name, reason=reason, hint=hint, more="\n".join(more))])


Builder = Callable[[Job, list[Unit]], Mapping[Unit, ComponentBuild]]
"""The `build` of a language's part `building`: builds these components, and continues if one fails."""
