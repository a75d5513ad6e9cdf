"""The text of a component's first values document: the endpoints and proxies that it needs, and the values of its
existing `etc/config`, so that the next compile changes no value."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.emit import config
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.link.flat_configs import EARLIER
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters
from robocomp_yaml.parameters.examples.new import Sections, new_document
from robocomp_yaml.parameters.kinds import recording
from robocomp_yaml.parameters.types import Parameters, RecordType
from robocomp_yaml.semantics import composite, connections
from robocomp_yaml.semantics.plain import Conversion
from robocomp_yaml.semantics.reading import PropertyReader
from robocomp_yaml.semantics.references import unresolved
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.properties import read
from robocomp_yaml.source.regular import text
from robocomp_yaml.transactions.manifest import BASE


def first_values(
    linked: LinkedParameters, component: str, target: str, table: Callable[[LinkedComponent], PortTable]
) -> str:
    """The text of the document. `component` is the path of the CDSL or PDSL document, `target` that of the new
    document; `table` returns the ports of a component's workspace."""
    folder = os.path.dirname(target) or "."
    reference = os.path.relpath(component, folder)
    schema = os.path.relpath(os.path.join(os.path.dirname(component), "generated", "config.schema.json"), folder)
    modeline = f"# yaml-language-server: $schema={schema}"
    sections: Sections = []
    values: dict[str, Any] = {}
    if linked.component is not None:
        home = os.path.dirname(linked.component.component.path)
        existing = config.existing(home)
        ports = table(linked.component)
        sections = _connections(linked.component, existing, ports)
        if existing:
            changed = _changed(home, existing, config.plan(linked.component, ports).text)
            changed = {key: unquoted(value) for key, value in changed.items()} if _is_toml(existing) else changed
            values = _values(linked.parameters, existing)
            sections += _others(linked, changed)
    return new_document(linked.parameters, reference, modeline, sections, values)


def _connections(linked: LinkedComponent, existing: Mapping[str, str], table: PortTable) -> Sections:
    """Endpoints and proxies: those of the existing configuration, else the defaults."""
    defaults = config.connections(linked, table, existing)
    values = {key: config.stated(existing, key) or value for key, value in defaults.items()}
    served = [(key.removesuffix(".Endpoints"), text) for key, text in values.items() if key.endswith(".Endpoints")]
    proxies = [(port.name, values[connections.proxy(port.name)[0]]) for port in linked.requires]
    manager = values.get(connections.MANAGER[0], "")
    topics = [("manager", manager)] if manager != defaults.get(connections.MANAGER[0], "") else []
    return [("endpoints", served), ("proxies", proxies), ("topics", topics)]


def _changed(folder: str, existing: Mapping[str, str], generated: str) -> dict[str, str]:
    """The properties of an `etc/config` that the user changed since rcyaml wrote it."""
    before = text(os.path.join(folder, BASE, CONFIG))
    written = {**EARLIER, **read(generated).values} if before is None else read(before).values
    return {key: value for key, value in existing.items() if value and written.get(key) != value}


def _values(parameters: Parameters, existing: Mapping[str, str]) -> dict[str, Any]:
    """The values of an `etc/config` that differ from the defaults."""
    kind = recording(parameters.root)
    texts = PropertyReader(existing, {each.path: each for each in parameters.spellings}, unresolved).read(kind)
    return _without_defaults(parameters.root, kind, texts)


def _is_toml(existing: Mapping[str, str]) -> bool:
    """Whether texts are in quotes, as in later components of RoboComp."""
    return any(key.startswith(("Endpoints.", "Proxies.")) and value[:1] == '"' for key, value in existing.items())


def _without_defaults(record: RecordType, kind: composite.RecordKind, texts: Mapping[str, Any]) -> dict[str, Any]:
    """The values of these texts that match their types, and differ from the defaults."""
    kept: dict[str, Any] = {}
    for member in record.members:
        if member.name not in texts:
            continue
        inner, text = kind.members[member.name].kind, texts[member.name]
        if isinstance(inner, composite.RecordKind) and isinstance(member.type, RecordType) and inner.is_group:
            kept[member.name] = _without_defaults(member.type, inner, text)
            continue
        conversion = Conversion(is_text=True)
        taken = inner.convert(text, (), conversion)
        value = None if conversion.problems else composite.data(inner, taken)
        if value is not None and (member.default is None or value != member.default.data):
            kept[member.name] = value
    return kept


def _others(linked: LinkedParameters, changed: Mapping[str, str]) -> Sections:
    """The user's properties that are neither connections nor parameters."""
    assert linked.component is not None
    root = linked.parameters.root
    known = {key for each in config.needed(linked.component) for key in config.names(each)}
    own = {
        key: value for key, value in changed.items() if key not in known and root.member(key.partition(".")[0]) is None
    }
    ice = [(key.removeprefix("Ice."), value) for key, value in own.items() if key.startswith("Ice.")]
    # With spellings, a property that is not one of Ice may be a parameter.
    others = (
        []
        if linked.parameters.spellings
        else [(key, value) for key, value in own.items() if not key.startswith("Ice.")]
    )
    return [("ice", ice), ("properties", others)]
