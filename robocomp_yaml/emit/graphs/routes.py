"""How lines run between the cells of a grid: in the channels between rows and the gaps between columns, so that they
never cross a node; each on a track of its own there.

All lines that want the same thing of a node are one net, with one arrow. A net leaves each source downwards, runs in
the channel below it to a gap, in the gap to the channel above its target, and in that to the target.
"""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from robocomp_yaml.emit.graphs.grid import NodeGrid
from robocomp_yaml.emit.graphs.picture import Picture, PictureFault


class NetBranch(msgspec.Struct, eq=False):
    """A net's way from one source. `gap` is the gap before that column, None where no gap is needed."""

    source: str
    faults: tuple[PictureFault, ...] = ()
    gap: int | None = None


class Net(msgspec.Struct, eq=False):
    target: str
    label: str
    kind: str
    branches: list[NetBranch] = []


Run = tuple[int, Net]
"""A net in a channel (by the row below it), or in a gap (by the column behind it)."""


class Routes(msgspec.Struct):
    """`channels` and `gaps` are the tracks of each run, counted from 0; `channel_tracks` and `gap_tracks` how many
    there are in each."""

    nets: list[Net] = []
    channels: dict[Run, int] = {}
    gaps: dict[Run, int] = {}
    channel_tracks: dict[int, int] = {}
    gap_tracks: dict[int, int] = {}


def routes_of(picture: Picture, grid: NodeGrid) -> Routes:
    made = Routes()
    nets: dict[tuple[str, str, str], Net] = {}
    for line in picture.lines:
        label = line.label.rpartition(": ")[2]  # a proxy's own name is its owner's business
        key = (line.target, label, line.kind)
        net = nets.setdefault(key, Net(line.target, label, line.kind))
        net.branches.append(NetBranch(line.source, line.faults))
    made.nets = list(nets.values())
    across: dict[int, dict[Net, list[float]]] = {}
    along: dict[int, dict[Net, list[float]]] = {}
    for net in made.nets:
        row, column = grid.cells[net.target]
        for branch in net.branches:
            start, place = grid.cells[branch.source]
            if start + 1 == row:
                _reach(across, row, net, place, column)
                continue
            branch.gap = _gap(grid, place, column)
            _reach(across, start + 1, net, place, branch.gap - 0.5)
            _reach(along, branch.gap, net, start + 1, row)
            _reach(across, row, net, branch.gap - 0.5, column)
    made.channels, made.channel_tracks = _tracks(across)
    made.gaps, made.gap_tracks = _tracks(along)
    return made


def _gap(grid: NodeGrid, source: int, target: int) -> int:
    """The gap beside the target, on the side that the line comes from."""
    if source == target:
        return target if target >= grid.columns / 2 else target + 1
    return target + 1 if source > target else target


def _reach(runs: dict[int, dict[Net, list[float]]], at: int, net: Net, *points: float) -> None:
    runs.setdefault(at, {}).setdefault(net, []).extend(points)


def _tracks(runs: dict[int, dict[Net, list[float]]]) -> tuple[dict[Run, int], dict[int, int]]:
    """A track for each run, such that no two on one track touch."""
    tracks: dict[Run, int] = {}
    counts: dict[int, int] = {}
    for at, by_net in runs.items():
        ends: list[float] = []
        for net, points in sorted(by_net.items(), key=lambda item: (min(item[1]), -max(item[1]))):
            first, last = min(points) - 0.5, max(points) + 0.5
            free = next((number for number, end in enumerate(ends) if end < first), len(ends))
            ends[free : free + 1] = [last]
            tracks[at, net] = free
        counts[at] = len(ends)
    return tracks, counts


def outgoing(nets: Iterable[Net]) -> dict[str, list[Net]]:
    """The nets that leave each node."""
    found: dict[str, list[Net]] = {}
    for net in nets:
        for branch in net.branches:
            found.setdefault(branch.source, []).append(net)
    return found
