"""The text of a component's first values document: with the endpoints and proxies that it will need, and with what its
`etc/config` says so far, so that a compile changes nothing that runs."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from robocomp_yaml.emit import config
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.emit.ports import PortTable
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters
from robocomp_yaml.parameters.examples.new import Sections, new_document
from robocomp_yaml.parameters.kinds import recording
from robocomp_yaml.parameters.types import Parameters, RecordType
from robocomp_yaml.semantics import composite, connections
from robocomp_yaml.semantics.plain import Taking
from robocomp_yaml.semantics.reading import Reader
from robocomp_yaml.semantics.references import unresolved
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.properties import read
from robocomp_yaml.source.regular import text
from robocomp_yaml.transactions.manifest import BASE


def first_values(
    linked: LinkedParameters, component: str, target: str, table: Callable[[LinkedComponent], PortTable]
) -> str:
    """`component` is the path of the CDSL (or PDSL), `target` that of the document to be; `table` gives the ports of a
    component's workspace."""
    folder = os.path.dirname(target) or "."
    where = os.path.relpath(component, folder)
    schema = os.path.relpath(os.path.join(os.path.dirname(component), "generated", "config.schema.json"), folder)
    modeline = f"# yaml-language-server: $schema={schema}"
    sections: Sections = []
    values: dict[str, Any] = {}
    if linked.component is not None:
        home = os.path.dirname(linked.component.component.path)
        standing = config.standing(home)
        ports = table(linked.component)
        sections = _connections(linked.component, standing, ports)
        if standing:
            changed = _changed(home, standing, config.plan(linked.component, ports).text)
            changed = {key: unquoted(value) for key, value in changed.items()} if _is_toml(standing) else changed
            values = _values(linked.parameters, standing)
            sections += _others(linked, changed)
    return new_document(linked.parameters, where, modeline, sections, values)


def _connections(linked: LinkedComponent, standing: Mapping[str, str], table: PortTable) -> Sections:
    """Where it and the others are: as it stands, else as compile would have it."""
    usual = config.connections(linked, table, standing)
    found = {key: config.stated(standing, key) or value for key, value in usual.items()}
    served = [(key.removesuffix(".Endpoints"), text) for key, text in found.items() if key.endswith(".Endpoints")]
    proxies = [(port.name, found[connections.proxy(port.name)[0]]) for port in linked.requires]
    manager = found.get(connections.MANAGER[0], "")
    topics = [("manager", manager)] if manager != usual.get(connections.MANAGER[0], "") else []
    return [("endpoints", served), ("proxies", proxies), ("topics", topics)]


def _changed(folder: str, standing: Mapping[str, str], usual: str) -> dict[str, str]:
    """What of an `etc/config` is not as rcyaml wrote it: a user's."""
    before = text(os.path.join(folder, BASE, CONFIG))
    written = read(usual if before is None else before).values
    return {key: value for key, value in standing.items() if value and written.get(key) != value}


def _values(parameters: Parameters, standing: Mapping[str, str]) -> dict[str, Any]:
    """The parameters that an `etc/config` gives other values than their defaults."""
    kind = recording(parameters.root)
    texts = Reader(standing, {each.path: each for each in parameters.spellings}, unresolved).read(kind)
    return _but_defaults(parameters.root, kind, texts)


def _is_toml(standing: Mapping[str, str]) -> bool:
    """Whether texts stand in quotes, as RoboComp's newer components have them."""
    return any(key.startswith(("Endpoints.", "Proxies.")) and value[:1] == '"' for key, value in standing.items())


def _but_defaults(record: RecordType, kind: composite.Recording, texts: Mapping[str, Any]) -> dict[str, Any]:
    """What of the values that the texts spell fits its type, and is no default."""
    kept: dict[str, Any] = {}
    for member in record.members:
        if member.name not in texts:
            continue
        inner, text = kind.members[member.name].kind, texts[member.name]
        if isinstance(inner, composite.Recording) and isinstance(member.type, RecordType) and inner.is_group:
            kept[member.name] = _but_defaults(member.type, inner, text)
            continue
        taking = Taking(is_text=True)
        taken = inner.take(text, (), taking)
        value = None if taking.problems else composite.data(inner, taken)
        if value is not None and (member.default is None or value != member.default.data):
            kept[member.name] = value
    return kept


def _others(linked: LinkedParameters, changed: Mapping[str, str]) -> Sections:
    """The user's entries that are neither connections nor parameters."""
    assert linked.component is not None
    root = linked.parameters.root
    known = {key for each in config.needed(linked.component) for key in config.names(each)}
    own = {
        key: value for key, value in changed.items() if key not in known and root.member(key.partition(".")[0]) is None
    }
    ice = [(key.removeprefix("Ice."), value) for key, value in own.items() if key.startswith("Ice.")]
    # Which property a spelling of its own means is not known here: what is none of Ice's may be a parameter.
    others = (
        []
        if linked.parameters.spellings
        else [(key, value) for key, value in own.items() if not key.startswith("Ice.")]
    )
    return [("ice", ice), ("properties", others)]
