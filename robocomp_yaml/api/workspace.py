"""A workspace: documents that belong together, read once."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robocomp_yaml.api.refusals import require_paths
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.discover import kind_of

if TYPE_CHECKING:
    from robocomp_yaml.api.building import Built
    from robocomp_yaml.api.compiling import Compilation
    from robocomp_yaml.api.deploying import Deployment
    from robocomp_yaml.api.fixing import Fixing
    from robocomp_yaml.api.renaming import Renaming
    from robocomp_yaml.api.values import Values
    from robocomp_yaml.building.job import BuildEvent
    from robocomp_yaml.emit.graphs.picture import Picture
    from robocomp_yaml.memory import Memory
    from robocomp_yaml.network.network import Network
    from robocomp_yaml.source.disk import Files


class Workspace:
    """Documents as `api.load` read them: later changes on the disk are not seen.

    `documents` are the paths of the requested documents; `documents_read` is how many were read, imports included.
    `analysis` is for rcyaml itself, and not part of the promise.
    """

    def __init__(
        self, paths: Sequence[str], include: Sequence[str], overlay: Mapping[str, bytes],
        on_read: Callable[[str], None] | None = None, memory: Memory | None = None, files: Files | None = None,
    ) -> None:  # fmt: skip
        self._paths, self._include, self._overlay, self._memory = tuple(paths), tuple(include), overlay, memory
        self.analysis: Analysis = analyse(self._paths, self._include, on_read, overlay, memory, files)

    @property
    def documents(self) -> tuple[str, ...]:
        return tuple(self.analysis.discovered.documents)

    @property
    def documents_read(self) -> int:
        return self.analysis.program.documents + len(self.analysis.discovered.scripts)

    def check(self, *, environment: bool = False, code: bool = False) -> list[Diagnostic]:
        """All diagnostics, sorted by location: of the documents, of the user's code, of flat configs and of the
        programs of deployments. `environment` also checks that the libraries which components name, the programs on
        PATH and the hosts are available. `code` also runs the type checkers of languages over the user's code; it
        raises Refused if one is not installed."""
        found = [*self._on_disk(environment), *(self._missing() if environment else ())]
        if code and self.analysis.program.components:
            from robocomp_yaml.api import code_checks

            found += code_checks.check(self.analysis, found)
        return self.analysis.complete(found, environment=environment)

    def compile(
        self, *, output: str | None = None, targets: Sequence[str] = (), adopt: bool = False, merge: bool = False,
        standalone: bool = False,
    ) -> Compilation:  # fmt: skip
        """The compile of the documents; nothing is written before its `apply`. `output` is a folder to write below;
        `targets` limits what is written (`slice`, `python`, `cpp`, `config`, `docs`); `adopt` overwrites files that
        rcyaml did not write and keeps backups, `merge` merges changes into the user's files."""
        from robocomp_yaml.api.compile_stamps import CompileArguments
        from robocomp_yaml.api.compiling import Compilation

        require_paths(*([output] if output is not None else []))
        arguments = CompileArguments(self._paths, self._include, output, targets, standalone)
        return Compilation(self.analysis, arguments, adopt=adopt, merge=merge)

    def build(
        self, *names: str, build_type: str = "Release", jobs: int | None = None, defines: Sequence[str] = (),
        report: Callable[[BuildEvent], None] | None = None,
    ) -> Built:  # fmt: skip
        """Builds the requested components, or those NAMEs (a component's name, folder or document), unless they are up
        to date. `build_type` is that of CMake, `jobs` the number of parallel steps, `defines` are variables for CMake
        (`NAME=VALUE`); `report` gets each event. Builds what was compiled last, whatever the documents say now. Raises
        Refused if a name or the build type is unknown, Faulty if a document cannot be read."""
        from robocomp_yaml.api import which
        from robocomp_yaml.api.building import build

        chosen = [which.component(name) for name in names]
        return build(self.analysis, chosen, build_type=build_type, jobs=jobs, defines=defines, report=report)

    def fix(self, *, unsafe: bool = False, environment: bool = False, code: bool = False) -> Fixing:
        """The fixes of the diagnostics: those that leave only one possible meaning, and with `unsafe` also guesses.
        Nothing is written before its `apply`."""
        from robocomp_yaml.api.fixing import Fixing

        return Fixing(self, self.with_texts, self._paths, unsafe=unsafe, environment=environment, code=code)

    def rename(self, what: str, name: str) -> Renaming:
        """Renames a name everywhere: in documents, configurations and the user's code. `what` is its location
        (`FILE:LINE:COLUMN`) or the name itself: `Speech`, `Speech.say`, `host:left`. Nothing is written before the
        `apply` of the result. Raises Refused if the name is unknown, NotRenamed, a Refused, if the new one is taken or
        something would not mean the same any more; Faulty if documents have errors that hide what they mean."""
        from robocomp_yaml.api.renaming import Renaming, name_at, name_called
        from robocomp_yaml.naming.analysis import names_of

        names = names_of(self.analysis)
        path, *place = what.rsplit(":", 2)
        is_place = len(place) == 2 and all(one.isdigit() for one in place)
        defined = name_at(names, self.analysis, path, *map(int, place)) if is_place else name_called(names, what)
        return Renaming(self, self.with_texts, self._paths, defined, name, names)

    def with_texts(self, changed: Mapping[str, bytes]) -> Workspace:
        """The same documents, some with other texts."""
        memory = self._memory.fork() if self._memory is not None else None
        return Workspace(self._paths, self._include, {**self._overlay, **changed}, memory=memory)

    @property
    def networks(self) -> dict[str, Network]:
        """The networks of the deployments, by the paths of their documents. A deployment whose errors leave no network
        is missing."""
        documents = self.analysis.documents
        return {documents[real].path: network for real, network in self.analysis.networks.items()}

    def network(self, path: str = "") -> Network:
        """The network of the deployment at a path, or of the only one that no other one includes. Raises Refused if
        there is none, or more than one; Faulty if errors leave no network."""
        return self.networks[self._deployment_at(path)]

    def deployment(self, path: str = "", *, engine: str | None = None, lenient: bool = False) -> Deployment:
        """The deployment at a path, to be planned, started, watched and stopped. `engine` is `local` or `icegrid`; by
        default, its hosts decide. Raises Faulty if the documents have errors. `lenient` accepts errors that leave the
        network readable; if they do not, and a path is passed, the network is that of the running processes."""
        from robocomp_yaml.api.deploying import Deployment

        require_paths(path)
        document = path if path and lenient else self._deployment_at(path)
        return Deployment(self.analysis, document, engine, lenient=lenient)

    def draw(self, form: str = "text", path: str = "") -> str:
        """A picture in one of the formats of `rcyaml graph`: of the deployment at a path, or of what a folder contains:
        its deployment, or else its components. Raises Refused if there is more than one deployment, or the path is no
        deployment, and Faulty if errors leave nothing to draw."""
        from robocomp_yaml.emit.graphs.forms import draw, forms

        path = path or self._paths[0]
        # The plug-ins are those of the workspace that contains the document, or the documents of the folder.
        inside = os.path.join(path, "") if os.path.isdir(path) else path
        plugins = self.analysis.workspaces.of(inside).plugins
        if form not in forms(plugins):
            raise Refused(f"unknown picture '{form}'; choose one of {', '.join(forms(plugins))}")
        picture = self.picture(path)
        if picture is None:
            raise Faulty(self.analysis.diagnostics, self.documents_read)
        return draw(picture, form, plugins)

    def picture(self, path: str) -> Picture | None:
        """The content of a picture, for rcyaml itself. None if the document, or everything in the folder, has too many
        errors."""
        from robocomp_yaml.api.which import deployments_of, only_deployment
        from robocomp_yaml.emit.graphs import of_components

        networks, program = self.analysis.networks, self.analysis.program
        if not os.path.isdir(path):
            network = networks.get(os.path.realpath(path))
            if network is None and kind_of(path) != "ddsl":
                raise Refused(f"'{path}' is neither a deployment document (NAME.ddsl.yaml) nor a folder")
            return self._with_positions(network, path) if network is not None else None
        readable = [one for one in deployments_of(path, analysis=self.analysis) if os.path.realpath(one) in networks]
        if readable:
            chosen = only_deployment(readable)
            return self._with_positions(networks[os.path.realpath(chosen)], chosen)
        if program.deployments or not program.components:
            return None
        return of_components.picture_of(os.path.basename(os.path.abspath(path)), program.components.values())

    def picture_of_components(self, name: str) -> Picture:
        """The picture of all components, for rcyaml itself: what they require and implement, and their topics."""
        from robocomp_yaml.emit.graphs import of_components

        return of_components.picture_of(name, self.analysis.program.components.values(), self.analysis.diagnostics)

    def _with_positions(self, network: Network, document: str) -> Picture:
        """The picture of a network, with the positions that a person chose for its nodes."""
        from robocomp_yaml.api.editing import layout
        from robocomp_yaml.emit.graphs import of_network

        picture = of_network.picture_of(network, self.analysis.diagnostics)
        picture.positions = layout.read(document)
        return picture

    def _deployment_at(self, path: str) -> str:
        """The path of the deployment that is meant, if errors leave a network."""
        require_paths(path)
        deployments = self.analysis.program.deployments
        top = {real for real, linked in deployments.items() if not linked.is_included}
        candidates = {os.path.realpath(path)} if path else top
        read = self.analysis.documents
        found = [read[real].path for real in self.analysis.networks if real in candidates]
        if found:
            from robocomp_yaml.api.which import only_deployment

            return only_deployment(found)
        if any(document.kind == "ddsl" and (not path or real in candidates) for real, document in read.items()):
            raise Faulty(self.analysis.diagnostics, self.documents_read)
        raise Refused(f"'{path}' is not a deployment" if path else "the loaded documents contain no deployment")

    def values(self, path: str = "") -> Values:
        """The values of a component's parameters: `path` is the document of the values or of the component, its folder,
        or the component's name; by default, the only one. Raises Refused if there is none."""
        from robocomp_yaml.api import which
        from robocomp_yaml.api.values import Values

        require_paths(path)
        real = {os.path.realpath(known) for known in self._overlay}
        document = path if os.path.realpath(path) in real else which.values(path)
        return Values(document, self._include, self._overlay)

    def _on_disk(self, environment: bool) -> Iterator[Diagnostic]:
        """The diagnostics of files that are no documents: each component's `etc/config` and code, the programs of
        deployments, and mock scripts."""
        analysis = self.analysis
        if analysis.program.components:
            from robocomp_yaml.addresses import clashes
            from robocomp_yaml.check.flat.configs import missing, replaced
            from robocomp_yaml.emit.specific import existing_code

            program = analysis.program

            def of_flat_configs() -> list[Diagnostic]:
                components = program.components.values()
                return [*clashes.clashes(components, program.disk), *replaced(program, components)]

            part = "flat configs", analysis.discovered.documents
            yield from program.memory.result(part, (analysis.undeployed,), of_flat_configs)
            yield from missing(program)
            if existing_code.has_code(analysis.program):
                from robocomp_yaml.api import compile_stamps

                kept = None if self._overlay else compile_stamps.diagnostics_of_code(self._paths, self._include)
                ports = analysis.addresses.table
                folders = existing_code.changed(analysis.program, kept[1]) if kept is not None else None
                if kept is not None and folders is not None:
                    yield from (one for one in kept[0] if not one.span.file.startswith(tuple(folders)))
                if folders != []:
                    yield from existing_code.check(
                        analysis.program, analysis.diagnostics, analysis.workspaces, ports, folders
                    )
        if analysis.networks:
            from robocomp_yaml.check.networks import check_environment

            yield from check_environment(analysis.derived, environment=environment)
        if analysis.discovered.scripts:
            from robocomp_yaml.api import mock_scripts

            yield from mock_scripts.check(analysis, self._include)

    def _missing(self) -> Iterator[Diagnostic]:
        from robocomp_yaml.emit.environment import missing

        return missing(self.analysis.program.components.values(), self.analysis.workspaces.of)
