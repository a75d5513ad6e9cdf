"""Arranges nodes for a screen: in a grid, read from left to right, with hosts and their groups one below the other.

What needs others is on their left. Each node has a cell in the strip of its host and group. Nodes that have a cell keep
it: what is added is put beside them, so that a picture changes only where the network does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.emit.graphs.grid import Area, NodeGrid, layers
from robocomp_yaml.emit.graphs.picture import Cell, Picture

Strip = tuple[str, str]
"""A host and a group of it; '' for what is in none."""

_SWEEPS = 4
_SHAPE = 1.4  # slots of a picture, by its nodes: a screen is wide, as nodes and the lines between them are


class Arranged(msgspec.Struct):
    """`grid` has a row for each layer and a column for each slot of all strips. `groups` are the areas of groups in
    those of hosts. `cells` are to be passed to the next `arrange`."""

    grid: NodeGrid
    groups: list[Area]
    cells: dict[str, Cell]


def arrange(picture: Picture, kept: Mapping[str, Cell] = {}) -> Arranged:
    """The arrangement of a picture, in which nodes keep these cells, if no two in a strip have the same."""
    members = _members(picture)
    needs = _needs(picture)
    cells: dict[str, Cell] = {}
    for strip in members.values():
        taken: set[Cell] = set()
        for name in strip:
            if name in kept and kept[name] not in taken:
                cells[name] = kept[name]
                taken.add(kept[name])
    if not cells:
        cells = _fresh(picture, members, needs)
    for strip in members.values():
        _add(strip, cells, needs)
    return _placed(picture, members, cells)


def _members(picture: Picture) -> dict[Strip, list[str]]:
    """The nodes of each strip, those of a host together, and its groups before what is in none."""
    found: dict[Strip, list[str]] = {}
    for box in [*(box.name for box in picture.boxes), ""]:
        inside: dict[str, list[str]] = {}
        for node in picture.inside(box):
            inside.setdefault(node.groups[0] if node.groups else "", []).append(node.name)
        for group in sorted(inside, key=lambda group: not group):
            found[box, group] = inside[group]
    return found


def _needs(picture: Picture) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for line in picture.lines:
        if line.source != line.target and line.target not in found.setdefault(line.source, []):
            found[line.source].append(line.target)
    return found


def _fresh(
    picture: Picture, members: Mapping[Strip, Sequence[str]], needs: Mapping[str, Sequence[str]]
) -> dict[str, Cell]:
    """The cells of a picture that nobody has seen yet. Each host begins on the left, whatever others need of it."""
    count = len(picture.nodes)
    room = math.ceil(math.sqrt(_SHAPE * count))
    slots = {strip: max(1, round(len(names) * room / max(count, 1))) for strip, names in members.items()}
    made: dict[str, tuple[int, int]] = {}
    for host in dict.fromkeys(host for host, _ in members):
        strips = {strip: names for strip, names in members.items() if strip[0] == host}
        row = 0
        for layer in _layers_of(strips, needs):
            for strip, names in layer.items():
                for at, name in enumerate(names):
                    down, right = divmod(at, slots[strip])
                    made[name] = (row + down, right)
            row += max(math.ceil(len(names) / slots[strip]) for strip, names in layer.items())
    return _ordered(picture, members, made)


def _layers_of(
    strips: Mapping[Strip, Sequence[str]], needs: Mapping[str, Sequence[str]]
) -> list[dict[Strip, list[str]]]:
    """The layers of a host, with the nodes of each strip. What has no line in the host is where there is room."""
    own = {name for names in strips.values() for name in names}
    inside = {name: [other for other in needs.get(name, ()) if other in own] for name in own}
    linked = {name for name, others in inside.items() if others} | {one for others in inside.values() for one in others}
    level = layers([name for names in strips.values() for name in names if name in linked], inside)
    made: list[dict[Strip, list[str]]] = [{} for _ in range(max(level.values(), default=0) + 1)]
    for strip, names in strips.items():
        for name in names:
            if name in linked:
                made[level[name]].setdefault(strip, []).append(name)
        for name in names:
            if name not in linked:
                own_layers = [layer for layer in made if strip in layer] or made
                emptiest = min(own_layers, key=lambda layer: len(layer.get(strip, ())))
                emptiest.setdefault(strip, []).append(name)
    return made


def _ordered(
    picture: Picture, members: Mapping[Strip, Sequence[str]], cells: dict[str, tuple[int, int]]
) -> dict[str, Cell]:
    """The cells, with nodes moved within their layers close to what they are connected to."""
    first, starts = 0, {}
    strip_of = {name: strip for strip, names in members.items() for name in names}
    for strip, names in members.items():
        starts[strip] = first
        first += max((cells[name][1] for name in names), default=0) + 1
    at = {name: starts[strip_of[name]] + slot for name, (_, slot) in cells.items()}
    near: dict[str, list[str]] = {}
    for line in picture.lines:
        near.setdefault(line.source, []).append(line.target)
        near.setdefault(line.target, []).append(line.source)
    rows: dict[tuple[int, int], list[str]] = {}
    for name, (row, _) in cells.items():
        rows.setdefault((row, starts[strip_of[name]]), []).append(name)
    ordered = [rows[key] for key in sorted(rows)]
    for sweep in range(_SWEEPS):
        for names in ordered if sweep % 2 == 0 else reversed(ordered):
            places = sorted(at[name] for name in names)
            middle = {name: _mean([at[other] for other in near.get(name, ())], at[name]) for name in names}
            at.update(zip(sorted(names, key=lambda name: (middle[name], name)), places, strict=True))
    return {name: Cell(row, at[name] - starts[strip_of[name]]) for name, (row, _) in cells.items()}


def _mean(values: Sequence[int], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise


def _add(names: Iterable[str], cells: dict[str, Cell], needs: Mapping[str, Sequence[str]]) -> None:
    """Adds cells for the nodes of a strip that have none: beside what they need, or what needs them."""
    names = list(names)
    taken = {cells[name] for name in names if name in cells}
    users: dict[str, list[str]] = {}
    for name, others in needs.items():
        for other in others:
            users.setdefault(other, []).append(name)
    most = max((cell.slot for cell in taken), default=0)
    for name in names:
        if name in cells:
            continue
        behind = [cells[one].layer + 1 for one in users.get(name, ()) if one in cells]
        before = [cells[one].layer - 1 for one in needs.get(name, ()) if one in cells]
        layer = max(behind) if behind else max(min(before), 0) if before else 0
        slot = next(slot for slot in range(len(taken) + most + 2) if Cell(layer, slot) not in taken)
        cells[name] = Cell(layer, slot)
        taken.add(cells[name])


def _placed(picture: Picture, members: Mapping[Strip, Sequence[str]], cells: dict[str, Cell]) -> Arranged:
    """The grid of these cells, without empty layers, and the areas of hosts and groups."""
    rows = {layer: row for row, layer in enumerate(sorted({cell.layer for cell in cells.values()}))}
    grid, groups = NodeGrid(rows=len(rows)), list[Area]()
    hosts: dict[str, list[tuple[int, int]]] = {}
    for (host, group), names in members.items():
        slots = {slot: at for at, slot in enumerate(sorted({cells[name].slot for name in names}))}
        own = [(rows[cells[name].layer], grid.columns + slots[cells[name].slot]) for name in names]
        grid.cells.update(zip(names, own, strict=True))
        grid.columns += len(slots)
        hosts.setdefault(host, []).extend(own)
        if group:
            groups.append(_around(group, own))
    grid.areas = [_around(host, own) for host, own in hosts.items()]
    return Arranged(grid, groups, cells)


def _around(name: str, cells: Sequence[tuple[int, int]]) -> Area:
    rows, columns = [row for row, _ in cells], [column for _, column in cells]
    return Area(name, min(rows), max(rows), min(columns), max(columns))
