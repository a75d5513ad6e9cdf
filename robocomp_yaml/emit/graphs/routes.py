"""Routes lines between the cells of a grid: in the channels between rows and the gaps between columns, so that no line
crosses a node. In a channel or gap each line has its own track.

All lines to the same interface of a node are one net, with one arrow. A net leaves each source downwards, runs in the
channel below to a gap, in the gap to the channel above its target, and in this channel to the target.
"""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from robocomp_yaml.emit.graphs.grid import NodeGrid
from robocomp_yaml.emit.graphs.picture import Picture, PictureFault
from robocomp_yaml.grouping import grouped


class NetBranch(msgspec.Struct, eq=False):
    """The part of a net from one source. `gap` is the column behind the gap that the branch uses, None for no gap."""

    source: str
    faults: tuple[PictureFault, ...] = ()
    gap: int | None = None


class Net(msgspec.Struct, eq=False):
    target: str
    label: str
    kind: str
    branches: list[NetBranch] = []


Run = tuple[int, Net]
"""A net in a channel (the number of the row below it), or in a gap (the number of the column behind it)."""


class Routes(msgspec.Struct):
    """`channels` and `gaps` map runs to their tracks, counted from 0; `channel_tracks` and `gap_tracks` are the numbers
    of tracks in each channel and gap."""

    nets: list[Net] = []
    channels: dict[Run, int] = {}
    gaps: dict[Run, int] = {}
    channel_tracks: dict[int, int] = {}
    gap_tracks: dict[int, int] = {}


def routes_of(picture: Picture, grid: NodeGrid) -> Routes:
    """The nets of a picture, with their tracks."""
    made = Routes()
    nets: dict[tuple[str, str, str], Net] = {}
    for line in picture.lines:
        label = line.label.rpartition(": ")[2]  # without the name of the port, which only its component uses
        key = (line.target, label, line.kind)
        net = nets.setdefault(key, Net(line.target, label, line.kind))
        net.branches.append(NetBranch(line.source, line.faults))
    made.nets = list(nets.values())
    across: dict[int, dict[Net, list[float]]] = {}
    along: dict[int, dict[Net, list[float]]] = {}
    for net in made.nets:
        row, column = grid.cells[net.target]
        for branch in net.branches:
            start, source_column = grid.cells[branch.source]
            if start + 1 == row:
                _reach(across, row, net, source_column, column)
                continue
            branch.gap = _gap(grid, source_column, column)
            _reach(across, start + 1, net, source_column, branch.gap - 0.5)
            _reach(along, branch.gap, net, start + 1, row)
            _reach(across, row, net, branch.gap - 0.5, column)
    made.channels, made.channel_tracks = _tracks(across)
    made.gaps, made.gap_tracks = _tracks(along)
    return made


def _gap(grid: NodeGrid, source: int, target: int) -> int:
    """The gap beside the target, on the side of the source."""
    if source == target:
        return target if target >= grid.columns / 2 else target + 1
    return target + 1 if source > target else target


def _reach(runs: dict[int, dict[Net, list[float]]], at: int, net: Net, *points: float) -> None:
    runs.setdefault(at, {}).setdefault(net, []).extend(points)


def _tracks(runs: dict[int, dict[Net, list[float]]]) -> tuple[dict[Run, int], dict[int, int]]:
    """A track for each run, so that runs on one track never touch, and the number of tracks."""
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
    return grouped((branch.source, net) for net in nets for branch in net.branches)
