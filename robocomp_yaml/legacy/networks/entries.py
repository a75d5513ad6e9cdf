"""Convert a node to an entry of `components:`: a program, a second name of a process, or a component."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.legacy.document import List, Map, Raw
from robocomp_yaml.legacy.networks.command import LOCAL, LOOPBACK, NodeCommand
from robocomp_yaml.legacy.networks.components import KnownComponent
from robocomp_yaml.legacy.networks.node import NetworkNode

COMMON = "CommonBehavior"


class Destination(msgspec.Struct, frozen=True):
    """The path of a deployment's document, and the document of each legacy file of the run, by the file's real path.
    What only an exporter needs is written under `key`. `sources` is the folder of the legacy repository. `owners` gets
    the document of each component that a network configures, by the real path of the config."""

    document: str
    documents: Mapping[str, str]
    key: str
    sources: str
    owners: dict[str, str]

    @property
    def folder(self) -> str:
        return os.path.dirname(self.document) or "."


def program_entry(node: NetworkNode, host: str, after: List, site: Destination, *, process: str = "") -> Map:
    entry = Map(block=True)
    command = node.command
    if process:
        entry.put("process", process)
    elif command is not None:
        entry.put("program", command.words[0], node.by_key.get("program"))
        entry.put_some("host", host)
        entry.put_some("cwd", command.folder, node.by_key.get("cwd"))
        entry.put_some("args", List.of(command.full[1:]))
    if node.endpoint is not None:
        endpoints = Map.of({node.interface: node.endpoint.text})
        entry.put("endpoints", endpoints, node.by_key.get("endpoints"))
    return _completed(entry, node, after, site.key)


def component_entry(
    node: NetworkNode, component: KnownComponent, host: str, after: List, site: Destination,
    depends: Sequence[NetworkNode],
) -> tuple[Map, str]:  # fmt: skip
    """Return the entry, and the problem of its endpoint, or ''."""
    command = node.command
    assert command is not None
    entry, problem = Map(block=True), ""
    home = os.path.dirname(component.path) or "."
    entry.put("component", os.path.relpath(component.path, site.folder), node.by_key.get("program"))
    executable = _relative_to(command.program, command.folder, home)
    if executable and executable != f"bin/{component.name}" and os.path.isfile(os.path.join(home, executable)):
        entry.put("executable", executable)
    entry.put_some("host", host)
    entry.put_some("args", List.of(command.words[command.words.index(command.program) + 1 :]))
    if command.config:
        entry.put("config", _config(command, component, site))
    if node.endpoint is not None:
        problem = _ports(entry, node, component)
    connect = Map()
    for proxy, interface in component.requires.items():
        serving = [other for other in depends if other.interface.lower() == interface.lower()]
        if len(serving) == 1:
            connect.put(proxy, serving[0].name)
    entry.put_some("connect", connect)
    return _completed(entry, node, after, site.key), problem


def _ports(entry: Map, node: NetworkNode, component: KnownComponent) -> str:
    endpoint = node.endpoint
    assert endpoint is not None
    served = [*component.implements, COMMON]
    name = next((name for name in served if name.lower() == node.interface.lower()), None)
    if name is None:
        return f"'{node.alias}' serves '{node.interface}', which {component.name} does not implement"
    port = Raw(str(endpoint.port))
    notes = node.by_key.get("endpoints")
    if endpoint.options or endpoint.protocol not in ("tcp", "default"):
        entry.put("endpoints", Map.of({name: endpoint.text}), notes)
    elif name == served[0]:
        entry.put("port", port, notes)
    else:
        entry.put("ports", Map.of({name: port}), notes)
    return ""


def _config(command: NodeCommand, component: KnownComponent, site: Destination) -> str:
    """Return the path of the component's configuration from its folder: of the migrated document, if there is one."""
    home = os.path.dirname(component.path) or "."
    below = _relative_to(command.config, command.folder, home)
    paths = [os.path.join(home, below)] if below else []
    paths += [os.path.join(site.sources, tail) for tail in _tails(posixpath.join(command.folder, command.config))]
    for real in map(os.path.realpath, paths):
        if real in site.documents:
            site.owners.setdefault(real, component.path)
            return os.path.relpath(site.documents[real], home)
    existing = next((path for path in paths if os.path.isfile(path)), None)
    return os.path.relpath(existing, home) if existing is not None else below or command.config


def _tails(path: str) -> Iterator[str]:
    """Yield the ends of a path of another machine, with two names at least, the longest first."""
    names = [name for name in posixpath.normpath(path).split("/") if name]
    yield from ("/".join(names[n:]) for n in range(len(names) - 1))


def _relative_to(path: str, folder: str, home: str) -> str:
    """Return a path of the machine that the legacy file describes, relative to the component's folder; '' where it is
    not below."""
    if not posixpath.isabs(path) and not path.startswith("~"):
        path = posixpath.join(folder, path)
    name = os.path.basename(os.path.abspath(home))
    _, separator, inner = posixpath.normpath(path).rpartition(f"/{name}/")
    return inner if separator else ""


def _completed(entry: Map, node: NetworkNode, after: List, key: str) -> Map:
    """Return the entry with its dependences, and with what an exporter cannot derive."""
    entry.put_some("after", after)
    derived = _derived(node, entry)
    for extra in list(node.extra.entries):
        if extra.key in derived and extra.value == derived[extra.key]:
            node.extra.entries.remove(extra)
            node.notes.add(extra.notes)
    entry.put_some(key, node.extra)
    return entry


def _derived(node: NetworkNode, entry: Map) -> dict[str, str]:
    """Return what an exporter derives from the entry."""
    command, derived = node.command, dict[str, str]()
    if command is not None and any(entry.key == "cwd" for entry in entry.entries):
        derived["workingDir"] = posixpath.normpath(command.folder)
    endpoint = node.endpoint
    if command is not None and endpoint is not None and not node.is_shared and endpoint.identity.islower():
        derived["endpoint"] = endpoint.proxy(LOCAL if command.host in LOOPBACK else command.host)
    return derived
