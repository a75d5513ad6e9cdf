"""The configuration of each process as text: its base, the values of `set:`, and what is derived.

What is derived is one more layer on the base. For a values document, all layers are judged and written as `compile`
does. A flat config that `config:` names stays unchanged, and what is derived follows it: of two lines for one property,
Ice uses the last. Of the component's own `etc/config`, the lines are used that nothing overrides, and its values are
judged as those of a values document.

What judges and writes values is imported where it is used: programs have none.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import astuple, replace

from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.flat_configs import FlatConfig
from robocomp_yaml.link.program import LinkedParameters, LinkedValues, Program
from robocomp_yaml.network.configuration_base import ConfigurationBase
from robocomp_yaml.network.draft import Draft, LocatedText
from robocomp_yaml.parameters.writing.sections import CLASSIC, FLAT_TOML, Property, Section, secret_keys, section_text
from robocomp_yaml.semantics import connections, references
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.content import content
from robocomp_yaml.source.properties import entry_line, unset_line
from robocomp_yaml.source.tree import Mapping, Node, Scalar, mapping_at, text_at

if TYPE_CHECKING:
    from robocomp_yaml.addresses.flat_values import FlatValues
    from robocomp_yaml.network.set_values import SetValues
    from robocomp_yaml.parameters.editing.settings import ShownSetting
    from robocomp_yaml.parameters.layers.merge import MergedValue
    from robocomp_yaml.parameters.specification.document import ValuesDocument

_PARAMETERS = "What the deployment sets"
_TITLE = "Where this component and the others are"
_NOT_SET = "What the deployment replaces"
_FILES = "Files, by their absolute paths"


class MadeConfiguration(msgspec.Struct, frozen=True):
    """A configuration that was made. `layers` are its values, None if it has none."""

    text: str | None
    secrets: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]
    layers: LinkedValues | None


class Configuration(msgspec.Struct):
    """The configuration of one draft. `text` is None after an error, `secrets` are its secret properties.
    `external` are the proxies of servers outside."""

    draft: Draft
    program: Program
    addresses: Addresses
    external: Collection[str] = ()
    text: str | None = None
    secrets: tuple[str, ...] = ()
    diagnostics: list[Diagnostic] = []
    _layers: LinkedValues | None = None

    @property
    def base(self) -> ConfigurationBase:
        return self.draft.base

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
            values.causes() if values is not None else None,
            (*self._of_flat(), component, *sorted(self.external)) if self.base.flat is not None else None,
            self.base.is_own,
            (own.parameters, own.document, own.broken) if own is not None else None,
            len(draft.proxies),
            len(draft.topics),
            tuple((name, given.text, astuple(given.span)) for name, given in located),
        )

    def _of_flat(self) -> tuple[object, ...]:
        """The content of the flat config, and who wrote it."""
        flat = self.base.flat
        if flat is None:
            return ()
        return flat.path, flat.text, flat.is_written, flat.is_unchanged, *sorted(flat.base.items())

    def make_once(self, process: tuple[str, str]) -> MadeConfiguration:
        """As `make`, unless nothing has changed since an earlier analysis. `process` are deployment and name."""

        def result() -> MadeConfiguration:
            self.make()
            return MadeConfiguration(self.text, self.secrets, tuple(self.diagnostics), self._layers)

        return self.program.memory.result(("configuration", *process), self.causes(), result)

    def use(self, made: MadeConfiguration) -> None:
        """As if `make` had made this."""
        self.text, self.secrets, self.diagnostics = made.text, made.secrets, list(made.diagnostics)
        self._layers = made.layers

    def make(self) -> None:
        base, component = self.base, self.draft.instance.component
        linked = component.parameters if component is not None else None
        if base.values is not None:
            linked = base.values.parameters
            if linked is None:
                return  # unknown parameters have been reported
        lines = ""
        if base.flat is not None and base.is_own and linked is not None:
            lines, sections = self._on_own(base.flat, linked)
        elif base.flat is not None:
            lines, sections = self._on_flat(base.flat, linked)
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
        if base.flat is None or base.is_own:
            self.text = head + section_text(sections) + lines
        elif not sections:
            self.text = lines  # in any format
        else:
            self.text = lines.removesuffix("\n") + f"\n\n{head}{section_text(sections)}"

    def _on_values(self, linked: LinkedParameters) -> list[Section] | None:
        base = self.base.values
        if linked.broken or (base is not None and base.broken):
            return None
        from robocomp_yaml.parameters.writing.properties import properties

        empty = self._document(mapping_at(self.draft.span, {}))
        below = LinkedValues(empty, (base,) if base is not None else (), linked)
        layer = replace(below, document=self._document(self._layer(linked, below)))
        values, found = self.program.effective(layer)
        self.diagnostics += found
        if values is None:
            return None
        self._layers = layer
        sections, faults = properties(layer, values)
        self.diagnostics += faults
        written = {made.key for section in sections for made in section.properties}
        more = [made for made in self._connections(CLASSIC) if made.key not in written]
        return [*sections, Section(_TITLE, more)] if more else sections

    def _on_own(self, flat: FlatConfig, linked: LinkedParameters) -> tuple[str, list[Section] | None]:
        """The lines of the component's own flat config that nothing overrides, and the other properties."""
        if linked.broken:
            return "", None
        from robocomp_yaml.addresses.flat_values import flat_values

        below = flat_values(flat, linked, self.draft.instance.component)
        if not self._judged(linked, below.layer):
            return "", None
        found = self._set(linked, below)
        files = [one for one in _absolute(flat) if one.key not in found.replaced]
        made = [Section(_TITLE, self._connections(self.base.dialect)), Section(_FILES, files)]
        made.append(Section(_PARAMETERS, found.properties))
        written = {each.key for section in made for each in section.properties} | found.replaced
        kept = [entry_line(key, value) for key, value in flat.properties.items() if key not in written]
        return "".join(f"{line}\n" for line in ["", f"# As in {os.path.basename(flat.path)}.", *kept]), made

    def _on_flat(self, flat: FlatConfig, linked: LinkedParameters | None) -> tuple[str, list[Section] | None]:
        """The flat config as it is, and the properties that follow it."""
        made = [Section(_TITLE, self._connections(self.base.dialect))]
        if linked is None or self.draft.instance.entry.settings is None:
            return flat.text, made
        if linked.broken:
            return "", None
        from robocomp_yaml.addresses.flat_values import flat_values
        from robocomp_yaml.parameters.layers.effective import document_faults

        component = self.draft.instance.component
        below = flat_values(flat, linked, component)
        if document_faults(below.layer, linked):  # the file may be of any format, and nobody judges it
            below = flat_values(replace(flat, text="", entries={}), linked, component)
        found = self._set(linked, below)
        unset = sorted(found.replaced - {one.key for one in found.properties})
        text = flat.text
        if unset:
            lines = ["", f"# {_NOT_SET}.", *map(unset_line, unset)]
            text = text.removesuffix("\n") + "".join(f"\n{line}" for line in lines) + "\n"
        return text, [*made, Section(_PARAMETERS, found.properties)]

    def _judged(self, linked: LinkedParameters, below: LinkedValues) -> bool:
        """Whether the layers of `set:` and of the base have no problems."""
        from robocomp_yaml.parameters.json_schema import EFFECTIVE, fits
        from robocomp_yaml.parameters.layers.merge import data_of, merged

        empty = self._document(mapping_at(self.draft.span, {}))
        whole = LinkedValues(empty, (below,), linked)
        layer = self._layers = replace(whole, document=self._document(self._layer(linked, whole)))
        if not linked.parameters.constraints and fits(
            linked, EFFECTIVE, data_of(merged(layer), linked.parameters.root)
        ):
            return True  # the values are not needed, and completing them takes long
        values, found = self.program.effective(layer)
        self.diagnostics += found
        return values is not None

    def _set(self, linked: LinkedParameters, below: FlatValues) -> SetValues:
        """The properties of `set:` on a flat config."""
        from robocomp_yaml.network.set_values import SetValues, set_values
        from robocomp_yaml.parameters.layers.merge import merged

        settings = self.draft.instance.entry.settings
        if settings is None:
            return SetValues()
        layer = self._document(self._parameters(linked, settings, merged(below.layer)))
        if any(fault.severity == "error" for fault in self.diagnostics):
            return SetValues()
        found = set_values(linked, below, layer, quote=self.base.dialect == FLAT_TOML)
        self.diagnostics += found.faults
        return found

    def settings(self) -> list[ShownSetting]:
        """The values of the configuration, with their origin."""
        from robocomp_yaml.network.settings import ProcessSettings  # most commands show none
        from robocomp_yaml.parameters.editing.settings import run_time_defaults

        made = ProcessSettings(self.draft, self.addresses, self.external)
        if self._layers is not None:
            found = made.of(self._layers, self.program.effective(self._layers)[0])
        else:
            properties = self._connections(CLASSIC)
            found = made.derived((each.key, each.value, each.span or self.draft.span) for each in properties)
        shown = list(found)
        known = {one.key for one in shown}
        if self.draft.instance.component is not None:
            shown += (one for one in run_time_defaults() if one.key not in known)
        return shown

    @property
    def _file(self) -> str:
        return self.draft.instance.document.path

    def _document(self, root: Mapping) -> ValuesDocument:
        from robocomp_yaml.parameters.specification.document import ValuesDocument

        return ValuesDocument(self._file, root)

    def _layer(self, linked: LinkedParameters, base: LinkedValues) -> Mapping:
        """What is derived, as a values document."""
        span, entries = self.draft.span, dict[str, tuple[Scalar, Node]]()
        settings = self.draft.instance.entry.settings
        if settings is not None:
            from robocomp_yaml.parameters.layers.merge import merged

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
        from robocomp_yaml.parameters.layers.overlay import overlay

        laid = overlay(settings, linked.parameters.root, below)
        self.diagnostics += [
            codes.NO_ENTRY.at(fault.key.span, path=fault.key.lexeme, problem=fault.problem) for fault in laid.faults
        ]
        key = text_at(settings.span, "parameters")
        return mapping_at(settings.span, {"parameters": (key, laid.root)})

    def _endpoints(self) -> Iterator[tuple[str, LocatedText]]:
        draft = self.draft
        for adapter in draft.adapters:
            yield adapter.adapter.rpartition(".")[2], LocatedText(adapter.text, adapter.own or adapter.span)
        component, given = draft.instance.component, {adapter.adapter for adapter in draft.subscribers}
        for port in component.subscribes if component else ():
            if f"{port.name}Topic" not in given:
                yield f"{port.name}Topic", LocatedText(draft.listening.endpoints(0), draft.span)

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
        made += [(*connections.endpoints(name)[:2], given) for name, given in self._endpoints()]
        made += [(*connections.proxy(name), given) for name, given in draft.proxies.items()]
        if draft.manager is not None:
            made.append((*connections.MANAGER, draft.manager))
        made += [(name, name, given) for name, given in draft.topics.items()]
        published = {
            f"{one.adapter}.PublishedEndpoints": LocatedText(one.published, one.span) for one in draft.adapters
        }
        made += [(key, key, given) for key, given in published.items() if given.text]
        lines = {classic: Property(classic, given.text, given.span) for classic, _, given in made}
        if dialect != CLASSIC:
            lines |= {other: Property(other, _quoted(given.text), given.span) for _, other, given in made}
        prefixes = [connections.prefix(f"{name}{end}") for name in draft.topics for end in ("", "Pub")]
        # an empty value overrides the value in the base
        lines |= {key: Property(key, '""') for key in prefixes if key in self.base.properties}
        return list(lines.values())


def _absolute(flat: FlatConfig) -> Iterator[Property]:
    """The references to files in a flat config, which a copy in another folder would look for elsewhere."""
    folder = os.path.dirname(os.path.abspath(flat.path))
    for key, value in flat.properties.items():
        path = (references.read(unquoted(value)) or {}).get(references.FILE, "")
        if path and not path.startswith(("/", "~/")):
            text = references.spelled(references.FILE, os.path.normpath(os.path.join(folder, path)))
            yield Property(key, _quoted(text) if unquoted(value) != value else text)


def _quoted(text: str) -> str:
    return text if '"' in text else f'"{text}"'


def _entry(name: str, given: LocatedText | Mapping) -> tuple[Scalar, Node]:
    node = given if isinstance(given, Mapping) else text_at(given.span, given.text)
    return text_at(node.span, name), node
