"""One node as an entry of `components:`: a program, a second name of a process, or a component."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Mapping, Sequence

import msgspec

from robocomp_yaml.legacy.document import DocumentEntry, List, Map, Raw
from robocomp_yaml.legacy.networks.command import LOCAL, LOOPBACK, NodeCommand
from robocomp_yaml.legacy.networks.components import KnownComponent
from robocomp_yaml.legacy.networks.node import NetworkNode

COMMON = "CommonBehavior"


class Destination(msgspec.Struct, frozen=True):
    """Where a document will stand, and what each legacy file of the run becomes (by its real path)."""

    document: str
    chosen: Mapping[str, str]

    @property
    def folder(self) -> str:
        return os.path.dirname(self.document) or "."


def program_entry(node: NetworkNode, host: str, after: List, key: str, *, process: str = "") -> Map:
    made = Map(block=True)
    command = node.command
    if process:
        made.put("process", process)
    elif command is not None:
        made.put("program", command.words[0], node.by_key.get("program"))
        made.put_some("host", host)
        made.put_some("cwd", command.folder, node.by_key.get("cwd"))
        made.put_some("args", List.of(command.full[1:]))
    if node.endpoint is not None:
        endpoints = Map([DocumentEntry(node.interface, node.endpoint.text)])
        made.put("endpoints", endpoints, node.by_key.get("endpoints"))
    return _closed(made, node, after, key)


def component_entry(
    node: NetworkNode,
    component: KnownComponent,
    host: str,
    after: List,
    key: str,
    site: Destination,
    depends: Sequence[NetworkNode],
) -> tuple[Map, str]:
    """The entry, and what is odd about its endpoint, or ''."""
    command = node.command
    assert command is not None
    made, problem = Map(block=True), ""
    home = os.path.dirname(component.path) or "."
    made.put("component", os.path.relpath(component.path, site.folder), node.by_key.get("program"))
    executable = _below(command.program, command.folder, home)
    if executable and executable != f"bin/{component.name}" and os.path.isfile(os.path.join(home, executable)):
        made.put("executable", executable)
    made.put_some("host", host)
    made.put_some("args", List.of(command.words[command.words.index(command.program) + 1 :]))
    if command.config:
        made.put("config", _config(command, home, site))
    if node.endpoint is not None:
        problem = _ports(made, node, component)
    connect = Map()
    for proxy, interface in component.requires.items():
        serving = [other for other in depends if other.interface.lower() == interface.lower()]
        if len(serving) == 1:
            connect.put(proxy, serving[0].name)
    made.put_some("connect", connect)
    return _closed(made, node, after, key), problem


def _ports(made: Map, node: NetworkNode, component: KnownComponent) -> str:
    endpoint = node.endpoint
    assert endpoint is not None
    served = [*component.implements, COMMON]
    name = next((name for name in served if name.lower() == node.interface.lower()), None)
    if name is None:
        return f"'{node.alias}' answers as '{node.interface}', which {component.name} does not implement"
    port = Raw(str(endpoint.port))
    notes = node.by_key.get("endpoints")
    if endpoint.options or endpoint.protocol not in ("tcp", "default"):
        made.put("endpoints", Map([DocumentEntry(name, endpoint.text)]), notes)
    elif name == served[0]:
        made.put("port", port, notes)
    else:
        made.put("ports", Map([DocumentEntry(name, port)]), notes)
    return ""


def _config(command: NodeCommand, home: str, site: Destination) -> str:
    """The component's configuration from its folder: what this run makes of it, where it makes something."""
    below = _below(command.config, command.folder, home)
    if not below:
        return command.config
    document = site.chosen.get(os.path.realpath(os.path.join(home, below)))
    return os.path.relpath(document, home) if document is not None else below


def _below(path: str, folder: str, home: str) -> str:
    """A path of the machine that the file is about, from the component's folder; '' where it is not below."""
    if not posixpath.isabs(path) and not path.startswith("~"):
        path = posixpath.join(folder, path)
    name = os.path.basename(os.path.abspath(home))
    _, found, inner = posixpath.normpath(path).rpartition(f"/{name}/")
    return inner if found else ""


def _closed(made: Map, node: NetworkNode, after: List, key: str) -> Map:
    """The entry with what it waits for, and with what only an exporter needs and cannot know otherwise."""
    made.put_some("after", after)
    known = _known_anyway(node, made)
    for entry in list(node.extra.entries):
        if entry.key in known and entry.value == known[entry.key]:
            node.extra.entries.remove(entry)
            node.notes.add(entry.notes)
    made.put_some(key, node.extra)
    return made


def _known_anyway(node: NetworkNode, made: Map) -> dict[str, str]:
    """What an exporter says where nothing is kept."""
    command, known = node.command, dict[str, str]()
    if command is not None and any(entry.key == "cwd" for entry in made.entries):
        known["workingDir"] = posixpath.normpath(command.folder)
    endpoint = node.endpoint
    if command is not None and endpoint is not None and not node.is_shared and endpoint.identity.islower():
        known["endpoint"] = endpoint.proxy(LOCAL if command.host in LOOPBACK else command.host)
    return known
