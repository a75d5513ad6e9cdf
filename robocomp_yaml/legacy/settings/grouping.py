"""Assign each config to a component."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.document import Map, data
from robocomp_yaml.legacy.draft import ComponentDraft, ConfigDraft, ParametersDraft, ValuesDraft
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.settings import declared
from robocomp_yaml.legacy.settings.sorting import PortNames
from robocomp_yaml.source.disk import names_in
from robocomp_yaml.source.heading import component_in


class ConfiguredComponent(msgspec.Struct, eq=False):
    """A component with its configs. `document` is its CDSL, '' where it has none and is named after its config.
    `declared` are the types in the PDSL at `parameters`; None where the PDSL is to be inferred."""

    name: str
    document: str
    parameters: str
    ports: PortNames = PortNames()
    declared: declared.Types | None = None
    configs: list[LedgerEntry] = []


def generic_config(path: str) -> str:
    """Return `generic_config` for `specific_config`, else ''. RoboComp's first generator split configs in these two."""
    folder, name = os.path.split(path)
    return os.path.join(folder, name.replace("specific", "generic")) if "specific" in name else ""


class ConfiguredComponents:
    """The components of a run, by the folders of their files."""

    def __init__(
        self, accepted: Sequence[LedgerEntry], documents: Mapping[str, str], owners: Mapping[str, str],
        was_written: Callable[[LedgerEntry, str], bool],
    ) -> None:  # fmt: skip
        self.accepted, self.documents, self.owners, self.was_written = accepted, documents, owners, was_written
        self.by_folder: dict[str, list[tuple[str, ConfiguredComponent]]] = {}
        self.used = set(documents.values())
        self.listed: dict[str, list[str]] = {}
        self.known: dict[str, ConfiguredComponent] = {}
        for file in (entry.file for entry in accepted):
            if isinstance(file.draft, ComponentDraft):
                self._join(file.path, _of_cdsl(documents[file.path], file.draft.document))

    def declare(self) -> None:
        """Assign the PDSLs of 2011 to their components, and the values of 2011 to their PDSLs."""
        paths: dict[str, str] = {}
        for file in (entry.file for entry in self.accepted):
            if isinstance(file.draft, ParametersDraft):
                draft, path = file.draft.document, self.documents[file.path]
                name = str(draft.entries[0].value)
                paths.setdefault(name, path)
                paths[os.path.basename(file.path)] = path
                component = self._of(file.path)
                if component is None:
                    component = ConfiguredComponent(name, "", path)
                    self._join(file.path, component)
                elif component.document:
                    draft.entries[0].value = os.path.relpath(component.document, os.path.dirname(path) or ".")
                component.declared, component.parameters = declared.types(data(draft)), path
        for entry in self.accepted:
            if isinstance(entry.file.draft, ValuesDraft):
                declares = entry.file.draft.document.entries[0]
                pdsl = os.path.basename(str(declares.value)).removesuffix(".yaml")
                path = paths.get(pdsl) or paths.get(pdsl.removesuffix(".pdsl"), "")
                if path:
                    folder = os.path.dirname(self.documents[entry.file.path]) or "."
                    declares.value = os.path.relpath(path, folder)
                else:
                    entry.diagnostics.append(codes.NO_PDSL.at(Span(entry.file.path), name=pdsl))

    def all(self) -> list[ConfiguredComponent]:
        """Return the components that have configs."""
        components: dict[ConfiguredComponent, None] = {}
        unnamed: dict[str, ConfiguredComponent] = {}
        alone: dict[str, dict[str, LedgerEntry]] = {}
        configs = {entry.file.path: entry for entry in self.accepted if isinstance(entry.file.draft, ConfigDraft)}
        for config, entry in configs.items():
            component = self._of(config) or self._assigned(config)
            if component is None:
                first = generic_config(config)
                name = first if first in configs else config
                if name not in unnamed:
                    unnamed[name] = self._from_config(config, name)
                component = unnamed[name]
                alone.setdefault(os.path.dirname(config), {}).setdefault(component.name, entry)
            if not component.configs and component.declared is None and component.document:
                for path in declared.beside(component.document):
                    if not self.was_written(entry, path):
                        component.declared = declared.of_document(path)
            component.configs.append(entry)
            components[component] = None
        for entries in alone.values():
            _report_own(entries)
        return list(components)

    def _join(self, path: str, component: ConfiguredComponent) -> None:
        self.by_folder.setdefault(_folder(path), []).append((_stem(path), component))

    def _of(self, file: str) -> ConfiguredComponent | None:
        """Return the component in a file's folder, or in the parent folder: the only one, or the one with the file's
        name."""
        own_folder = _folder(file)
        for folder in (own_folder, os.path.dirname(own_folder)):
            known = self.by_folder.get(folder, [])
            known = known or [(_stem(path), self._written(path)) for path in self._existing(folder, file)]
            same_name = [component for stem, component in known if stem == _stem(file)]
            if len(known) == 1 or len(same_name) == 1:
                return (same_name or [known[0][1]])[0]
            if known:
                return None
        return None

    def _assigned(self, config: str) -> ConfiguredComponent | None:
        """Return the component to which a network assigns a config."""
        document = self.owners.get(os.path.realpath(config))
        known = (component for joined in self.by_folder.values() for _, component in joined)
        return next((each for each in known if document is not None and each.document == document), None)

    def _existing(self, folder: str, file: str) -> list[str]:
        """Return the CDSL documents that exist in a folder, if the config's document is written to it or below it."""
        own = _folder(self.documents[file])
        if os.path.realpath(folder) not in (own, os.path.dirname(own)):
            return []
        if folder not in self.listed:
            self.listed[folder] = [name for name in names_in(folder) if name.endswith(".cdsl.yaml")]
        below = os.path.dirname(self.documents[file])
        base = below if folder == own else os.path.normpath(os.path.join(below, os.pardir))
        return [os.path.normpath(os.path.join(base, name)) for name in self.listed[folder]]

    def _written(self, path: str) -> ConfiguredComponent:
        if path not in self.known:
            name = component_in(path) or _stem(path)
            self.known[path] = ConfiguredComponent(name, path, os.path.join(os.path.dirname(path), f"{name}.pdsl.yaml"))
        return self.known[path]

    def _from_config(self, file: str, named: str) -> ConfiguredComponent:
        """Return a component without a CDSL, named after a config: `config.new`, or `side` for `side.conf`."""
        base = os.path.basename(named)
        stem = base.removesuffix(".conf")
        folder = os.path.dirname(self.documents[file])
        path, number = os.path.join(folder, f"{stem}.pdsl.yaml"), 2
        while path in self.used:
            path, number = os.path.join(folder, f"{base if number == 2 else number}.pdsl.yaml"), number + 1
        self.used.add(path)
        return ConfiguredComponent(os.path.basename(path).removesuffix(".pdsl.yaml"), "", path)


def _folder(path: str) -> str:
    return os.path.realpath(os.path.dirname(path) or ".")


def _stem(path: str) -> str:
    return os.path.basename(path).split(".")[0].lower()


def _of_cdsl(document: str, draft: Map) -> ConfiguredComponent:
    content = data(draft)
    ports = [_ports(content.get(part)) for part in ("implements", "requires", "publishes", "subscribes")]
    name = str(content["component"])
    parameters = os.path.join(os.path.dirname(document), f"{name}.pdsl.yaml")
    return ConfiguredComponent(name, document, parameters, PortNames(ports[0], ports[1], ports[2] | ports[3]))


def _ports(listed: object) -> frozenset[str]:
    items = listed if isinstance(listed, list) else []
    return frozenset(str(next(iter(item), "") if isinstance(item, dict) else item) for item in items)


def _report_own(entries: Mapping[str, LedgerEntry]) -> None:
    """Report once that the configs of a folder become components of their own, by their names."""
    names, first = list(entries), next(iter(entries.values()))
    what = f"this config becomes the component {names[0]}"
    if names[1:]:
        what = f"its configs become components of their own: {some(names)}"
    first.diagnostics.append(codes.OWN_COMPONENT.at(Span(first.file.path), what=what))
