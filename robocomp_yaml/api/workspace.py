"""Documents that belong together, read once."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.pipeline import Analysis, analyse

if TYPE_CHECKING:
    from robocomp_yaml.api.building import Built
    from robocomp_yaml.api.compiling import Compilation
    from robocomp_yaml.api.deploying import Deployment
    from robocomp_yaml.api.fixing import Fixing
    from robocomp_yaml.api.values import Values
    from robocomp_yaml.building.job import Event
    from robocomp_yaml.network.network import Network


class Workspace:
    """Documents as they were when `api.load` read them: what changes on the disk later is not seen.

    `documents` are the paths of those that were asked for; `documents_read` is how many were read, with those that
    they import. `analysis` is for rcyaml itself, and no part of the promise.
    """

    def __init__(
        self, paths: Sequence[str], include: Sequence[str], overlay: Mapping[str, bytes],
        on_read: Callable[[str], None] | None = None,
    ) -> None:  # fmt: skip
        self._paths, self._include, self._overlay = tuple(paths), tuple(include), overlay
        self.analysis: Analysis = analyse(self._paths, self._include, on_read or _ignore, overlay)

    @property
    def documents(self) -> tuple[str, ...]:
        return tuple(self.analysis.found.documents)

    @property
    def documents_read(self) -> int:
        return self.analysis.program.documents

    def check(self, *, environment: bool = False) -> list[Diagnostic]:
        """Everything that is wrong with the documents and with what belongs to them (the user's code, the flat
        configurations, the programs of deployments), sorted by place. `environment` also looks for the libraries that
        components name, for programs on PATH and for hosts."""
        found = [*self._on_disk(environment), *(self._missing() if environment else ())]
        return self.analysis.whole(found, environment=environment)

    def compile(
        self,
        *,
        output: str | None = None,
        targets: Sequence[str] = (),
        adopt: bool = False,
        merge: bool = False,
        standalone: bool = False,
    ) -> Compilation:
        """What compiling comes to; nothing is written before its `apply`. `output` is a folder to write below;
        `targets` limits what is written (`slice`, `python`, `cpp`, `config`, `docs`); `adopt` takes over files that
        rcyaml did not write, `merge` brings the user's files up to date."""
        from robocomp_yaml.api.compiling import Compilation

        return Compilation(
            self.analysis,
            self._paths,
            self._include,
            output,
            targets,
            adopt=adopt,
            merge=merge,
            standalone=standalone,
        )

    def build(
        self, *names: str, build_type: str = "Release", jobs: int | None = None, defines: Sequence[str] = (),
        report: Callable[[Event], None] | None = None,
    ) -> Built:  # fmt: skip
        """Builds the components that were asked for, or those NAMEs (a component's name, folder or document): those
        that are not what they are made of. `build_type` is CMake's, `jobs` how much is done at once, `defines`
        are variables for CMake (`NAME=VALUE`); `report` is told of each step. Builds what was compiled last, whatever
        the documents say now."""
        from robocomp_yaml.api import which
        from robocomp_yaml.api.building import build

        wanted = [which.component(name) for name in names]
        return build(self.analysis, wanted, build_type=build_type, jobs=jobs, defines=defines, report=report)

    def fix(self, *, unsafe: bool = False, environment: bool = False) -> Fixing:
        """What applying the fixes of diagnostics comes to: those that leave only one possible meaning, and with
        `unsafe` guesses too. Nothing is written before its `apply`."""
        from robocomp_yaml.api.fixing import Fixing

        def load(changed: Mapping[str, bytes]) -> Workspace:
            return Workspace(self._paths, self._include, {**self._overlay, **changed})

        return Fixing(self, load, self._paths, unsafe=unsafe, environment=environment)

    @property
    def networks(self) -> dict[str, Network]:
        """What the deployments come to, by the paths of their documents; those are left out whose errors leave no
        network."""
        documents = self.analysis.linker.documents.read
        return {documents[real].path: network for real, network in self.analysis.networks.items()}

    def network(self, path: str = "") -> Network:
        """The network of the deployment at a path, or of the only one that no other one includes. Raises Refused where
        there is none, or several; Faulty where its errors leave no network."""
        return self.networks[self._deployment_at(path)]

    def deployment(self, path: str = "", *, engine: str | None = None, lenient: bool = False) -> Deployment:
        """The same deployment as it is carried out: planned, brought up, watched and taken down. `engine` is what runs
        it (`local`, `icegrid`); without one, what its hosts call for. Faulty where the documents have errors; `lenient`
        lets those pass that leave the network readable, and where they do not, at a path, takes what runs of it."""
        from robocomp_yaml.api.deploying import Deployment

        document = path if path and lenient else self._deployment_at(path)
        return Deployment(self.analysis, document, engine, lenient=lenient)

    def draw(self, form: str = "text", path: str = "") -> str:
        """A picture in one of the forms of `rcyaml graph`: of the deployment at a path, or of what a folder has, which
        is its deployment or else its components. Raises Refused where there are several, or a document is none, and
        Faulty where errors leave nothing to show."""
        from robocomp_yaml.api.drawing import draw

        return draw(self.analysis, form, path or self._paths[0])

    def _deployment_at(self, path: str) -> str:
        """The document of the deployment that is meant, if it comes to a network."""
        program = self.analysis.program
        wanted = (
            {os.path.realpath(path)}
            if path
            else {real for real, linked in program.deployments.items() if not linked.is_included}
        )
        read = self.analysis.linker.documents.read
        found = [read[real].path for real in self.analysis.networks if real in wanted]
        if found:
            from robocomp_yaml.api.deployments import one_of

            return one_of(found)
        if any(document.kind == "ddsl" and (not path or real in wanted) for real, document in read.items()):
            raise Faulty(self.analysis.diagnostics, self.documents_read)
        raise Refused(f"there is no deployment at '{path}'" if path else "there is no deployment")

    def values(self, path: str = "") -> Values:
        """The values of a component's parameters: `path` is the document of the values or of the component, its
        folder, the component's name, or nothing where there is only one. Raises Refused where there is none."""
        from robocomp_yaml.api import which
        from robocomp_yaml.api.values import Values

        real = {os.path.realpath(known) for known in self._overlay}
        document = path if os.path.realpath(path) in real else which.values(path)
        return Values(document, self._include, self._overlay)

    def _on_disk(self, environment: bool) -> Iterator[Diagnostic]:
        """What files say that are no documents: each component's `etc/config` and code, and the executables of
        deployments."""
        analysis = self.analysis
        if analysis.program.components:
            from robocomp_yaml.emit import ports
            from robocomp_yaml.emit.specific import existing_code

            yield from ports.clashes(analysis.program.components.values(), analysis.disk)
            if existing_code.has_code(analysis.program):
                from robocomp_yaml.api import made_already

                told = None if self._overlay else made_already.told_of_code(self._paths, self._include)
                if told is not None:
                    yield from told
                else:
                    yield from existing_code.check(analysis.program, analysis.diagnostics, analysis.linker)
        if analysis.networks:
            from robocomp_yaml.check.networks import of_environment

            yield from of_environment(analysis.derived, environment=environment)

    def _missing(self) -> Iterator[Diagnostic]:
        from robocomp_yaml.emit.environment import missing

        return missing(self.analysis.program.components.values(), self.analysis.linker.workspace_of)


def _ignore(path: str) -> None:
    """Nobody wants to be told of what is read."""
