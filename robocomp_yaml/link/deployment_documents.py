"""Follows and links the documents that deployments name: components, configurations and other deployments."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import did_you_mean, meaning, suggest
from robocomp_yaml.digraph import postorder
from robocomp_yaml.link import deployment_groups
from robocomp_yaml.link import deployment_paths as paths
from robocomp_yaml.link.deployment_names import DeploymentNames
from robocomp_yaml.link.deployments import LinkedDeployment
from robocomp_yaml.link.documents import Document, Documents
from robocomp_yaml.link.expand_deployments import Expansion
from robocomp_yaml.link.knot import tie
from robocomp_yaml.link.program import NamedDocument, Tables, UsedValues
from robocomp_yaml.model.deployment import COMPONENT, INDEX, PROCESS, Deployment, Entry
from robocomp_yaml.model.located import Text
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.discover import of_kind
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.recall import recalled

_COMPONENT = pattern(r"(?m)^component:[ \t]*[\"']?(\w+)")


class DeploymentDocuments(msgspec.Struct):
    """Follows deployments to the documents that they name, and links them. `disk` records what is requested to follow
    them: what other documents depend on has none of it."""

    documents: Documents
    tables: Tables
    root_of: Callable[[str], str]
    disk: Disk
    diagnostics: list[Diagnostic] = []
    used: dict[UsedValues, None] = {}
    models: dict[str, Deployment] = {}

    def follow(self, document: Document) -> Sequence[NamedDocument]:
        """The documents that a deployment names."""
        model, memory = document.model, self.documents.memory
        root = self.root_of(document.path)
        assert isinstance(model, Deployment)
        self.models[document.real] = model

        def make(disk: Disk) -> tuple[list[NamedDocument], dict[UsedValues, None], list[Diagnostic]]:
            found = _NamedByDeployment(model, disk, root)  # not of this run: other deployments may name the same
            return list(found.run()), found.used, found.diagnostics

        named, used, diagnostics = recalled(memory, self.disk, ("named", document.real), (model, root), make)
        self.used |= used
        self.diagnostics += diagnostics
        return named

    def join(self) -> None:
        """Links each deployment with what it includes, after all other documents are linked."""
        disk = self.documents.disk
        disk.recall(self.disk.record())
        large = too_large(self.models, disk)
        self.diagnostics += [fault for fault in large.values() if fault is not None]
        usable = {real: model for real, model in self.models.items() if real not in large}
        for real, model in usable.items():
            linked = self.tables.deployments[real] = LinkedDeployment(model, real)
            expansion = Expansion(linked, self.tables, usable, disk)
            expansion.run()
            names = DeploymentNames(linked, expansion.documents, expansion.included)
            names.resolve()
            self.diagnostics += expansion.diagnostics + names.diagnostics
            self.diagnostics += deployment_groups.resolve(linked, expansion.documents)
        for model in usable.values():
            for real in _included(model, disk):
                if real in usable:
                    tie(self.tables.deployments[real], is_included=True)


class _NamedByDeployment(msgspec.Struct):
    """Resolves the paths in one deployment, whatever other deployments name: how it uses values, and paths without a
    document."""

    model: Deployment
    disk: Disk
    root: str
    used: dict[UsedValues, None] = {}
    diagnostics: list[Diagnostic] = []

    def run(self) -> Iterator[NamedDocument]:
        """The documents that it names."""
        for entry in self.model.entries:
            if entry.kind != PROCESS:
                yield from self._follow_entry(entry)
        for include in self.model.all_includes:
            yield from self._follow_include(include)
        for group in self.model.groups:
            if group.facade is not None:
                component = self._component(group.facade)
                if component is not None:
                    yield NamedDocument(component)

    def _follow_entry(self, entry: Entry) -> Iterator[NamedDocument]:
        """The component and configuration of each instance; the configuration is relative to the component."""
        components: dict[str, str] = {}
        is_completed = entry.settings is not None
        for target, config in _of_instances(entry):
            if entry.kind == COMPONENT and target.text not in components:
                component = self._component(target)
                if component is None:
                    return
                components[target.text] = component
                yield NamedDocument(component)
            if config is not None:
                folder = paths.entry_folder(self.model, entry, components.get(target.text, ""))
                path = self._config(folder, config)
                if path is None:
                    return
                if entry.kind == COMPONENT and paths.is_values(path):
                    yield NamedDocument(path, "config")
                    self.used[UsedValues(path, components[target.text], is_completed)] = None
            elif entry.kind == COMPONENT:
                component = components[target.text]
                path = paths.default_config(os.path.dirname(component))
                self.used[UsedValues(path, component, is_completed)] = None

    def _component(self, target: Text) -> str | None:
        components = paths.component_paths(self.model, target.text, self.disk)
        if len(components) > 1:
            names = " or ".join(os.path.join(target.text, os.path.basename(path)) for path in components)
            self.diagnostics.append(codes.SEVERAL_COMPONENTS.at(target.span, path=target.text, hint=f"name {names}"))
        elif not components:
            path = paths.joined(paths.document_folder(self.model), target.text)
            hint = self._named(target.text) or self._nearby(path, ".cdsl.yaml", "cdsl.yaml")
            self.diagnostics.append(codes.NO_COMPONENT.at(target.span, path=target.text, hint=hint))
        return components[0] if len(components) == 1 else None

    def _named(self, name: str) -> Hint | None:
        """A hint at the component of the workspace that has a name, or a similar one: entries name it by its path."""
        if not name.isidentifier():
            return None
        folders: dict[str, str] = {}
        for path in of_kind(self.root, "cdsl", self.disk):
            data, _ = self.disk.read(path)
            if data is not None and (found := _COMPONENT.search(data.decode(errors="replace"))):
                folders[found[1]] = os.path.dirname(path) or "."
        meant = name if name in folders else suggest(name, folders)
        if meant is None:
            return None
        path = os.path.relpath(folders[meant], paths.document_folder(self.model) or ".")
        return meaning(name, path, more=f", the folder of {meant}")

    def _config(self, folder: str, config: Text) -> str | None:
        candidates = paths.config_paths(self.model, folder, config.text)
        for path in candidates:
            if self.disk.has_file(path):
                return path
        hint = self._nearby(candidates[0]) or self._nearby(candidates[1])
        listed = " and no ".join(dict.fromkeys(candidates))
        self.diagnostics.append(codes.NO_CONFIG.at(config.span, path=config.text, places=listed, hint=hint))
        return None

    def _follow_include(self, include: Text) -> Iterator[NamedDocument]:
        path = paths.include_path(self.model, include.text, self.disk)
        if path is not None:
            yield NamedDocument(path)
            return
        path = paths.joined(paths.document_folder(self.model), include.text)
        hint = self._nearby(path, ".ddsl.yaml", without=self.model.path)
        self.diagnostics.append(codes.NO_INCLUDE.at(include.span, path=include.text, hint=hint))

    def _nearby(self, path: str, *suffixes: str, without: str = "") -> Hint:
        """A hint at a similar name in the same folder, other than `without`."""
        folder, name = os.path.split(path)
        disk = self.disk
        if not disk.has_folder(folder or "."):
            return Hint(f"the folder '{folder}' does not exist")
        names = disk.names(folder)
        if suffixes:
            names = [n for n in names if n.endswith(suffixes) or disk.has_folder(os.path.join(folder, n))]
        own = os.path.basename(without) if os.path.dirname(without) == folder else ""
        return did_you_mean(name, [n for n in names if n != own], open_=True)


def _of_instances(entry: Entry) -> Iterator[tuple[Text, Text | None]]:
    """The target and configuration of an entry; if one contains `{i}`, those of each instance."""
    target, config = entry.target, entry.config
    if entry.instances is None or INDEX not in target.text + (config.text if config else ""):
        yield target, config
        return
    for number in range(entry.instances):
        yield _of_instance(target, number), _of_instance(config, number) if config else None


def _of_instance(text: Text, number: int) -> Text:
    return Text(text.text.replace(INDEX, str(number)), span=text.span)


MAX_INSTANCES = 10_000  # of one deployment with its includes
MAX_DEPTH = 50  # of nested includes


def too_large(deployments: Mapping[str, Deployment], disk: Disk) -> dict[str, Diagnostic | None]:
    """The deployments, by real path, that are too large or too deep, each with its diagnostic. The diagnostic is None
    for those that only include such a deployment, so that the error is reported once."""
    sizes: dict[str, tuple[int, int]] = {}
    faults: dict[str, Diagnostic | None] = {}
    included = {real: list(_included(model, disk)) for real, model in deployments.items()}
    for real in postorder(deployments, lambda real: [other for other in included[real] if other in included]):
        model, inner = deployments[real], [other for other in included[real] if other in sizes]
        size = sum(entry.instances or 1 for entry in model.entries) + sum(sizes[other][0] for other in inner)
        depth = 1 + max((sizes[other][1] for other in inner), default=0)
        sizes[real] = size, depth
        if any(other in faults for other in inner):
            faults[real] = None
        elif size > MAX_INSTANCES:
            faults[real] = codes.TOO_LARGE.at(model.span, problem=f"has {size} processes, more than {MAX_INSTANCES}")
        elif depth > MAX_DEPTH:
            problem = f"nests includes {depth} deep, more than {MAX_DEPTH}"
            faults[real] = codes.TOO_LARGE.at(model.span, problem=problem)
    return faults


def _included(model: Deployment, disk: Disk) -> Iterator[str]:
    """The real paths of the documents that a document includes, with repetitions."""
    for path in filter(None, (paths.include_path(model, include.text, disk) for include in model.all_includes)):
        yield disk.real(path)
