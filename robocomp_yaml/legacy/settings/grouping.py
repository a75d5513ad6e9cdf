"""Which component each config belongs to."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.document import Map, data
from robocomp_yaml.legacy.draft import ComponentDraft, ConfigDraft, ParametersDraft, ValuesDraft
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.settings import declared
from robocomp_yaml.legacy.settings.sorting import PortNames
from robocomp_yaml.source.disk import names_in
from robocomp_yaml.source.heading import component_in


class ConfiguredComponent(msgspec.Struct, eq=False):
    """A component with its configs. `document`: its CDSL; '' where it has none, and is called as its config.
    `declared`: what the PDSL at `parameters` says already; None where it is to be inferred."""

    name: str
    document: str
    parameters: str
    ports: PortNames = PortNames()
    declared: declared.Types | None = None
    configs: list[LedgerEntry] = []


def generic_config(path: str) -> str:
    """`generic_config` for `specific_config`: RoboComp's first generator split configs in two."""
    folder, name = os.path.split(path)
    return os.path.join(folder, name.replace("specific", "generic")) if "specific" in name else ""


class ConfiguredComponents:
    def __init__(
        self, good: Sequence[LedgerEntry], chosen: Mapping[str, str], is_ours: Callable[[LedgerEntry, str], bool]
    ) -> None:  # fmt: skip
        self.good, self.chosen, self.is_ours = good, chosen, is_ours
        self.by_folder: dict[str, list[tuple[str, ConfiguredComponent]]] = {}
        self.taken = set(chosen.values())
        self.listed: dict[str, list[str]] = {}
        self.known: dict[str, ConfiguredComponent] = {}
        for file in (entry.file for entry in good):
            if isinstance(file.draft, ComponentDraft):
                self._join(file.path, _of_cdsl(chosen[file.path], file.draft.document))

    def declare(self) -> None:
        """Joins the PDSLs of 2011 with their components, and the values of 2011 with their PDSLs."""
        named: dict[str, str] = {}
        for file in (entry.file for entry in self.good):
            if isinstance(file.draft, ParametersDraft):
                draft, path = file.draft.document, self.chosen[file.path]
                name = str(draft.entries[0].value)
                named.setdefault(name, path)
                named[os.path.basename(file.path)] = path
                component = self._of(file.path)
                if component is None:
                    component = ConfiguredComponent(name, "", path)
                    self._join(file.path, component)
                elif component.document:
                    draft.entries[0].value = os.path.relpath(component.document, os.path.dirname(path) or ".")
                component.declared, component.parameters = declared.types(data(draft)), path
        for entry in self.good:
            if isinstance(entry.file.draft, ValuesDraft):
                declares = entry.file.draft.document.entries[0]
                wanted = os.path.basename(str(declares.value)).removesuffix(".yaml")
                path = named.get(wanted) or named.get(wanted.removesuffix(".pdsl"), "")
                if path:
                    folder = os.path.dirname(self.chosen[entry.file.path]) or "."
                    declares.value = os.path.relpath(path, folder)
                else:
                    entry.diagnostics.append(codes.NO_PDSL.at(Span(entry.file.path), name=wanted))

    def all(self) -> list[ConfiguredComponent]:
        """The components that have configs."""
        found: dict[ConfiguredComponent, None] = {}
        own: dict[str, ConfiguredComponent] = {}
        configs = {entry.file.path: entry for entry in self.good if isinstance(entry.file.draft, ConfigDraft)}
        for config, entry in configs.items():
            component = self._of(config)
            if component is None:
                first = generic_config(config)
                name = first if first in configs else config
                if name not in own:
                    own[name] = self._of_its_own(config, name)
                component = own[name]
                entry.diagnostics.append(codes.OWN_COMPONENT.at(Span(config), name=component.name))
            if not component.configs and component.declared is None and component.document:
                for path in declared.beside(component.document):
                    if not self.is_ours(entry, path):
                        component.declared = declared.of_document(path)
            component.configs.append(entry)
            found[component] = None
        return list(found)

    def _join(self, path: str, component: ConfiguredComponent) -> None:
        self.by_folder.setdefault(_folder(path), []).append((_stem(path), component))

    def _of(self, file: str) -> ConfiguredComponent | None:
        """The component in a config's folder, or in the one above: the only one, or the one of its name."""
        here = _folder(file)
        for folder in (here, os.path.dirname(here)):
            known = self.by_folder.get(folder, [])
            known = known or [(_stem(path), self._written(path)) for path in self._documents(folder, file)]
            alike = [component for stem, component in known if stem == _stem(file)]
            if len(known) == 1 or len(alike) == 1:
                return (alike or [known[0][1]])[0]
            if known:
                return None
        return None

    def _documents(self, folder: str, file: str) -> list[str]:
        """The CDSL documents that stand in a folder already, where the config's own document will be near them."""
        own = _folder(self.chosen[file])
        if os.path.realpath(folder) not in (own, os.path.dirname(own)):
            return []
        if folder not in self.listed:
            self.listed[folder] = [name for name in names_in(folder) if name.endswith(".cdsl.yaml")]
        shown = os.path.dirname(self.chosen[file])
        base = shown if folder == own else os.path.normpath(os.path.join(shown, os.pardir))
        return [os.path.normpath(os.path.join(base, name)) for name in self.listed[folder]]

    def _written(self, path: str) -> ConfiguredComponent:
        if path not in self.known:
            name = component_in(path) or _stem(path)
            self.known[path] = ConfiguredComponent(name, path, os.path.join(os.path.dirname(path), f"{name}.pdsl.yaml"))
        return self.known[path]

    def _of_its_own(self, file: str, named: str) -> ConfiguredComponent:
        """A component that has only its config: `config.new` is called so, `side.conf` is called `side`."""
        base = os.path.basename(named)
        stem = base.removesuffix(".conf")
        folder = os.path.dirname(self.chosen[file])
        path, number = os.path.join(folder, f"{stem}.pdsl.yaml"), 2
        while path in self.taken:
            path, number = os.path.join(folder, f"{base if number == 2 else number}.pdsl.yaml"), number + 1
        self.taken.add(path)
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
