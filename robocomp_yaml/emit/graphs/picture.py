"""What a picture of a network shows, whatever it is drawn with: boxes of hosts, nodes in them, and lines."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

COMPONENT, PROGRAM, ICESTORM, TOPIC, OUTSIDE = "component", "program", "icestorm", "topic", "outside"
_EVERYBODYS = "CommonBehavior"
USES, PUBLISHES, SUBSCRIBES, AFTER = "uses", "publishes", "subscribes", "after"


class PictureFault(msgspec.Struct, frozen=True):
    """A problem, as the diagnostics say it."""

    code: str
    is_error: bool
    message: str

    @property
    def text(self) -> str:
        return f"{self.code}: {self.message}"


class Box(msgspec.Struct, frozen=True):
    """A host. `title` is what stands on it."""

    name: str
    title: str


class PictureNode(msgspec.Struct, frozen=True):
    """`box` is the name of a box, '' for what is outside. `about` are short lines below the name. `serves` are
    interfaces with their ports, 0 where none is known."""

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
        """What it serves in words, but for what every component serves besides."""
        own = [(name, port) for name, port in self.serves if name != _EVERYBODYS] or self.serves
        return [f"{name} {port}" if port else name for name, port in own]

    def texts(self) -> list[str]:
        """Its lines of text, the title first."""
        return [self.title, *self.about, *self.served()]


class PictureLine(msgspec.Struct, frozen=True):
    """From `source`, which needs something, to `target`, which has it: `label` says what. Of a topic both who publishes
    and who subscribes are sources; what flows, flows to the topic (PUBLISHES) or from it (SUBSCRIBES)."""

    source: str
    target: str
    label: str = ""
    kind: str = USES
    faults: tuple[PictureFault, ...] = ()


class Picture(msgspec.Struct):
    """`faults` are those that belong to nothing in the picture."""

    name: str
    boxes: list[Box] = []
    nodes: dict[str, PictureNode] = {}
    lines: list[PictureLine] = []
    faults: tuple[PictureFault, ...] = ()

    def inside(self, box: str) -> list[PictureNode]:
        return [node for node in self.nodes.values() if node.box == box]

    def all_faults(self) -> Iterator[tuple[str, PictureFault]]:
        """Each problem once, with the name of what has it."""
        seen: set[PictureFault] = set()
        owners = [(node.title, node.faults) for node in self.nodes.values()]
        owners += [(line.source, line.faults) for line in self.lines]
        for name, faults in [*owners, (self.name, self.faults)]:
            for fault in faults:
                if fault not in seen:
                    seen.add(fault)
                    yield name, fault
