"""A build: what is asked for, what is told meanwhile, and what came of it."""

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
    """What came of a component: its `state` is `built`, `up to date` or `failed`; `cpu` are the seconds of processors
    that it took, as far as they can be told from those of others."""

    name: str
    language: str
    folder: str
    program: str
    state: str
    cpu: float = 0.0


class BuildStep(msgspec.Struct, frozen=True):
    """How far a build is: `done` of `total` steps, and what is being done."""

    done: int
    total: int
    what: str


BuildEvent = BuildStep | Diagnostic | BuildResult


class ComponentBuild(msgspec.Struct, frozen=True):
    """What a language's build made of a component; `read` are files that it read, besides those that are known."""

    is_built: bool
    cpu: float = 0.0
    read: tuple[str, ...] = ()


class Job(msgspec.Struct):
    """`defines` are what CMake is told with -D. `told` are the diagnostics so far; all that is new goes to `report`,
    too."""

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
        """Says why a component is not built, where no compiler has."""
        self.add([codes.FAILED.at(Span(unit.document), name=unit.name, reason=reason, hint=hint, more="\n".join(more))])


Builder = Callable[[Job, list[Unit]], Mapping[Unit, ComponentBuild]]
"""What a language's part `building` has as `build`: makes all of these, and goes on where one fails."""
