"""The geometry of a picture for a screen, in pixels: from left to right, with lines that end at what they use.

A line ends beside the interface that it uses, in the box of the node that serves it, so that lines need no labels. As
in `geometry`, nothing overlaps, by construction.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from itertools import accumulate, pairwise

import msgspec

from robocomp_yaml.emit.graphs.arranged import Arranged, arrange
from robocomp_yaml.emit.graphs.geometry import STEP, TITLE, EdgePath, Point, Rectangle, even, texts_of
from robocomp_yaml.emit.graphs.grid import Area
from robocomp_yaml.emit.graphs.measure import shortened, width
from robocomp_yaml.emit.graphs.packing import WIDER
from robocomp_yaml.emit.graphs.picture import TOPIC, Cell, Picture, PictureLine, PictureNode
from robocomp_yaml.emit.graphs.routes import Net, NetBranch, routes_of
from robocomp_yaml.grouping import grouped

SMALL_ON_SCREEN = 12.0
"""The size of all texts but the titles of nodes."""
LINE_HEIGHT = 16.0
"""Twice the distance of two tracks: lines that end at texts are never on those that leave nodes."""
PAD, _NODE_PAD = 8.0, 12.0
HOST_TITLE, GROUP_TITLE = 24.0, 20.0
_NARROWEST = 104.0
_SIGN, _RATE = 12.0, 44.0  # at the right of a title: the state of a process, the rate of a topic
SCREEN = 1.5
"""How much wider the room for a picture is than it is high, on a screen."""
_FITS = 0.85, 1.15
_LARGEST = 1 / 540  # of which nothing is gained: the room on a small screen, at the largest zoom of a whole picture
_TRIES = (100, 4, 1.0), (700, 2, 0.75), (sys.maxsize, 0, 0.0)
"""By the number of nodes at most: how often another shape is tried, which takes as long as the first picture, and how
much of the difference is made up, because lines of another shape need other room, too."""


class ScreenGeometry(msgspec.Struct):
    """`groups` have their names and hosts. `lines` are the corners of each line of the picture, from its source to its
    target. `cells` are to be passed to the next `screen_geometry`, which keeps the nodes where they are."""

    width: float = 0.0
    height: float = 0.0
    nodes: dict[str, Rectangle] = {}
    hosts: dict[str, Rectangle] = {}
    groups: list[tuple[str, str, Rectangle]] = []
    lines: list[list[Point]] = []
    cells: dict[str, Cell] = {}


def screen_geometry(picture: Picture, kept: Mapping[str, Cell] = {}) -> ScreenGeometry:
    """The geometry of a picture. Nodes with a cell keep it, and nodes that a person moved are where they were put."""
    made = _placed(picture, arrange(picture, kept))
    if not made.cells.keys() & kept.keys():
        made = _as_wide_as_a_screen(picture, made)
    if not picture.positions.keys().isdisjoint(made.nodes):
        from robocomp_yaml.emit.graphs.moved import moved

        moved(picture, made)
    return made


def _placed(picture: Picture, arranged: Arranged) -> ScreenGeometry:
    made = _ScreenPlacer(picture, arranged).place()
    made.cells = arranged.cells
    return made


def _as_wide_as_a_screen(picture: Picture, first: ScreenGeometry) -> ScreenGeometry:
    """How wide slots and layers are is known when the texts and lines are placed: with that, a picture that is too wide
    or too high is arranged again. The best one is large on a screen, and has short lines."""
    best, last, wider = first, first, WIDER
    tries, part = next((tries, part) for most, tries, part in _TRIES if len(picture.nodes) <= most)
    for _ in range(tries):
        too_wide = last.width / max(last.height, 1.0) / SCREEN
        if _FITS[0] < too_wide < _FITS[1] or _scale(best) > _LARGEST:
            break
        wider *= too_wide**part
        last = _placed(picture, arrange(picture, wider=wider))
        if _worth(last) > _worth(best):
            best = last
    return best


def _worth(made: ScreenGeometry) -> float:
    """How large the picture is on a screen, less if its lines are long there."""
    pieces = (abs(x - u) + abs(y - v) for points in made.lines for (x, y), (u, v) in pairwise(points))
    return (scale := _scale(made)) / (1 + scale * sum(pieces) / max(len(made.lines), 1))


def _scale(made: ScreenGeometry) -> float:
    """How large the picture is on a screen that is one high."""
    return min(SCREEN / max(made.width, 1.0), 1 / max(made.height, 1.0))


class _ScreenPlacer:
    """Rows of the grid are layers, from left to right; its columns are slots, from top to bottom."""

    def __init__(self, picture: Picture, arranged: Arranged) -> None:
        self.picture, self.grid, self.groups = picture, arranged.grid, arranged.groups
        self.routes = routes_of(picture, arranged.grid)
        self.made = ScreenGeometry()
        self.ends = self._ends()
        self.coming, self.leaving = self._counts()
        self.hosts = self.grid.areas
        frames = [*self.grid.areas, *(area for _, area in self.groups)]
        self.lefts = {area.top for area in frames}
        self.rights = {area.bottom + 1 for area in frames}

    def place(self) -> ScreenGeometry:
        for name, node in self.picture.nodes.items():
            self.made.nodes[name] = self._block(node)
        self._measure()
        for name, block in self.made.nodes.items():
            row, column = self.grid.cells[name]
            block.x, block.y, block.width = self.x[row], self.y[column], self.wide[row]
        for area in self.hosts:
            title = next(box.title for box in self.picture.boxes if box.name == area.name)
            self.made.hosts[area.name] = self._box(area, title, HOST_TITLE + self._room_above(area), 2 * PAD)
        for host, area in self.groups:
            self.made.groups.append((area.name, host, self._box(area, area.name, GROUP_TITLE, PAD)))
        self._route()
        return self.made

    def _ends(self) -> dict[Net, int]:
        """The line of text, in the box of its target, at which each net ends: that of the interface, or one that no
        other net uses."""
        found: dict[Net, int] = {}
        used: dict[str, set[int]] = {}
        later: list[Net] = []
        for net in self.routes.nets:
            node = self.picture.nodes[net.target]
            texts = _texts(node)
            names = [text.partition(" ")[0] for text in texts]
            at = names.index(net.label, 1) if net.label in names[1:] else -1
            if at < 0 or at in used.setdefault(net.target, set()):
                later.append(net)
            else:
                found[net] = at
                used[net.target].add(at)
        for net in later:
            taken = used.setdefault(net.target, set())
            found[net] = next(at for at in range(len(taken) + 1) if at not in taken)
            taken.add(found[net])
        return found

    def _counts(self) -> tuple[dict[str, int], dict[str, int]]:
        """The lines of text that each node needs for the nets that end there, and the branches that begin there."""
        coming: dict[str, int] = {}
        leaving: dict[str, int] = {}
        for net, at in self.ends.items():
            coming[net.target] = max(coming.get(net.target, 0), at + 1)
            for branch in net.branches:
                leaving[branch.source] = leaving.get(branch.source, 0) + 1
        return coming, leaving

    def _block(self, node: PictureNode) -> Rectangle:
        texts = _texts(node)
        sign = _RATE if node.kind == TOPIC else _SIGN
        widest = max([width(texts[0], TITLE, bold=True) + sign, *(width(text, SMALL_ON_SCREEN) for text in texts[1:])])
        lines = max(len(texts), self.coming.get(node.name, 0), (self.leaving.get(node.name, 0) + 1) // 2)
        return Rectangle(0, 0, max(even(widest + 2 * _NODE_PAD), _NARROWEST), LINE_HEIGHT * lines + STEP, texts)

    def _measure(self) -> None:
        """Computes where layers and slots begin, behind channels and gaps that have room for their tracks."""
        grid = self.grid
        self.wide, high = [0.0] * grid.rows, [0.0] * grid.columns
        for name, block in self.made.nodes.items():
            row, column = grid.cells[name]
            self.wide[row] = max(self.wide[row], block.width)
            high[column] = max(high[column], block.height)
        self.channels = [self._channel(row) for row in range(grid.rows + 1)]
        self.gaps = [self._gap(column) for column in range(grid.columns + 1)]
        ends = list(accumulate(a + b for a, b in zip(self.channels, [*self.wide, 0.0], strict=True)))
        downs = list(accumulate(a + b for a, b in zip(self.gaps, [*high, 0.0], strict=True)))
        self.x = [end - size for end, size in zip(ends, [*self.wide, 0.0], strict=True)]
        self.y = [down - size for down, size in zip(downs, [*high, 0.0], strict=True)]
        self.high = high
        self.made.width, self.made.height = ends[-1], downs[-1]

    def _channel(self, row: int) -> float:
        sides = PAD + (2 * PAD if row in self.lefts else 0) + (2 * PAD if row in self.rights else 0)
        return sides + STEP * (self.routes.channel_tracks.get(row, 0) + 1)

    def _gap(self, column: int) -> float:
        """The room above a slot: for tracks, and for the frames and titles that begin or end there."""
        return self._closing(column) + STEP * (self.routes.gap_tracks.get(column, 0) + 1) + self._opening(column)

    def _closing(self, column: int) -> float:
        if any(area.right + 1 == column for area in self.hosts):
            return 2 * PAD
        return PAD if any(area.right + 1 == column for _, area in self.groups) else 0.0

    def _opening(self, column: int) -> float:
        group = GROUP_TITLE if any(area.left == column for _, area in self.groups) else 0.0
        return group + (HOST_TITLE if any(area.left == column for area in self.hosts) else 0.0)

    def _room_above(self, area: Area) -> float:
        """The room between the frame of a host and its first nodes, for the title of a group."""
        inside = [group for host, group in self.groups if host == area.name]
        return GROUP_TITLE if any(group.left == area.left for group in inside) else 0.0

    def _box(self, area: Area, title: str, above: float, pad: float) -> Rectangle:
        left, right = self.x[area.top] - pad, self.x[area.bottom] + self.wide[area.bottom] + pad
        top, bottom = self.y[area.left] - above, self.y[area.right] + self.high[area.right] + pad
        room = self.wide[area.top] + pad - PAD  # lines cross the frame behind the first layer
        return Rectangle(left, top, right - left, bottom - top, [shortened(title, SMALL_ON_SCREEN, room)])

    def _route(self) -> None:
        """The corners of the lines, in the order of the picture's."""
        exits = self._exits()
        paths: dict[tuple[str, str, str, str], list[EdgePath]] = {}
        for net in self.routes.nets:
            row = self.grid.cells[net.target][0]
            port = (self.made.nodes[net.target].x, self._port(net))
            for branch in net.branches:
                start = exits[branch]
                points = [start, (self._track_x(self.grid.cells[branch.source][0] + 1, net), start[1])]
                if branch.gap is not None:
                    y = self._track_y(branch.gap, net)
                    points += [(points[-1][0], y), (self._track_x(row, net), y)]
                points += [(points[-1][0], port[1]), port]
                paths.setdefault((branch.source, net.target, net.label, net.kind), []).append(
                    EdgePath(net, branch, _without_repeats(points))
                )
        self.made.lines = [paths[_key(line)].pop(0).points for line in self.picture.lines]

    def _port(self, net: Net) -> float:
        return self.made.nodes[net.target].y + LINE_HEIGHT * self.ends[net] + STEP * 1.5

    def _exits(self) -> dict[NetBranch, Point]:
        """The point at which each branch begins, on the right side of its source. A branch that goes straight begins
        beside its port."""
        leaving = grouped((branch.source, (net, branch)) for net in self.routes.nets for branch in net.branches)
        points: dict[NetBranch, Point] = {}
        for name, branches in leaving.items():
            block = self.made.nodes[name]
            branches.sort(key=lambda one: self._port(one[0]))
            y = block.y + even((block.height - STEP * (len(branches) - 1)) / 2)
            for at, (_, branch) in enumerate(branches):
                points[branch] = (block.x + block.width, y + STEP * at)
        return points

    def _track_x(self, row: int, net: Net) -> float:
        left = self.x[row] - self.channels[row]
        return left + (2 * PAD if row in self.rights else 0) + STEP * (self.routes.channels[row, net] + 1)

    def _track_y(self, column: int, net: Net) -> float:
        top = self.y[column] - self.gaps[column]
        return top + self._closing(column) + STEP * (self.routes.gaps[column, net] + 1)


def _texts(node: PictureNode) -> list[str]:
    """The lines of text of a node; the frame of its first group names that."""
    return texts_of(node, node.groups[1:])


def _key(line: PictureLine) -> tuple[str, str, str, str]:
    return line.source, line.target, line.label.rpartition(": ")[2], line.kind


def _without_repeats(points: list[Point]) -> list[Point]:
    return [point for at, point in enumerate(points) if not at or point != points[at - 1]]
