"""Nodes of a picture that a person moved: the geometry with them where they were put.

Everything else stays where it is, but for nodes on which one was put: those go below it. Frames grow with their
members. The lines of what moved, and lines that it blocks, get new ways around all nodes and titles.
"""

from __future__ import annotations

import heapq
from bisect import bisect_left
from collections.abc import Iterable
from itertools import pairwise

from robocomp_yaml.emit.graphs.geometry import STEP, Point, Rectangle
from robocomp_yaml.emit.graphs.measure import width
from robocomp_yaml.emit.graphs.picture import Picture, PictureLine
from robocomp_yaml.emit.graphs.screen import GROUP_TITLE, HOST_TITLE, PAD, SMALL_ON_SCREEN, ScreenGeometry

_APART = 3 * STEP  # between a moved node and one that makes room
_BESIDE = 1.5 * STEP  # the first track beside a node: frames are at once and twice the padding
_CLEAR = 2.0  # what lines keep from nodes at least
_BEND = 5 * STEP  # a bend is as bad as so many more pixels
_SHARED = 12 * STEP  # and so is running along another line
_MOST_STEPS = 3_000  # of the search for one line

_TRACKS = 5  # beside the ends of a line, on which a simple way may go up or down
_ROOMS = (6 * STEP, 40 * STEP)
"""How far around a line its way may lead: the second is for lines that find none in the first."""

Segment = tuple[Point, Point]


def moved(picture: Picture, made: ScreenGeometry) -> None:
    """Changes the geometry of a picture: its nodes go to the picture's positions."""
    old = {name: (box.x, box.y) for name, box in made.nodes.items()}
    pinned = [name for name in made.nodes if name in picture.positions]
    for name in pinned:
        x, y = picture.positions[name]
        node, box = picture.nodes[name], made.nodes[name]
        frames = (HOST_TITLE if node.box else 0) + (GROUP_TITLE if node.groups else 0)  # they need room, too
        box.x, box.y = max(x, 3 * PAD if node.box else PAD), max(y, PAD + frames)
    _make_room(made, pinned)
    _part_hosts(picture, made, set(pinned))
    changed = {name for name, box in made.nodes.items() if (box.x, box.y) != old[name]}
    if not changed:
        return
    _frame(picture, made, changed)
    _route(picture, made, changed, old)
    boxes = [*made.nodes.values(), *made.hosts.values(), *(frame for _, _, frame in made.groups)]
    points = [point for line in made.lines for point in line]
    made.width = max(made.width, *(box.x + box.width + PAD for box in boxes), *(x + PAD for x, _ in points))
    made.height = max(made.height, *(box.y + box.height + PAD for box in boxes), *(y + PAD for _, y in points))


def _make_room(made: ScreenGeometry, pinned: list[str]) -> None:
    """Moves nodes down that a pinned node covers."""
    fixed = [made.nodes[name] for name in pinned]
    others = [box for name, box in made.nodes.items() if name not in set(pinned)]
    for box in sorted(others, key=lambda one: one.y):
        y = box.y
        while (other := next((one for one in fixed if _touch(box, one, STEP)), None)) is not None:
            box.y = other.y + other.height + _APART
        if box.y != y:
            fixed.append(box)


def _part_hosts(picture: Picture, made: ScreenGeometry, pinned: set[str]) -> None:
    """Moves whole hosts down, and nodes outside of hosts, that the frame of a host with a moved node covers. What a
    person moved stays."""
    members = {host: [node.name for node in picture.inside(host)] for host in made.hosts}
    grown = [host for host, names in members.items() if pinned.intersection(names)]
    fixed = [_frame_of(picture, made, host, members[host]) for host in grown]
    others = [(host, [name for name in names if name not in pinned]) for host, names in members.items()]
    others = [(host, names) for host, names in others if host not in grown]
    others += [("", [node.name]) for node in picture.inside("") if node.name not in pinned]
    for host, names in sorted(others, key=lambda one: min(made.nodes[name].y for name in one[1])):
        frame = _frame_of(picture, made, host, names)
        while (other := next((one for one in fixed if _touch(frame, one, STEP)), None)) is not None:
            down = other.y + other.height + 2 * STEP - frame.y
            frame.y += down
            for name in names:
                made.nodes[name].y += down
        fixed.append(frame)


def _frame_of(picture: Picture, made: ScreenGeometry, host: str, names: list[str]) -> Rectangle:
    """The frame that a host needs; of no host, the box itself."""
    boxes = [made.nodes[name] for name in names]
    if not host:
        return _around(boxes, 0, 0, [])
    has_group = any(picture.nodes[name].groups for name in names)
    return _around(boxes, HOST_TITLE + (GROUP_TITLE if has_group else 0), 2 * PAD, [])


def _touch(one: Rectangle, other: Rectangle, apart: float) -> bool:
    return (one.x < other.x + other.width + apart and other.x < one.x + one.width + apart
            and one.y < other.y + other.height + apart and other.y < one.y + one.height + apart)  # fmt: skip


