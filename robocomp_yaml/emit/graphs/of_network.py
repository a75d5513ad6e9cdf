"""The picture of a network, with diagnostics at their nodes and lines."""

from __future__ import annotations

import os
from bisect import bisect_right
from collections.abc import Iterable, Sequence

from robocomp_yaml.diag.diagnostic import ERROR, WARNING, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.picture import Box, Picture, PictureFault, PictureLine, PictureNode
from robocomp_yaml.grouping import grouped
from robocomp_yaml.network.network import LOOPBACK, PROXY, Connection, Network, Process


def picture_of(network: Network, diagnostics: Sequence[Diagnostic] = ()) -> Picture:
    """The picture of a network: hosts are boxes, processes and topics are nodes, connections are lines."""
    faults = _Faults(network, diagnostics)
    made = Picture(network.name)
    used = {process.host for process in network.processes.values()}
    made.boxes = [
        Box(host.name, host.name if host.name == host.address else f"{host.name} ({host.address})")
        for host in network.hosts.values() if host.name in used
    ]  # fmt: skip
    if len(made.boxes) == 1 and network.hosts[made.boxes[0].name].address == LOOPBACK:
        made.boxes = [Box(made.boxes[0].name, "this machine")]
    for process in network.processes.values():
        made.nodes[process.name] = _node(process, faults.of_process.get(process.name, ()))
    for number, connection in enumerate(network.connections):
        _connect(made, network, connection, faults.of_connection.get(number, ()))
    made.lines += _order(network)
    made.faults = tuple(faults.rest)
    return made


def _node(process: Process, faults: Sequence[PictureFault]) -> PictureNode:
    about = [f"also {alias}" for alias in process.aliases]
    if process.kind == parts.COMPONENT and process.component:
        about.insert(0, process.component)
    elif process.kind == parts.PROGRAM:
        about.insert(0, " ".join([os.path.basename(process.command[0]), *_script(process.command[1:2])]))
    elif process.kind == parts.ICESTORM:
        about.insert(0, "IceStorm")
    serves = [(endpoint.interface, endpoint.port) for endpoint in process.endpoints]
    return PictureNode(
        process.name, process.name, process.kind, process.host, tuple(about), tuple(serves), process.groups,
        process.enabled, tuple(faults),
    )  # fmt: skip


def _script(words: Sequence[str]) -> list[str]:
    """The names of scripts among these words: they say more than the name of the interpreter."""
    return [os.path.basename(word) for word in words if word.endswith((".py", ".sh"))]


def _connect(made: Picture, network: Network, connection: Connection, faults: Sequence[PictureFault]) -> None:
    if connection.kind == PROXY:
        target = network.find(connection.target)
        name = target.name if target is not None else connection.proxy or connection.target
        if target is None and name not in made.nodes:
            title = name.partition(":")[0] if connection.proxy else name
            address = name.partition(":")[2]
            made.nodes[name] = PictureNode(name, title, parts.OUTSIDE, about=(address,) if address else ())
        label = connection.interface
        if connection.port not in (label, ""):
            label = f"{connection.port}: {label}"
        made.lines.append(PictureLine(connection.source, name, label, parts.USES, tuple(faults)))
        return
    topic = f"{connection.target}/{connection.topic}"
    storm = network.processes.get(connection.target)
    about = f"topic of {connection.target}" if connection.target else "topic"
    host = storm.host if storm is not None else ""
    made.nodes.setdefault(topic, PictureNode(topic, connection.topic, parts.TOPIC, host, (about,)))
    kind = parts.PUBLISHES if connection.is_out else parts.SUBSCRIBES
    label = "" if connection.interface in connection.topic else connection.interface
    made.lines.append(PictureLine(connection.source, topic, label, kind, tuple(faults)))


def _order(network: Network) -> Iterable[PictureLine]:
    """The lines of dependences without a connection."""
    connected = {(connection.source, connection.target) for connection in network.connections}
    for process in network.processes.values():
        for other in process.after:
            if (process.name, other) not in connected:
                yield PictureLine(process.name, other, kind=parts.AFTER)


class _Faults:
    """Assigns diagnostics to processes and connections, by their locations in the document."""

    def __init__(self, network: Network, diagnostics: Sequence[Diagnostic]) -> None:
        self.of_process: dict[str, list[PictureFault]] = {}
        self.of_connection: dict[int, list[PictureFault]] = {}
        self.rest: list[PictureFault] = []
        self._starts = grouped((one.span.file, (one.span.line, one.name)) for one in network.processes.values())
        for starts in self._starts.values():
            starts.sort()
        lines = {(c.span.file, c.span.line, c.span.column): n for n, c in enumerate(network.connections) if c.span.file}
        for diagnostic in diagnostics:
            if diagnostic.severity in (ERROR, WARNING):
                self._put(diagnostic, lines)

    def _put(self, diagnostic: Diagnostic, lines: dict[tuple[str, int, int], int]) -> None:
        fault = PictureFault(diagnostic.code, diagnostic.severity == ERROR, diagnostic.message)
        span = diagnostic.span
        number = lines.get((span.file, span.line, span.column))
        names = dict.fromkeys(map(self._owner, (span, *(related.span for related in diagnostic.related))))
        if number is not None:
            self.of_connection.setdefault(number, []).append(fault)
        for name in names:
            if name:
                self.of_process.setdefault(name, []).append(fault)
        if number is None and not any(names):
            self.rest.append(fault)

    def _owner(self, span: Span) -> str:
        """The name of the process whose entry contains a location, '' for none."""
        starts = self._starts.get(span.file, [])
        at = bisect_right(starts, (span.line, chr(0x10FFFF)))
        return starts[at - 1][1] if at else ""
