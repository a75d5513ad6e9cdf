"""Assigns each node to a cell of a grid. A host is a strip of columns; a layer is a row, or several.

Hosts are side by side as long as there is room, then in another band below. All strips of a band share their rows, so
that lines go down. A layer with more nodes than its strip has columns needs several rows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.digraph import postorder
from robocomp_yaml.emit.graphs.picture import Picture
from robocomp_yaml.grouping import grouped

MOST_COLUMNS = 12
_SWEEPS = 4


class Area(msgspec.Struct, frozen=True):
    """The cells of a host, by their first and last row and column; `name` is '' for the nodes outside."""

    name: str
    top: int
    bottom: int
    left: int
    right: int


class NodeGrid(msgspec.Struct):
    """`cells` maps the name of a node to (row, column)."""

    cells: dict[str, tuple[int, int]] = {}
    areas: list[Area] = []
    rows: int = 0
    columns: int = 0


def grid_of(picture: Picture) -> NodeGrid:
    """The cells of all nodes and hosts of a picture."""
    level = layers(picture.nodes, picture.needs())
    strips = [name for name in [*(box.name for box in picture.boxes), ""] if picture.inside(name)]
    columns = _columns(picture, strips)
    grid = NodeGrid()
    for band in _bands(strips, columns):
        _add_band(picture, band, columns, level, grid)
    _order(picture, grid)
    return grid


def _columns(picture: Picture, strips: Sequence[str]) -> dict[str, int]:
    """The number of columns of each strip, in proportion to its nodes."""
    count = len(picture.nodes)
    room = max(1, min(MOST_COLUMNS, math.ceil(math.sqrt(1.6 * count))))
    shares = {name: len(picture.inside(name)) * room / max(count, 1) for name in strips}
    return {name: max(1, min(round(share), MOST_COLUMNS)) for name, share in shares.items()}


def _bands(strips: Sequence[str], columns: Mapping[str, int]) -> list[list[str]]:
    bands: list[list[str]] = []
    room = 0
    for name in strips:
        if not bands or columns[name] > room:
            bands.append([])
            room = MOST_COLUMNS + 1  # the nodes outside may be beside the hosts
        bands[-1].append(name)
        room -= columns[name]
    return bands


def _add_band(
    picture: Picture, band: Sequence[str], columns: Mapping[str, int], level: Mapping[str, int], grid: NodeGrid
) -> None:
    top, left = grid.rows, 0
    lefts: dict[str, int] = {}
    by_layer: dict[int, dict[str, list[str]]] = {}
    for name in band:
        lefts[name], left = left, left + columns[name]
        for node in picture.inside(name):
            by_layer.setdefault(level[node.name], {}).setdefault(name, []).append(node.name)
    row = top
    for _, strips in sorted(by_layer.items()):
        for name, nodes in strips.items():
            for at, member in enumerate(nodes):
                down, right = divmod(at, columns[name])
                in_row = min(len(nodes) - down * columns[name], columns[name])
                grid.cells[member] = (row + down, lefts[name] + (columns[name] - in_row) // 2 + right)
        row += max(math.ceil(len(nodes) / columns[name]) for name, nodes in strips.items())
    grid.rows, grid.columns = row, max(grid.columns, left)
    grid.areas += [Area(name, top, row - 1, lefts[name], lefts[name] + columns[name] - 1) for name in band]


def _order(picture: Picture, grid: NodeGrid) -> None:
    """Moves nodes within their rows, so that they are close to the nodes that they are connected to."""
    ends = [(line.source, line.target) for line in picture.lines]
    near = grouped(pair for one, other in ends for pair in ((one, other), (other, one)))
    rows = grouped(((row, picture.nodes[name].box), name) for name, (row, _) in grid.cells.items())
    ordered = [rows[key] for key in sorted(rows)]
    for sweep in range(_SWEEPS):
        for members in ordered if sweep % 2 == 0 else reversed(ordered):
            columns = sorted(grid.cells[name][1] for name in members)
            middle = {name: _middle(grid, near.get(name, ()), grid.cells[name][1]) for name in members}
            row = grid.cells[members[0]][0]
            for name, column in zip(sorted(members, key=lambda name: (middle[name], name)), columns, strict=True):
                grid.cells[name] = (row, column)


def _middle(grid: NodeGrid, others: Sequence[str], own: int) -> float:
    return sum(grid.cells[name][1] for name in others) / len(others) if others else own


def layers(nodes: Iterable[str], needs: Mapping[str, Sequence[str]]) -> dict[str, int]:
    """The layer of each node, from 0 at the top. A line that closes a cycle is ignored. A node that needs nothing is
    just below the lowest node that needs it; a node without lines is at the bottom."""
    names = list(nodes)
    depth = _depths(names, needs)
    height = max(depth.values(), default=0)
    users = grouped((other, name) for name in names for other in needs.get(name, ()))
    layer = {name: height - depth[name] for name in names}
    for name in sorted(names, key=lambda name: layer[name]):
        below = [layer[user] for user in users.get(name, ()) if layer[user] < layer[name]]
        if below and not needs.get(name):
            layer[name] = max(below) + 1
    return layer


def _depths(names: Sequence[str], needs: Mapping[str, Sequence[str]]) -> dict[str, int]:
    """The length of the longest path from each node downwards, without recursion, because paths may be long."""
    depth: dict[str, int] = {}
    for name in postorder(names, lambda name: needs.get(name, ())):
        depth[name] = 1 + max((depth[other] for other in needs.get(name, ()) if other in depth), default=-1)
    return depth
