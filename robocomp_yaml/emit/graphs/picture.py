"""The content of a picture of a network, for all forms: boxes of hosts, nodes in them, and lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

COMPONENT, PROGRAM, ICESTORM, TOPIC, OUTSIDE = "component", "program", "icestorm", "topic", "outside"
_EVERY_COMPONENT = "CommonBehavior"
USES, PUBLISHES, SUBSCRIBES, AFTER = "uses", "publishes", "subscribes", "after"


class PictureFault(msgspec.Struct, frozen=True):
    """A diagnostic that a picture shows."""

    code: str
    is_error: bool
    message: str

    @property
    def text(self) -> str:
        return f"{self.code}: {self.message}"


class Box(msgspec.Struct, frozen=True):
    """A host. `title` is its text in the picture."""

    name: str
    title: str


class PictureNode(msgspec.Struct, frozen=True):
    """`box` is the name of a box, '' if the node is outside. `about` are short lines below the title. `serves` are
    interfaces with their TCP ports, 0 if a port is unknown."""

    name: str
    title: str
    kind: str
    box: str = ""
    about: tuple[str, ...] = ()
    serves: tuple[tuple[str, int], ...] = ()
    groups: tuple[str, ...] = ()
    enabled: bool = True
    faults: tuple[PictureFault, ...] = ()

    def served(self) -> list[str]:
        """The interfaces that the node serves, with their ports, without those of every component."""
        own = [(name, port) for name, port in self.serves if name != _EVERY_COMPONENT] or self.serves
        return [f"{name} {port}" if port else name for name, port in own]

    def texts(self) -> list[str]:
        """The lines of text of the node, the title first."""
        return [self.title, *self.about, *self.served()]


class PictureLine(msgspec.Struct, frozen=True):
    """A line from `source`, which needs what `label` names, to `target`, which serves it. A target may be a topic: its
    publishers and subscribers are sources. Events flow to the topic (PUBLISHES) or from it (SUBSCRIBES)."""

    source: str
    target: str
    label: str = ""
    kind: str = USES
    faults: tuple[PictureFault, ...] = ()


class Cell(msgspec.Struct, frozen=True):
    """Where a node is: `layer` counts from the left, `slot` from the top, and what was added has a slot between two
    others. It holds as long as the node is in this host (`box`) and group."""

    layer: int
    slot: float
    box: str = ""
    group: str = ""


class Picture(msgspec.Struct):
    """`faults` are those that belong to no node and no line. `cells` are those of nodes that stay where they are;
    `positions` are those that a person chose, in pixels."""

    name: str
    boxes: list[Box] = []
    nodes: dict[str, PictureNode] = {}
    lines: list[PictureLine] = []
    faults: tuple[PictureFault, ...] = ()
    cells: Mapping[str, Cell] = {}
    positions: Mapping[str, tuple[float, float]] = {}

    def needs(self) -> dict[str, list[str]]:
        """The other nodes that each node has a line to, each once."""
        found: dict[str, list[str]] = {}
        for line in self.lines:
            if line.source != line.target and line.target not in found.setdefault(line.source, []):
                found[line.source].append(line.target)
        return found

    def inside(self, box: str) -> list[PictureNode]:
        """The nodes in a box; those outside for ''."""
        return [node for node in self.nodes.values() if node.box == box]

    def all_faults(self) -> Iterator[tuple[str, PictureFault]]:
        """Each diagnostic once, with the title of its node, the source of its line, or the name of the picture."""
        seen: set[PictureFault] = set()
        owners = [(node.title, node.faults) for node in self.nodes.values()]
        owners += [(line.source, line.faults) for line in self.lines]
        for name, faults in [*owners, (self.name, self.faults)]:
            for fault in faults:
                if fault not in seen:
                    seen.add(fault)
                    yield name, fault
