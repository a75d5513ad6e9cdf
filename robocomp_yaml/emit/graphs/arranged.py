"""Arranges nodes for a screen: in a grid, read from left to right, in which hosts and their groups are rectangles.

What needs others is on their left. Each node has a cell. Nodes that have a cell keep it: what is added is put beside
what it needs, in a free cell or in a slot of its own, so that a picture changes only where the network does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.emit.graphs.grid import Area, NodeGrid
from robocomp_yaml.emit.graphs.packing import SHAPES, WIDER, Item, Spot, packed, score
from robocomp_yaml.emit.graphs.picture import Cell, Picture, PictureNode
from robocomp_yaml.grouping import grouped

Frame = tuple[str, str]
"""A host and a group of it; '' for what is in none."""

_LEAST, _LEAST_INSIDE = 7.0, 3.5  # rows of a picture and of a frame that need not be smaller
_MANY = 100  # nodes from which on only the first of these shapes is tried
_INSIDE: Sequence[Sequence[float]] = (SHAPES, (0.6,), (1.0,), (1.3,), (1.7,))


class Arranged(msgspec.Struct):
    """`grid` has a row for each layer and a column for each slot. `groups` are the areas of groups, each with its host.
    `cells` are to be passed to the next `arrange`."""

    grid: NodeGrid
    groups: list[tuple[str, Area]]
    cells: dict[str, Cell]


def arrange(picture: Picture, kept: Mapping[str, Cell] = {}, wider: float = WIDER) -> Arranged:
    """The arrangement of a picture, in which nodes keep these cells, unless they are in another host or group now, or
    others are there. `wider`: see WIDER."""
    needs = picture.needs()
    cells = _kept(picture, kept)
    if not cells:
        cells = _fresh(picture, needs, wider)
    else:
        _Adding(picture, cells, needs).add()
    return _placed(picture, cells)


def _frame(node: PictureNode) -> Frame:
    return node.box, node.groups[0] if node.groups else ""


def _fresh(picture: Picture, needs: Mapping[str, Sequence[str]], wider: float) -> dict[str, Cell]:
    """The cells of a picture that nobody has seen yet: groups are packed, then hosts of them, then all. What is inside
    is tried in several shapes."""
    names = list(picture.nodes)
    if not names:
        return {}
    has_frames = len({_frame(node) for node in picture.nodes.values()}) > 1
    shapes = _INSIDE if has_frames and len(names) < _MANY else _INSIDE[:1]
    tried = [_Packing(picture, needs, one, wider).of(names, 0) for one in shapes]
    spots = min(tried, key=lambda one: score(one, needs, _LEAST, wider))
    return {name: Cell(layer, slot, *_frame(picture.nodes[name])) for name, (layer, slot) in spots.items()}


class _Packing(msgspec.Struct):
    """`shapes` are those of frames."""

    picture: Picture
    needs: Mapping[str, Sequence[str]]
    shapes: Sequence[float]
    wider: float

    def of(self, names: Sequence[str], depth: int) -> dict[str, Spot]:
        """The spots of nodes, which share `depth` frames: 0 in the picture, 1 in a host, 2 in a group."""
        inside = self._inside(names, depth)
        if len(inside) == 1 and depth < 2 and len(names) > 1:  # one host has all
            return self.of(names, depth + 1)
        return self._around({item: self._within(members, depth) for item, members in inside.items()}, depth)

    def _inside(self, names: Sequence[str], depth: int) -> dict[str, list[str]]:
        """The nodes of each frame, and those in none."""
        found: dict[str, list[str]] = {}
        for name in names:
            frame = _frame(self.picture.nodes[name])
            chosen = next((one for one in range(depth, 2) if frame[one]), 2)
            found.setdefault(f"{chosen} {frame[chosen]}" if chosen < 2 else f"- {name}", []).append(name)
        return found

    def _within(self, names: Sequence[str], depth: int) -> dict[str, Spot]:
        if len(names) == 1:
            return {names[0]: (0, 0)}
        is_host = depth == 0 and bool(_frame(self.picture.nodes[names[0]])[0])
        return self.of(names, 1 if is_host else 2)

    def _around(self, within: Mapping[str, Mapping[str, Spot]], depth: int) -> dict[str, Spot]:
        """The spots, with these rectangles packed."""
        item_of = {name: item for item, found in within.items() for name in found}
        items = [Item(item, max(x for x, _ in found.values()) + 1, max(y for _, y in found.values()) + 1)
                 for item, found in within.items()]  # fmt: skip
        links = grouped(
            (item, item_of[other]) for name, item in item_of.items() for other in self.needs.get(name, ())
            if item_of.get(other, item) != item
        )  # fmt: skip
        is_all = len(item_of) == len(self.picture.nodes)
        effort = len(items) / len(self.picture.nodes)
        made = packed(items, links, _LEAST if is_all else _LEAST_INSIDE, SHAPES if is_all else self.shapes, effort,
                      self.wider)  # fmt: skip
        return {
            name: (made.spots[item][0] + x, made.spots[item][1] + y)
            for item, found in within.items() for name, (x, y) in found.items()
        }  # fmt: skip


class _Bounds(msgspec.Struct):
    left: int
    right: int
    top: float
    bottom: float

    def grow(self, cell: Cell) -> None:
        self.left, self.right = min(self.left, cell.layer), max(self.right, cell.layer)
        self.top, self.bottom = min(self.top, cell.slot), max(self.bottom, cell.slot)

    @property
    def corners(self) -> tuple[Cell, Cell]:
        return Cell(self.left, self.top), Cell(self.right, self.bottom)

    def meets(self, other: _Bounds) -> bool:
        return (self.left <= other.right and other.left <= self.right
                and self.top <= other.bottom and other.top <= self.bottom)  # fmt: skip

    def has(self, layer: int, slot: float) -> bool:
        return self.left <= layer <= self.right and self.top <= slot <= self.bottom


def _bounds(cells: Iterable[Cell]) -> _Bounds:
    first, *others = cells
    made = _Bounds(first.layer, first.layer, first.slot, first.slot)
    for one in others:
        made.grow(one)
    return made


def _kept(picture: Picture, kept: Mapping[str, Cell]) -> dict[str, Cell]:
    """The cells that nodes keep: no two are the same, and no frame is in another one."""
    own: dict[Frame, dict[str, Cell]] = {}
    taken: set[tuple[int, float]] = set()
    for name, cell in kept.items():
        node = picture.nodes.get(name)
        if node is not None and (cell.box, cell.group) == _frame(node) and (cell.layer, cell.slot) not in taken:
            own.setdefault(_frame(node), {})[name] = cell
            taken.add((cell.layer, cell.slot))
    made: dict[str, Cell] = {}
    frames = _Frames()
    for frame in sorted(own, key=lambda frame: not frame[1]):  # groups first, as a whole
        found = own[frame]
        for names in [list(found)] if frame[1] else [[name] for name in found]:
            if frames.accept(frame, [found[name] for name in names]):
                made.update((name, found[name]) for name in names)
    return {name: made[name] for name in kept if name in made}


class _Frames:
    """Frames that do not meet: hosts, groups, and what is in no host."""

    def __init__(self) -> None:
        self.hosts: dict[str, _Bounds] = {}
        self.groups: list[_Bounds] = []
        self.alone: list[Cell] = []

    def accept(self, frame: Frame, cells: Sequence[Cell]) -> bool:
        """Whether these cells, of a group or of one node without, meet no frame of others; then they are one."""
        host, group = frame
        bounds = _bounds(cells)
        around = _bounds([*cells, *(self.hosts[host].corners if host in self.hosts else ())]) if host else bounds
        others = [one for name, one in self.hosts.items() if name != host]
        if any(map(bounds.meets, self.groups)) or any(map(around.meets, others)):
            return False
        if any(around.has(one.layer, one.slot) for one in self.alone):
            return False
        if group:
            self.groups.append(bounds)
        if host:
            self.hosts[host] = around
        elif not group:
            self.alone += cells
        return True


class _Adding:
    """Adds cells for the nodes that have none. The frames stay apart: they only get slots between two others."""

    def __init__(self, picture: Picture, cells: dict[str, Cell], needs: Mapping[str, Sequence[str]]) -> None:
        self.picture, self.cells, self.needs = picture, cells, needs
        self.users = grouped((other, name) for name, others in needs.items() for other in others)

    def add(self) -> None:
        for name, node in self.picture.nodes.items():
            if name not in self.cells:
                self.cells[name] = self._cell(name, _frame(node))

    def _cell(self, name: str, frame: Frame) -> Cell:
        """Beside what the node needs, or what needs it."""
        cells = self.cells
        users = [cells[one] for one in self.users.get(name, ()) if one in cells]
        needed = [cells[one] for one in self.needs.get(name, ()) if one in cells]
        last = max((cell.layer for cell in cells.values()), default=0)
        behind, before = [cell.layer + 1 for cell in users], [cell.layer - 1 for cell in needed]
        layer = min(max(behind) if behind else max(min(before), 0) if before else 0, last)
        group = [cell for cell in cells.values() if (cell.box, cell.group) == frame] if frame[1] else []
        host = [cell for cell in cells.values() if not frame[0] or cell.box == frame[0]]
        if not group and not host:  # a host that is new
            return Cell(layer, math.floor(max((cell.slot for cell in cells.values()), default=-1)) + 1, *frame)
        bounds = _bounds(group or host)
        if group or not frame[1]:
            slots = [cell.slot for cell in (*users, *needed)]
            free = self._free(bounds, frame, layer, sum(slots) / len(slots) if slots else bounds.top)
            if free is not None:
                return Cell(*free, *frame)
        return Cell(min(max(layer, bounds.left), bounds.right), self._below(bounds.bottom), *frame)

    def _free(self, bounds: _Bounds, frame: Frame, wanted: int, middle: float) -> tuple[int, float] | None:
        """The closest free cell of a frame that is in no frame inside it."""
        taken = {(cell.layer, cell.slot) for cell in self.cells.values()}
        inner = self._frames(frame)
        slots = sorted({cell.slot for cell in self.cells.values() if bounds.top <= cell.slot <= bounds.bottom})
        found = [
            (abs(layer - wanted) + abs(slot - middle), layer, slot)
            for layer in range(bounds.left, bounds.right + 1) for slot in slots
            if (layer, slot) not in taken and not any(one.has(layer, slot) for one in inner)
        ]  # fmt: skip
        return min(found)[1:] if found else None

    def _frames(self, frame: Frame) -> list[_Bounds]:
        """What a node of this frame may not be put into."""
        found: dict[Frame, list[Cell]] = {}
        for cell in self.cells.values():
            if cell.group and (cell.box, cell.group) != frame:
                found.setdefault((cell.box, cell.group), []).append(cell)
            if cell.box and cell.box != frame[0]:
                found.setdefault((cell.box, ""), []).append(cell)
        return [_bounds(cells) for cells in found.values()]

    def _below(self, slot: float) -> float:
        """A slot between this one and the next."""
        following = min((cell.slot for cell in self.cells.values() if cell.slot > slot), default=slot + 2)
        return (slot + following) / 2


def _placed(picture: Picture, cells: Mapping[str, Cell]) -> Arranged:
    """The grid of these cells, without empty layers and slots, and the areas of hosts and groups."""
    rows = {layer: row for row, layer in enumerate(sorted({cell.layer for cell in cells.values()}))}
    columns = {slot: at for at, slot in enumerate(sorted({cell.slot for cell in cells.values()}))}
    grid = NodeGrid({name: (rows[cell.layer], columns[cell.slot]) for name, cell in cells.items()},
                    rows=len(rows), columns=len(columns))  # fmt: skip
    framed = [(_frame(node), grid.cells[name]) for name, node in picture.nodes.items()]
    hosts = grouped((frame[0], cell) for frame, cell in framed if frame[0])
    groups = grouped((frame, cell) for frame, cell in framed if frame[1])
    grid.areas = [_area(host, own) for host, own in hosts.items()]
    return Arranged(grid, [(host, _area(group, own)) for (host, group), own in groups.items()], dict(cells))


def _area(name: str, cells: Sequence[tuple[int, int]]) -> Area:
    rows, columns = [row for row, _ in cells], [column for _, column in cells]
    return Area(name, min(rows), max(rows), min(columns), max(columns))
