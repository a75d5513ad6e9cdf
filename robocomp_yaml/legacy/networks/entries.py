"""Convert a node to an entry of `components:`: a program, a second name of a process, or a component."""

from __future__ import annotations

import os
from collections.abc import Mapping

import msgspec

from robocomp_yaml.legacy.document import List, Map, Raw
from robocomp_yaml.legacy.networks.components import KnownComponent
from robocomp_yaml.legacy.networks.kept import NOTHING, Derivable, drop_derived
from robocomp_yaml.legacy.networks.node import NetworkNode
from robocomp_yaml.legacy.networks.served import candidates, relative_to
from robocomp_yaml.source.rcremote import NodeCommand

COMMON = "CommonBehavior"
LINE = 200
"""What nobody reads but RCManager has one line, although it is longer than others."""


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


def program_entry(
    node: NetworkNode, host: str, after: List, site: Destination, *, process: str = "", home: str = "",
    derivable: Derivable = NOTHING,
) -> Map:  # fmt: skip
    """`home` is the folder in the repository that is the program's working folder on the machine of the file."""
    entry = Map(block=True)
    command = node.command
    if process:
        entry.put("process", process)
    elif command is not None:
        entry.put("program", command.words[0], node.by_key.get("program"))
        entry.put_some("host", host)
        folder = os.path.relpath(home, site.folder) if home else command.folder
        entry.put_some("cwd", folder, node.by_key.get("cwd"))
        entry.put_some("args", List.of(command.full[1:]))
    if node.endpoint is not None and not node.is_only_pinged:
        endpoints = Map.of({node.interface: node.endpoint.text})
        entry.put("endpoints", endpoints, node.by_key.get("endpoints"))
    elif node.endpoint is not None and not process:
        entry.put("ready", Map.of({"ping": node.endpoint.pinged(node.elsewhere)}), node.by_key.get("endpoints"))
    return _completed(entry, node, after, site.key, derivable)


def component_entry(
    node: NetworkNode, component: KnownComponent, host: str, after: List, site: Destination,
    connect: Mapping[str, str], configured: Mapping[str, int], derivable: Derivable,
) -> tuple[Map, str]:  # fmt: skip
    """Return the entry, and the problem of its endpoint, or ''. `configured` are the ports of its configuration, which
    need not be repeated."""
    command = node.command
    assert command is not None
    entry, problem = Map(block=True), ""
    home = os.path.dirname(component.path) or "."
    entry.put("component", os.path.relpath(component.path, site.folder), node.by_key.get("program"))
    executable = relative_to(command.program, command.folder, home)
    if executable and executable != f"bin/{component.name}" and os.path.isfile(os.path.join(home, executable)):
        entry.put("executable", executable)
    entry.put_some("host", host)
    entry.put_some("args", List.of(command.words[command.words.index(command.program) + 1 :]))
    if command.config:
        entry.put("config", _config(command, component, site))
    if node.endpoint is not None and not node.is_only_pinged:
        problem = _ports(entry, node, component, configured)
    entry.put_some("connect", Map.of(connect))
    return _completed(entry, node, after, site.key, derivable), problem


def _ports(entry: Map, node: NetworkNode, component: KnownComponent, configured: Mapping[str, int]) -> str:
    endpoint = node.endpoint
    assert endpoint is not None
    served = [*component.implements, COMMON]
    name = next((name for name in served if name.lower() == node.interface.lower()), None)
    if name is None:
        return f"'{node.alias}' serves '{node.interface}', which {component.name} does not implement"
    if len(configured) > 1 and configured.get(name.lower()) == endpoint.port:
        return ""
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
    below = relative_to(command.config, command.folder, home)
    paths = list(candidates(command.config, command.folder, home, site.sources))
    for real in map(os.path.realpath, paths):
        if real in site.documents:
            site.owners.setdefault(real, component.path)
            return os.path.relpath(site.documents[real], home)
    existing = next((path for path in paths if os.path.isfile(path)), None)
    return os.path.relpath(existing, home) if existing is not None else below or command.config


def _completed(entry: Map, node: NetworkNode, after: List, key: str, derivable: Derivable) -> Map:
    """Return the entry with its dependences, and with what an exporter cannot derive."""
    entry.put_some("after", after)
    drop_derived(node, derivable)
    node.extra.limit = LINE
    entry.put_some(key, node.extra)
    return entry