def _frame(picture: Picture, made: ScreenGeometry, changed: set[str]) -> None:
    """The frames of groups and hosts around what moved."""
    hosts = {picture.nodes[name].box for name in changed} - {""}
    for at, (group, host, frame) in enumerate(made.groups):
        members = {
            node.name for node in picture.nodes.values() if node.box == host and node.groups[:1] == (group,)
        }  # fmt: skip
        if members & changed:
            grown = _around([made.nodes[name] for name in members], GROUP_TITLE, PAD, frame.texts)
            made.groups[at] = (group, host, grown)
    for host in hosts:
        inside = [made.nodes[node.name] for node in picture.inside(host)]
        inside += [frame for _, own, frame in made.groups if own == host]
        made.hosts[host] = _around(inside, HOST_TITLE, PAD, made.hosts[host].texts)


def _around(boxes: Iterable[Rectangle], above: float, pad: float, texts: list[str]) -> Rectangle:
    boxes = list(boxes)
    left, top = min(box.x for box in boxes) - pad, min(box.y for box in boxes) - above
    right, bottom = max(box.x + box.width for box in boxes) + pad, max(box.y + box.height for box in boxes) + pad
    return Rectangle(left, top, right - left, bottom - top, texts)


def _route(picture: Picture, made: ScreenGeometry, changed: set[str], old: dict[str, Point]) -> None:
    """New ways for the lines of what moved, and for those that cross it."""
    frames = [*made.hosts.values(), *(frame for _, _, frame in made.groups)]
    titles = [Rectangle(one.x + PAD, one.y + 4, width(one.texts[0], SMALL_ON_SCREEN), 14) for one in frames]
    obstacles = [*made.nodes.values(), *titles]
    new = [*(made.nodes[name] for name in changed), *titles]
    ways = _Ways(obstacles)
    again: list[int] = []
    for at, (line, points) in enumerate(zip(picture.lines, made.lines, strict=True)):
        is_moved = line.source in changed or line.target in changed
        if is_moved or any(_crosses(segment, box) for segment in pairwise(points) for box in new):
            again.append(at)
        else:
            ways.use(line, points)
    for at in again:
        line, points = picture.lines[at], made.lines[at]
        start, end = (
            (point[0] + made.nodes[name].x - old[name][0], point[1] + made.nodes[name].y - old[name][1])
            for point, name in ((points[0], line.source), (points[-1], line.target))
        )
        made.lines[at] = ways.way(line, start, end)
        ways.use(line, made.lines[at])


def _crosses(segment: Segment, box: Rectangle) -> bool:
    (x, y), (u, v) = segment
    return (min(x, u) < box.x + box.width and box.x < max(x, u)
            and min(y, v) < box.y + box.height and box.y < max(y, v))  # fmt: skip


