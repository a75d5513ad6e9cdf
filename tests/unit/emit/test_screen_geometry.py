"""The geometry on a screen: nothing overlaps, no line crosses a node, and what is there stays where it is."""

from __future__ import annotations

from itertools import combinations, pairwise
from random import Random

import pytest

from robocomp_yaml.emit.graphs.geometry import Rectangle
from robocomp_yaml.emit.graphs.measure import width
from robocomp_yaml.emit.graphs.picture import (
    AFTER,
    PUBLISHES,
    SUBSCRIBES,
    USES,
    Box,
    Cell,
    Picture,
    PictureLine,
    PictureNode,
)
from robocomp_yaml.emit.graphs.screen import LINE_HEIGHT, SMALL_ON_SCREEN, ScreenGeometry, screen_geometry

Point = tuple[float, float]


def random_picture(seed: int, count: int) -> Picture:
    """Hosts with groups, interfaces, topics, cycles, processes outside of hosts, and names of any length."""
    random = Random(seed)
    hosts = [f"host{number}" for number in range(random.randrange(1, 5))]
    made = Picture("Robot", [Box(host, f"{host} (10.0.0.2)") for host in hosts])
    for number in range(count):
        name = f"{'long' * random.randrange(4)}node{number}"
        serves = tuple((f"I{number}x{at}", 10000 + at) for at in range(random.randrange(4)))
        groups = (f"g{random.randrange(3)}",) if random.random() < 0.4 else ()
        host = random.choice([*hosts, ""]) if random.random() < 0.2 else hosts[number * len(hosts) // count]
        made.nodes[name] = PictureNode(name, name, "component", host, ("AComponent",), serves, groups)
    names = list(made.nodes)
    for _ in range(count * 3 // 2):
        source, target = random.choice(names), random.choice(names)
        kind = random.choice((USES, USES, USES, AFTER, PUBLISHES, SUBSCRIBES))
        served = [interface for interface, _ in made.nodes[target].serves]
        label = random.choice(served) if kind == USES and served else ""
        if source != target:
            made.lines.append(PictureLine(source, target, f"proxy: {label}" if label else "", kind))
    return made


def segments(points: list[Point]) -> list[tuple[Point, Point]]:
    return list(pairwise(points))


def overlap(one: Rectangle, other: Rectangle) -> bool:
    return (one.x < other.x + other.width and other.x < one.x + one.width
            and one.y < other.y + other.height and other.y < one.y + one.height)  # fmt: skip


def inside(outer: Rectangle, inner: Rectangle) -> bool:
    return (outer.x <= inner.x and inner.x + inner.width <= outer.x + outer.width
            and outer.y <= inner.y and inner.y + inner.height <= outer.y + outer.height)  # fmt: skip


def thin(a: Point, b: Point) -> Rectangle:
    return Rectangle(min(a[0], b[0]), min(a[1], b[1]), abs(a[0] - b[0]), abs(a[1] - b[1]))


def crosses(segment: tuple[Point, Point], box: Rectangle) -> bool:
    """Whether a segment touches a box, or comes closer than two pixels to it."""
    one = thin(*segment)
    return (one.x < box.x + box.width + 2 and box.x - 2 < one.x + one.width
            and one.y < box.y + box.height + 2 and box.y - 2 < one.y + one.height)  # fmt: skip


def check(picture: Picture, made: ScreenGeometry) -> None:
    nodes, hosts = made.nodes, made.hosts
    assert set(nodes) == set(picture.nodes)
    for one, other in combinations(nodes.values(), 2):
        assert not overlap(one, other)
    for one, other in combinations(hosts.values(), 2):
        assert not overlap(one, other)
    for name, node in picture.nodes.items():
        box = nodes[name]
        assert box.x >= 0
        assert box.y >= 0
        assert box.x + box.width <= made.width
        assert box.y + box.height <= made.height
        assert not node.box or inside(hosts[node.box], box)
        for host, frame in hosts.items():
            assert host == node.box or not overlap(frame, box)
        for group, host, frame in made.groups:
            is_member = node.box == host and bool(node.groups) and node.groups[0] == group
            assert (inside if is_member else lambda a, b: not overlap(a, b))(frame, box)
    frames = [*hosts.values(), *(frame for _, _, frame in made.groups)]
    titles = [Rectangle(one.x + 8, one.y + 4, width(one.texts[0], SMALL_ON_SCREEN), 14) for one in frames]
    for points in made.lines:
        assert not any(crosses(segment, title) for segment in segments(points) for title in titles)
    for (_, host, frame), (_, _, other) in combinations(made.groups, 2):
        assert not overlap(frame, other)
        assert not host or inside(hosts[host], frame)
    taken: dict[tuple[str, str, str], list[tuple[Point, Point]]] = {}
    for line, points in zip(picture.lines, made.lines, strict=True):
        source, target = nodes[line.source], nodes[line.target]
        assert points[0][0] == source.x + source.width
        assert source.y < points[0][1] < source.y + source.height
        assert points[-1][0] == target.x
        assert target.y < points[-1][1] < target.y + target.height
        label = line.label.rpartition(": ")[2]
        for at, (a, b) in enumerate(parts := segments(points)):
            assert (a[0] == b[0]) != (a[1] == b[1]), "lines go straight, and turn"
            for name, box in nodes.items():
                is_end = (at == 0 and name == line.source) or (at == len(parts) - 1 and name == line.target)
                assert is_end or not crosses((a, b), box), (line, name, a, b)
        taken.setdefault((line.target, label, line.kind), []).extend(parts)
    for (_, one), (_, other) in combinations(taken.items(), 2):
        for a in one:
            for b in other:
                assert not together(a, b), (a, b)


def together(one: tuple[Point, Point], other: tuple[Point, Point]) -> bool:
    """Whether two segments share more than a point."""
    for axis in (0, 1):
        across = 1 - axis
        if len({one[0][across], one[1][across], other[0][across], other[1][across]}) == 1:
            low = max(min(one[0][axis], one[1][axis]), min(other[0][axis], other[1][axis]))
            high = min(max(one[0][axis], one[1][axis]), max(other[0][axis], other[1][axis]))
            if high > low:
                return True
    return False


@pytest.mark.parametrize("seed", range(12))
def test_nothing_overlaps_in_random_networks(seed: int) -> None:
    picture = random_picture(seed, 4 + 3 * seed)
    check(picture, screen_geometry(picture))


def test_a_line_ends_beside_the_interface_that_it_uses() -> None:
    nodes = {
        "speech": PictureNode("speech", "speech", "component", about=("SpeechComp",)),
        "mouth": PictureNode("mouth", "mouth", "component", about=("MouthComp",), serves=(("Mouth", 1), ("Lips", 2))),
    }
    picture = Picture(
        "Head", [], nodes, [PictureLine("speech", "mouth", "Lips"), PictureLine("speech", "mouth", "Mouth")]
    )
    made = screen_geometry(picture)
    box = made.nodes["mouth"]
    lines = [round((points[-1][1] - box.y) // LINE_HEIGHT) for points in made.lines]
    assert [box.texts[at] for at in lines] == ["Lips 2", "Mouth 1"]
    assert made.nodes["speech"].x < box.x


@pytest.mark.parametrize("seed", range(6))
def test_what_is_added_moves_nothing_and_what_is_removed_leaves_the_others(seed: int) -> None:
    picture = random_picture(seed, 20)
    first = screen_geometry(picture)
    picture.nodes["new"] = PictureNode("new", "new", "component", picture.boxes[0].name)
    picture.lines.append(PictureLine("new", next(iter(picture.nodes))))
    second = screen_geometry(picture, first.cells)
    check(picture, second)
    assert {name: second.cells[name] for name in first.cells} == first.cells
    gone = next(iter(picture.nodes))
    del picture.nodes[gone]
    picture.lines[:] = [line for line in picture.lines if gone not in (line.source, line.target)]
    third = screen_geometry(picture, second.cells)
    check(picture, third)
    assert {name: cell for name, cell in second.cells.items() if name != gone} == third.cells


def test_cells_that_are_wrong_are_not_kept() -> None:
    picture = random_picture(3, 12)
    name, other = list(picture.nodes)[:2]
    same = {name: Cell(3, 7), other: Cell(3, 7), "gone": Cell(0, 0)}
    made = screen_geometry(picture, same)
    check(picture, made)
    assert made.cells[name] == Cell(3, 7)
    assert "gone" not in made.cells


def test_thirty_processes_are_readable_on_a_screen() -> None:
    """Three hosts, each with a chain of three: at first sight, texts are at least eleven pixels high."""
    made = Picture("Robot", [Box(f"h{host}", f"h{host} (10.0.0.{host})") for host in range(3)])
    for number in range(30):
        name, host = f"component{number}", f"h{number // 10}"
        made.nodes[name] = PictureNode(
            name, name, "component", host, ("TheComponent",), ((f"Interface{number}", 10000 + number),)
        )
        if number % 10 > 2:
            made.lines.append(PictureLine(name, f"component{number - 3}", f"Interface{number - 3}"))
    geometry = screen_geometry(made)
    check(made, geometry)
    zoom = min(1500 / geometry.width, 850 / geometry.height)
    assert SMALL_ON_SCREEN * zoom >= 11, (geometry.width, geometry.height)


def test_nothing_is_drawn_of_nothing() -> None:
    made = screen_geometry(Picture("Nothing"))
    assert (made.nodes, made.lines, made.hosts) == ({}, [], {})
