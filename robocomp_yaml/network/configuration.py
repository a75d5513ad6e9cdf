"""The configuration of each process as text: its base, the values of `set:`, and what is derived.

For a values document, what is derived is one more layer, which is judged and written as `compile` does. A flat config
stays unchanged, and what is derived follows it: of two lines for one property, Ice uses the last.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

import msgspec
from msgspec.structs import astuple, replace

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import LinkedParameters, LinkedValues
from robocomp_yaml.network.configuration_base import ConfigurationBase
from robocomp_yaml.network.draft import Draft, LocatedText, listening
from robocomp_yaml.parameters.layers.effective import document_faults, effective
from robocomp_yaml.parameters.layers.merge import MergedValue, data_of, merged
from robocomp_yaml.parameters.layers.overlay import overlay
from robocomp_yaml.parameters.specification.document import ValuesDocument
from robocomp_yaml.parameters.writing.properties import (
    CLASSIC,
    FLAT_TOML,
    Section,
    properties,
    secret_keys,
    section_text,
)
from robocomp_yaml.parameters.writing.write import Property, Writer
from robocomp_yaml.semantics import connections
from robocomp_yaml.source.content import content
from robocomp_yaml.source.tree import Mapping, Node, Scalar, mapping_at, text_at

_PARAMETERS = "What the deployment sets"
_TITLE = "Where this component and the others are"


class Configuration(msgspec.Struct):
    """The configuration of one draft. `text` is None after an error, `secrets` are its secret properties."""

    draft: Draft
    base: ConfigurationBase
    text: str | None = None
    secrets: tuple[str, ...] = ()
    diagnostics: list[Diagnostic] = []

    def causes(self) -> tuple[object, ...]:
        """What `make` depends on, as causes for a memory."""
        draft, values = self.draft, self.base.values
        entry, component = draft.instance.entry, draft.instance.component
        own = component.parameters if component is not None else None
        located: list[tuple[str, LocatedText]] = [*self._endpoints(), *draft.proxies.items(), *draft.topics.items()]
        if draft.manager is not None:
            located.append(("", draft.manager))
        return (
            self._file,
            astuple(draft.span),
            content(entry.settings) if entry.settings is not None else None,
            values.causes() if values is not None else self.base.flat,
            (own.parameters, own.document, own.broken) if own is not None else None,
            len(draft.proxies),
            len(draft.topics),
            tuple((name, given.text, astuple(given.span)) for name, given in located),
        )

    def make(self) -> None:
        values = self.base.values
        component = self.draft.instance.component
        linked = values.parameters if values is not None else component.parameters if component is not None else None
        if values is not None and linked is None:
            return  # unknown parameters have been reported
        if self.base.flat is not None:
            sections = self._on_flat(linked)
        elif linked is not None:
            sections = self._on_values(linked)
        else:
            sections = [Section(_TITLE, self._connections(CLASSIC))]
        if sections is None or any(fault.severity == "error" for fault in self.diagnostics):
            return
        sections = [section for section in sections if section.properties]
        self.secrets = secret_keys(sections)
        document = os.path.basename(self.draft.instance.document.path)
        head = f"# Configuration of {self.draft.name}, derived by rcyaml from {document}: change it there.\n"
        if self.base.flat is None:
            self.text = head + section_text(sections)
        elif not sections:
            self.text = self.base.flat  # in any format
        else:
            flat = self.base.flat if self.base.flat.endswith("\n") else f"{self.base.flat}\n"
            self.text = f"{flat}\n{head}{section_text(sections)}"

    def _on_values(self, linked: LinkedParameters) -> list[Section] | None:
        base = self.base.values
        if linked.broken or (base is not None and base.broken):
            return None
        empty = ValuesDocument(self._file, mapping_at(self.draft.span, {}))
        below = LinkedValues(empty, (base,) if base is not None else (), linked)
        layer = replace(below, document=ValuesDocument(self._file, self._layer(linked, below)))
        values, found = effective(layer)
        self.diagnostics += found
        if values is None:
            return None
        sections, faults = properties(layer, values)
        self.diagnostics += faults
        written = {made.key for section in sections for made in section.properties}
        more = [made for made in self._connections(CLASSIC) if made.key not in written]
        return [*sections, Section(_TITLE, more)] if more else sections

    def _on_flat(self, linked: LinkedParameters | None) -> list[Section] | None:
        dialect = self.base.dialect
        made = [Section(_TITLE, self._connections(dialect))]
        settings = self.draft.instance.entry.settings
        if settings is None or linked is None:
            return made
        if linked.broken:
            return None
        layer = LinkedValues(ValuesDocument(self._file, self._parameters(linked, settings, None)), parameters=linked)
        self.diagnostics += document_faults(layer, linked)
        if not self.diagnostics:
            root, place = linked.parameters.root, merged(layer)
            writer = Writer(linked.parameters, settings.span, True, dialect == FLAT_TOML)
            made.append(Section(_PARAMETERS, writer.write(data_of(place, root), place)))
            self.diagnostics += writer.faults
        return made

    @property
    def _file(self) -> str:
        return self.draft.instance.document.path

    def _layer(self, linked: LinkedParameters, base: LinkedValues) -> Mapping:
        """What is derived, as a values document."""
        span, entries = self.draft.span, dict[str, tuple[Scalar, Node]]()
        settings = self.draft.instance.entry.settings
        if settings is not None:
            below = merged(base) if base.extends else None
            entries |= self._parameters(linked, settings, below).entries
        else:
            entries["component"] = (text_at(span, "component"), text_at(span, ""))
        given = self.base.values.document.root.entries.get("legacy") if self.base.values else None
        if given is not None:
            entries["legacy"] = given
        sections: dict[str, dict[str, tuple[Scalar, Node]]] = {
            "endpoints": {name: _entry(name, given) for name, given in self._endpoints()},
            "proxies": {name: self._proxy(name, given) for name, given in self.draft.proxies.items()},
            "topics": self._topics(),
        }
        for name, section in sections.items():
            if section:
                entries[name] = (text_at(span, name), mapping_at(span, section))
        return mapping_at(span, entries)

    def _parameters(self, linked: LinkedParameters, settings: Mapping, below: MergedValue | None) -> Mapping:
        laid = overlay(settings, linked.parameters.root, below)
        self.diagnostics += [
            codes.NO_ENTRY.at(fault.key.span, path=fault.key.lexeme, problem=fault.problem) for fault in laid.faults
        ]
        key = text_at(settings.span, "parameters")
        return mapping_at(settings.span, {"parameters": (key, laid.root)})

    def _endpoints(self) -> Iterator[tuple[str, LocatedText]]:
        draft = self.draft
        for adapter in draft.adapters:
            yield adapter.adapter.rpartition(".")[2], LocatedText(adapter.text, adapter.span)
        component, given = draft.instance.component, {adapter.adapter for adapter in draft.subscribers}
        for port in component.subscribes if component else ():
            if f"{port.name}Topic" not in given:
                yield f"{port.name}Topic", LocatedText(listening(draft.host, 0), draft.span)

    def _proxy(self, name: str, given: LocatedText) -> tuple[Scalar, Node]:
        """A proxy, under the property that the base has for it."""
        key, node = _entry(name, given)
        own = self.base.proxy_key(name)
        if own is None:
            return key, node
        words = {"proxy": (text_at(given.span, "proxy"), node), "key": (text_at(given.span, "key"), own)}
        return key, mapping_at(given.span, words)

    def _topics(self) -> dict[str, tuple[Scalar, Node]]:
        """The section for topics. A topic with a name in this section has no prefix."""
        made: dict[str, tuple[Scalar, Node]] = {}
        if self.draft.manager is not None:
            made["manager"] = _entry("manager", self.draft.manager)
        names = self.draft.topics
        if names:
            span = next(iter(names.values())).span
            made["name"] = _entry("name", mapping_at(span, {name: _entry(name, to) for name, to in names.items()}))
            ends = {f"{name}{end}": LocatedText("", to.span) for name, to in names.items() for end in ("", "Pub")}
            none = {name: _entry(name, given) for name, given in ends.items()}
            made["prefix"] = _entry("prefix", mapping_at(span, none))
        return made

    def _connections(self, dialect: str) -> list[Property]:
        """All derived properties, in Ice's spelling, which every generated component reads first, followed by those in
        the base's dialect, if that is different."""
        draft, made = self.draft, list[tuple[str, str, LocatedText]]()
        made += [(*connections.endpoints(name), given) for name, given in self._endpoints()]
        made += [(*connections.proxy(name), given) for name, given in draft.proxies.items()]
        if draft.manager is not None:
            made.append((*connections.MANAGER, draft.manager))
        made += [(name, name, given) for name, given in draft.topics.items()]
        lines = {classic: Property(classic, given.text, given.span) for classic, _, given in made}
        if dialect != CLASSIC:
            lines |= {other: Property(other, _quoted(given.text), given.span) for _, other, given in made}
        prefixes = [connections.prefix(f"{name}{end}") for name in draft.topics for end in ("", "Pub")]
        # an empty value overrides the value in the base
        lines |= {key: Property(key, '""') for key in prefixes if key in self.base.properties}
        return list(lines.values())


def _quoted(text: str) -> str:
    return text if '"' in text else f'"{text}"'


def _entry(name: str, given: LocatedText | Mapping) -> tuple[Scalar, Node]:
    node = given if isinstance(given, Mapping) else text_at(given.span, given.text)
    return text_at(node.span, name), node