class _Ways:
    """Finds ways along the sides of nodes: shortest ones, with few bends, that do not run along other lines."""

    def __init__(self, obstacles: list[Rectangle]) -> None:
        self.obstacles = obstacles
        self._beside: dict[tuple[bool, float], list[Rectangle]] = {}
        self._used: dict[tuple[bool, float], list[tuple[float, float, PictureLine]]] = {}

    def _tracks(self, first: Point, last: Point, room: float) -> tuple[list[float], list[float]]:
        """The tracks along the sides of what is near a line: their x and y coordinates."""
        left, right = min(first[0], last[0]) - room, max(first[0], last[0]) + room
        top, bottom = min(first[1], last[1]) - room, max(first[1], last[1]) + room
        xs, ys = {first[0], last[0]}, {first[1], last[1]}
        for box in self.obstacles:
            if box.x < right and left < box.x + box.width and box.y < bottom and top < box.y + box.height:
                for side in (_BESIDE, _BESIDE + STEP):
                    xs |= {box.x - side, box.x + box.width + side}
                    ys |= {box.y - side, box.y + box.height + side}
        return sorted(x for x in xs if x > 0), sorted(y for y in ys if y > 0)

    def use(self, line: PictureLine, points: list[Point]) -> None:
        for (x, y), (u, v) in pairwise(points):
            key, ends = ((True, x), (y, v)) if x == u else ((False, y), (x, u))
            self._used.setdefault(key, []).append((min(ends), max(ends), line))

    def way(self, line: PictureLine, start: Point, end: Point) -> list[Point]:
        first, last = (start[0] + self._room(start, 1), start[1]), (end[0] - self._room(end, -1), end[1])
        found = self._simple(line, first, last)
        if found is None:
            found = next(filter(None, (self._search(line, first, last, room) for room in _ROOMS)), None)
        if found is None:
            middle = (first[0] + last[0]) / 2 if first[0] < last[0] else first[0]
            found = [first, (middle, first[1]), (middle, last[1]), last]
        return _straight([start, *found, end])

    def _room(self, point: Point, side: int) -> float:
        """How far a line leaves a node before it turns: half of the way if another node is close."""
        gaps = [
            (box.x - point[0] if side > 0 else point[0] - box.x - box.width) for box in self._along(False, point[1])
        ]  # fmt: skip
        return min([_BESIDE, *(gap / 2 for gap in gaps if gap >= 0)])

    def _simple(self, line: PictureLine, first: Point, last: Point) -> list[Point] | None:
        """The shortest way with at most four bends that is free and runs along no other line."""
        xs, ys = self._tracks(first, last, _ROOMS[0])
        ways: list[list[Point]] = [[first, (x, first[1]), (x, last[1]), last] for x in xs if first[0] <= x <= last[0]]
        behind = [x for x in xs if x >= first[0]][:_TRACKS]
        before = [x for x in xs if x <= last[0]][-_TRACKS:]
        ways += [
            [first, (x, first[1]), (x, y), (u, y), (u, last[1]), last] for x in behind for u in before for y in ys
        ]  # fmt: skip
        for way in sorted(ways, key=_length):
            if all(a == b or not (self._is_blocked(a, b) or self._shared(line, a, b)) for a, b in pairwise(way)):
                return way
        return None

    def _search(self, line: PictureLine, first: Point, last: Point, room: float) -> list[Point] | None:
        """A* over the crossings of all sides. A state is a crossing, and whether the way came vertically."""
        xs, ys = self._tracks(first, last, room)
        begin = (bisect_left(xs, first[0]), bisect_left(ys, first[1]), False)
        goal = (bisect_left(xs, last[0]), bisect_left(ys, last[1]))
        cost, came = {begin: 0.0}, dict[tuple[int, int, bool], tuple[int, int, bool]]()
        waiting = [(0.0, begin)]
        for _ in range(_MOST_STEPS):
            if not waiting:
                return None
            _, state = heapq.heappop(waiting)
            column, row, is_vertical = state
            if (column, row) == goal:
                return _path(state, came, xs, ys)
            for right, down in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                i, j, turns = column + right, row + down, down != 0
                if not (0 <= i < len(xs) and 0 <= j < len(ys)):
                    continue
                a, b = (xs[column], ys[row]), (xs[i], ys[j])
                if self._is_blocked(a, b):
                    continue
                price = cost[state] + abs(a[0] - b[0]) + abs(a[1] - b[1]) + (_BEND if turns != is_vertical else 0)
                price += self._shared(line, a, b) + (_BEND if (i, j) == goal and turns else 0)
                following = (i, j, turns)
                if price < cost.get(following, float("inf")):
                    cost[following], came[following] = price, state
                    ahead = abs(b[0] - last[0]) + abs(b[1] - last[1])
                    heapq.heappush(waiting, (price + ahead, following))
        return None

    def _is_blocked(self, a: Point, b: Point) -> bool:
        if a[0] == b[0]:
            low, high = min(a[1], b[1]) - _CLEAR, max(a[1], b[1]) + _CLEAR
            return any(box.y < high and low < box.y + box.height for box in self._along(True, a[0]))
        low, high = min(a[0], b[0]) - _CLEAR, max(a[0], b[0]) + _CLEAR
        return any(box.x < high and low < box.x + box.width for box in self._along(False, a[1]))

    def _along(self, is_vertical: bool, at: float) -> list[Rectangle]:
        """The obstacles on a vertical or horizontal line of the whole picture."""
        key = (is_vertical, at)
        if key not in self._beside:
            self._beside[key] = [
                box for box in self.obstacles
                if (box.x if is_vertical else box.y) - _CLEAR < at
                < (box.x + box.width if is_vertical else box.y + box.height) + _CLEAR
            ]  # fmt: skip
        return self._beside[key]

    def _shared(self, line: PictureLine, a: Point, b: Point) -> float:
        key, ends = ((True, a[0]), (a[1], b[1])) if a[0] == b[0] else ((False, a[1]), (a[0], b[0]))
        low, high = min(ends), max(ends)
        for start, end, other in self._used.get(key, ()):
            is_same = (other.target, other.label, other.kind) == (line.target, line.label, line.kind)
            if not is_same and start <= high and low <= end:
                return _SHARED
        return 0.0


def _length(points: list[Point]) -> float:
    bends = _BEND * (len(points) - 2)
    return bends + sum(abs(a[0] - b[0]) + abs(a[1] - b[1]) for a, b in pairwise(points))


def _path(
    state: tuple[int, int, bool], came: dict[tuple[int, int, bool], tuple[int, int, bool]],
    xs: list[float], ys: list[float],
) -> list[Point]:  # fmt: skip
    points = [(xs[state[0]], ys[state[1]])]
    while state in came:
        state = came[state]
        points.append((xs[state[0]], ys[state[1]]))
    return points[::-1]


def _straight(points: list[Point]) -> list[Point]:
    """The corners only."""
    made: list[Point] = []
    for point in points:
        if made and point == made[-1]:
            continue
        if len(made) > 1 and (made[-2][0] == made[-1][0] == point[0] or made[-2][1] == made[-1][1] == point[1]):
            made[-1] = point
        else:
            made.append(point)
    return made
