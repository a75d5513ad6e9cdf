"""The geometry of a picture, in pixels: nodes, hosts, and the paths of lines.

Nothing overlaps, by construction: rows, columns, channels and gaps are as large as their contents.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

import msgspec

from robocomp_yaml.emit.graphs.grid import Area, NodeGrid, grid_of
from robocomp_yaml.emit.graphs.measure import shortened, width
from robocomp_yaml.emit.graphs.picture import Picture, PictureNode
from robocomp_yaml.emit.graphs.routes import Net, NetBranch, Routes, outgoing, routes_of
from robocomp_yaml.grouping import grouped

TITLE, SMALL, LABEL = 13.0, 11.0, 10.0
"""Font sizes."""
WIDEST = 230.0
"""The largest width of a text in a node; longer texts are shortened."""
MOST_SERVED = 6
LINE_HEIGHT = 15.0
STEP = 8.0
"""The distance of two tracks."""

_PAD = 12.0
_LABEL_BAND, _HOST_TITLE, _HEAD = 18.0, 26.0, 44.0

Point = tuple[float, float]


class Rectangle(msgspec.Struct):
    """A rectangle with lines of text."""

    x: float
    y: float
    width: float
    height: float
    texts: list[str] = []

    @property
    def middle(self) -> float:
        """The x coordinate of the centre."""
        return self.x + self.width / 2


class EdgePath(msgspec.Struct):
    """The path of a branch of a net: its corners, from the source to the target."""

    net: Net
    branch: NetBranch
    points: list[Point]


class Geometry(msgspec.Struct):
    """`labels` are the points above the targets at which nets end."""

    width: float = 0.0
    height: float = 0.0
    nodes: dict[str, Rectangle] = {}
    hosts: dict[str, Rectangle] = {}
    paths: list[EdgePath] = []
    labels: list[tuple[Net, Point]] = []


def geometry_of(picture: Picture) -> Geometry:
    """The geometry of a picture."""
    grid = grid_of(picture)
    routes = routes_of(picture, grid)
    return _Placer(picture, grid, routes).place()


def texts_of(node: PictureNode, groups: Sequence[str] | None = None) -> list[str]:
    """The lines of text of a node: its title, what it is, its groups (or only these), and what it serves."""
    groups = node.groups if groups is None else groups
    served = node.served()
    if len(served) > MOST_SERVED:
        served = [*served[: MOST_SERVED - 1], f"and {len(served) - MOST_SERVED + 1} more"]
    more = [*node.about, *(f"in {group}" for group in groups), *([] if node.enabled else ["not started"]), *served]
    return [shortened(node.title, TITLE, WIDEST, bold=True), *(shortened(text, SMALL, WIDEST) for text in more)]


class _Placer:
    def __init__(self, picture: Picture, grid: NodeGrid, routes: Routes) -> None:
        self.picture, self.grid, self.routes = picture, grid, routes
        self.made = Geometry()
        self.incoming = grouped((net.target, net) for net in routes.nets)
        self.leaving = outgoing(routes.nets)
        self.edges = {area.left for area in grid.areas} | {area.right + 1 for area in grid.areas}
        self.tops = {area.top for area in grid.areas}
        self.columns: list[float] = []
        self.rows: list[float] = []

    def place(self) -> Geometry:
        for name, node in self.picture.nodes.items():
            self.made.nodes[name] = self.block(node)
        self.measure()
        for name, block in self.made.nodes.items():
            row, column = self.grid.cells[name]
            block.x = even(self.columns[column] + (self.column_width[column] - block.width) / 2)
            block.y = self.rows[row]
        for area in self.grid.areas:
            if area.name:
                self.made.hosts[area.name] = self.host(area)
        self.lines()
        return self.made

    def block(self, node: PictureNode) -> Rectangle:
        texts = texts_of(node)
        widest = max([width(texts[0], TITLE, bold=True), *(width(text, SMALL) for text in texts[1:])])
        coming = self.incoming.get(node.name, [])
        ports = sum(map(_slot, coming)) * (2 if len(coming) == 1 else 1)  # a single net ends in the middle
        exits = STEP * (len(self.leaving.get(node.name, ())) + 1)
        size = max(widest + 2 * _PAD, ports + _PAD, exits, 90.0)
        return Rectangle(0, 0, even(size + STEP), LINE_HEIGHT * len(texts) + 14, texts)

    def measure(self) -> None:
        """Computes where rows and columns begin, behind channels and gaps that have room for their tracks."""
        grid, cells = self.grid, self.grid.cells
        self.column_width = [0.0] * grid.columns
        row_height = [0.0] * grid.rows
        for name, block in self.made.nodes.items():
            row, column = cells[name]
            self.column_width[column] = max(self.column_width[column], block.width)
            row_height[row] = max(row_height[row], block.height)
        self.gaps = [self.gap(column) for column in range(grid.columns + 1)]
        self.channels = [self.channel(row) for row in range(grid.rows + 1)]
        wide = [a + b for a, b in zip(self.gaps, [*self.column_width, 0.0], strict=True)]
        high = [a + b for a, b in zip(self.channels, [*row_height, 0.0], strict=True)]
        ends, downs = list(accumulate(wide)), list(accumulate(high, initial=_HEAD))[1:]
        self.columns = [end - size for end, size in zip(ends, [*self.column_width, 0.0], strict=True)]
        self.rows = [down - size for down, size in zip(downs, [*row_height, 0.0], strict=True)]
        self.made.width, self.made.height = ends[-1], downs[-1]

    def gap(self, column: int) -> float:
        sides = 2 * _PAD * (2 if column in self.edges else 1)
        return sides + STEP * self.routes.gap_tracks.get(column, 0)

    def channel(self, row: int) -> float:
        tracks = STEP * (self.routes.channel_tracks.get(row, 0) + 1)
        if row == self.grid.rows:
            return tracks + 2 * _PAD
        above = _PAD if row in self.tops and row else 0.0
        return above + tracks + (_HOST_TITLE + _PAD if row in self.tops else 0.0) + _LABEL_BAND

    def host(self, area: Area) -> Rectangle:
        left = self.columns[area.left] - _PAD
        right = self.columns[area.right] + self.column_width[area.right] + _PAD
        top = self.rows[area.top] - _LABEL_BAND - _HOST_TITLE
        bottom = self.rows[area.bottom + 1] - self.channels[area.bottom + 1] + _PAD
        title = next(box.title for box in self.picture.boxes if box.name == area.name)
        return Rectangle(left, top, right - left, bottom - top, [shortened(title, SMALL, right - left - 2 * _PAD)])

    def lines(self) -> None:
        ports = self.ports()
        exits = self.exits(ports)
        for net in self.routes.nets:
            port = ports[net]
            self.made.labels.append((net, port))
            row = self.grid.cells[net.target][0]
            for branch in net.branches:
                start = exits[branch]
                below = self.grid.cells[branch.source][0] + 1
                points = [start, (start[0], self.track_y(below, net))]
                if branch.gap is not None:
                    x = self.track_x(branch.gap, net)
                    points += [(x, points[-1][1]), (x, self.track_y(row, net))]
                points += [(port[0], points[-1][1]), port]
                self.made.paths.append(EdgePath(net, branch, points))

    def ports(self) -> dict[Net, Point]:
        """The point at which each net ends: side by side on the upper edge of its target, in the order of sources."""
        points: dict[Net, Point] = {}
        for name, nets in self.incoming.items():
            block = self.made.nodes[name]
            x = block.x + (block.width - sum(map(_slot, nets))) / 2 if len(nets) > 1 else block.middle - STEP
            for net in sorted(nets, key=self.origin):
                points[net] = (even(x + STEP), block.y)
                x += _slot(net)
        return points

    def origin(self, net: Net) -> float:
        columns = [self.grid.cells[branch.source][1] for branch in net.branches]
        return sum(columns) / len(columns)

    def exits(self, ports: dict[Net, Point]) -> dict[NetBranch, Point]:
        """The point at which each branch begins: side by side on the lower edge of the source, half a step beside the
        ports. A branch that goes straight down begins above its port."""
        points: dict[NetBranch, Point] = {}
        for name, nets in self.leaving.items():
            block = self.made.nodes[name]
            x = even(block.middle - STEP * (len(nets) - 1) / 2) + STEP / 2
            for net in sorted(nets, key=lambda net: ports[net][0]):
                branch = next(branch for branch in net.branches if branch.source == name and branch not in points)
                port = ports[net][0]
                is_below = branch.gap is None and block.x + STEP < port < block.x + block.width - STEP
                points[branch] = (port if is_below else x, block.y + block.height)
                x += STEP
        return points

    def track_y(self, row: int, net: Net) -> float:
        top = self.rows[row] - self.channels[row]
        above = _PAD if (row in self.tops and row) or row == self.grid.rows else 0.0
        return top + above + STEP * (self.routes.channels[row, net] + 1)

    def track_x(self, column: int, net: Net) -> float:
        left = self.columns[column] - self.gaps[column]
        side = _PAD * (2 if column in self.edges else 1)
        return left + side + STEP * (self.routes.gaps[column, net] + 0.5)


def _slot(net: Net) -> float:
    """The width of a net on the edge of its target, with its label."""
    return STEP * 2 + (width(net.label, LABEL) if net.label else 0.0)


def even(x: float) -> float:
    """The multiple of STEP closest to x."""
    return STEP * round(x / STEP)
