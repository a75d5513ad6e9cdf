"""Packs rectangles of cells closely, in the order of what needs what: from left to right, as long as there is room.

What needs others is on their left and at their height, if possible. A chain that is too long for the width begins again
on the left. The cells that remain are few, wherever the rectangles are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.emit.graphs.grid import layers

WIDER = 1.2
"""How much wider a cell of a picture is than it is high, as a part of how much wider a screen is than it is high: by
default. Names that are long, and few lines between slots, make it more."""
SHAPES = (0.7, 0.85, 1.0, 1.2, 1.5)
"""Widths that are tried, as parts of the sides of a square."""
_LINE = 0.25  # how much of the size a line of mean cost 1 is worth
_WASTE = 0.4  # and cells of which all are empty
_GROWS, _BACK, _AHEAD, _ASIDE, _DOWN, _LEFT = 3.0, 2.0, 0.3, 0.3, 0.02, 0.1
_PAIRS = 6_000  # of cells that are compared at most, to shorten lines
_SWEEPS = 3

Spot = tuple[int, int]
"""A layer, from the left, and a slot, from the top."""


class Item(msgspec.Struct, frozen=True):
    """A rectangle of cells."""

    name: str
    wide: int = 1
    high: int = 1


class Packed(msgspec.Struct):
    """The upper left cell of each item, and the size of all."""

    spots: dict[str, Spot]
    wide: int = 0
    high: int = 0


def packed(
    items: Sequence[Item], needs: Mapping[str, Sequence[str]], least: float, shapes: Sequence[float] = SHAPES,
    effort: float = 1.0, wider: float = WIDER,
) -> Packed:  # fmt: skip
    """The items, packed as a screen is wide. A picture of `least` rows or less is not made smaller at the cost of
    longer lines. `effort` is the part of the time that these items may need. `wider`: see WIDER."""
    if not items:
        return Packed({})
    side = math.sqrt(sum(one.wide * one.high for one in items) / wider)
    widest = max(one.wide for one in items)
    widths = {max(widest, math.ceil(side * one)) for one in shapes}
    if len(shapes) > 1:
        widths.add(max(widest, math.ceil(least / wider)))
    found = [_Packer(items, needs, one).pack() for one in sorted(widths)]
    return min(found, key=lambda one: one.score(least, wider)).shortened(effort)


def score(spots: Mapping[str, Spot], needs: Mapping[str, Sequence[str]], least: float, wider: float) -> float:
    """How bad a picture of single cells is, to be compared with others of the same ones."""
    made = Packed(dict(spots), max(x for x, _ in spots.values()) + 1, max(y for _, y in spots.values()) + 1)
    lines = [_cost_of(spots[name], spots[one], 1, 0) for name, others in needs.items() for one in others]
    return _badness(made, len(spots), lines, least, wider)


def _badness(made: Packed, cells: int, lines: Sequence[float], least: float, wider: float) -> float:
    size = max(made.wide * wider, made.high, least)
    waste = 1 - cells / (made.wide * made.high)
    return size * (1 + _WASTE * waste) * (1 + _LINE * sum(lines) / max(len(lines), 1))


def _cost_of(source: Spot, target: Spot, wide: int, down: float) -> float:
    """The cost of a line from a rectangle that is so `wide`, to another one, whose middle is `down` cells lower than
    the difference of their first slots."""
    ahead = target[0] - source[0] - wide
    return abs(target[1] - source[1] + down) + (0.7 * ahead if ahead >= 0 else _BACK - 0.2 * ahead)


class _Packer:
    def __init__(self, items: Sequence[Item], needs: Mapping[str, Sequence[str]], width: int) -> None:
        self.items, self.width = {one.name: one for one in items}, width
        self.needs = {name: [one for one in needs.get(name, ()) if one in self.items] for name in self.items}
        self.users: dict[str, list[str]] = {name: [] for name in self.items}
        for name, others in self.needs.items():
            for other in others:
                self.users[other].append(name)
        self.ideal = math.ceil(sum(one.wide * one.high for one in items) / width)
        self.made, self.taken = Packed({}), set[Spot]()
        self.full = [0] * width  # the slots of each layer that are all taken, from the top

    def pack(self) -> _Packer:
        level = layers([name for name in self.items if self.needs[name] or self.users[name]], self.needs)
        order = {name: at for at, name in enumerate(self.items)}
        last = len(self.items)  # what has no lines is put where there is room
        for item in sorted(
            self.items.values(), key=lambda one: (level.get(one.name, last), -one.wide * one.high, order[one.name])
        ):
            middle = self._middle(item)
            spots = self._spots(item, middle)
            self._put(item, min((self._cost(item, spot, middle), spot[1], spot[0]) for spot in spots))
        self._measure()
        return self

    def _measure(self) -> None:
        spots, items = self.made.spots, self.items
        self.made.wide = max(spots[name][0] + one.wide for name, one in items.items())
        self.made.high = max(spots[name][1] + one.high for name, one in items.items())

    def score(self, least: float, wider: float) -> float:
        """How bad it is: its size on a screen, its empty cells, and how long its lines are."""
        lines = [self._line(name, other) for name, others in self.needs.items() for other in others]
        return _badness(self.made, sum(one.wide * one.high for one in self.items.values()), lines, least, wider)

    def _put(self, item: Item, found: tuple[float, int, int]) -> None:
        _, slot, layer = found
        self.made.spots[item.name] = layer, slot
        self.taken.update(_cells(item, (layer, slot)))
        self.made.high = max(self.made.high, slot + item.high)
        for each in range(layer, layer + item.wide):
            while (each, self.full[each]) in self.taken:
                self.full[each] += 1

    def _spots(self, item: Item, middle: float | None) -> Iterator[Spot]:
        """Free spots: in each layer the highest ones, and those close to what the item is connected to."""
        for layer in range(self.width - item.wide + 1):
            found, first = 0, max(self.full[layer : layer + item.wide])
            near = range(max(first, math.floor(middle) - 3), self.made.high) if middle is not None else ()
            for slot in near:
                if self._is_free(item, (layer, slot)):
                    found += 1
                    yield layer, slot
                if found > 5:
                    break
            slot = first
            while not self._is_free(item, (layer, slot)):
                slot += 1
            yield layer, slot

    def _is_free(self, item: Item, spot: Spot) -> bool:
        return spot not in self.taken and (item.wide == item.high == 1 or self.taken.isdisjoint(_cells(item, spot)))

    def _middle(self, item: Item) -> float | None:
        """The slot at which an item would be beside what is there of its neighbours."""
        spots = self.made.spots
        near = [spots[one][1] + (self.items[one].high - item.high) / 2
                for one in (*self.users[item.name], *self.needs[item.name]) if one in spots]  # fmt: skip
        return sum(near) / len(near) if near else None

    def _cost(self, item: Item, spot: Spot, middle: float | None) -> float:
        layer, slot = spot
        spots = self.made.spots
        cost = _GROWS * max(0, slot + item.high - max(self.made.high, self.ideal)) + _DOWN * slot
        cost += _ASIDE * abs(slot - middle) if middle is not None else 0.0
        users = [spots[one][0] + self.items[one].wide for one in self.users[item.name] if one in spots]
        first = max(users, default=0)
        cost += _AHEAD * (layer - first) if layer >= first else _BACK + _LEFT * layer
        ahead = [spots[one][0] for one in self.needs[item.name] if one in spots]  # of a cycle
        return cost + (_BACK if ahead and layer + item.wide > min(ahead) else 0.0)

    def _line(self, source: str, target: str) -> float:
        one, other = self.items[source], self.items[target]
        return _cost_of(self.made.spots[source], self.made.spots[target], one.wide, (other.high - one.high) / 2)

    def shortened(self, effort: float) -> Packed:
        """What is packed, with shorter lines."""
        self._shorten(round(_PAIRS * effort))
        self._measure()
        return self.made

    def _shorten(self, pairs: int) -> None:
        """Exchanges items of one size, and moves those of one cell to free ones, where that shortens lines."""
        names = [name for name in self.items if self.needs[name] or self.users[name]]
        single = [name for name in self.items if self.items[name].wide == self.items[name].high == 1]
        free = [
            (layer, slot) for layer in range(self.width) for slot in range(max(self.made.high, 1))
            if (layer, slot) not in self.taken
        ]  # fmt: skip
        holes = free[: max(0, pairs // (len(single) * _SWEEPS or 1) - len(names))] if single else []
        reach = pairs // (len(names) * _SWEEPS or 1)
        for _ in range(_SWEEPS):
            is_better = False
            for at, one in enumerate(names):
                for other in names[at + 1 : at + 1 + reach]:
                    is_better |= self._exchange(one, other)
                if self.items[one].wide == self.items[one].high == 1:
                    for number, hole in enumerate(holes):
                        if (left := self._move(one, hole)) is not None:
                            holes[number], is_better = left, True
            if not is_better:
                return

    def _around(self, names: Iterable[str]) -> float:
        cost = 0.0
        for name in names:
            for other in self.needs[name]:
                cost += self._line(name, other)
            for other in self.users[name]:
                cost += self._line(other, name)
        return cost

    def _exchange(self, one: str, other: str) -> bool:
        a, b, spots = self.items[one], self.items[other], self.made.spots
        if (a.wide, a.high) != (b.wide, b.high):
            return False
        before = self._around((one, other))
        spots[one], spots[other] = spots[other], spots[one]
        if self._around((one, other)) < before - 1e-9:
            return True
        spots[one], spots[other] = spots[other], spots[one]
        return False

    def _move(self, one: str, hole: Spot) -> Spot | None:
        """Moves an item of one cell to a free one, if that is better: the cell that it left."""
        spots, was = self.made.spots, self.made.spots[one]
        before = self._around((one,))
        spots[one] = hole
        if self._around((one,)) < before - 1e-9:
            return was
        spots[one] = was
        return None


def _cells(item: Item, spot: Spot) -> Iterator[Spot]:
    layer, slot = spot
    return ((layer + right, slot + down) for right in range(item.wide) for down in range(item.high))
