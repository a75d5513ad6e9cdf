"""The geometry on a screen: nothing overlaps, no line crosses a node, and what is there stays where it is."""

from __future__ import annotations

from itertools import combinations, pairwise, product
from random import Random

import pytest
from msgspec.structs import replace

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
    name, other = [name for name, node in picture.nodes.items() if node.box and not node.groups][:2]
    cell = Cell(3, 7, picture.nodes[name].box)
    same = {name: cell, other: Cell(3, 7, picture.nodes[other].box), "gone": Cell(0, 0)}
    made = screen_geometry(picture, same)
    check(picture, made)
    assert made.cells[name] == cell
    assert "gone" not in made.cells


@pytest.mark.parametrize("seed", range(8))
def test_frames_stay_apart_while_nodes_come_go_and_move_to_others(seed: int) -> None:
    """Cells are kept of nodes that are gone, so that they come back where they were, unless others are there now."""
    random, whole = Random(seed), random_picture(seed, 24)
    cells: dict[str, Cell] = {}
    for _ in range(12):
        picture = Picture(whole.name, whole.boxes)
        picture.nodes = {name: node for name, node in whole.nodes.items() if random.random() < 0.7}
        moved = random.choice(list(picture.nodes))
        box, groups = random.choice(whole.boxes).name, random.choice([(), ("g0",), ("g1",), ("new",)])
        picture.nodes[moved] = whole.nodes[moved] = replace(whole.nodes[moved], box=box, groups=groups)
        picture.lines = [one for one in whole.lines if one.source in picture.nodes and one.target in picture.nodes]
        made = screen_geometry(picture, cells)
        check(picture, made)
        cells.update(made.cells)


def shape(kind: str) -> Picture:
    """Networks as people have them, of one host or two."""
    made = Picture("Robot", [Box("a", "a"), Box("b", "b")])
    uses: dict[str, list[str]] = {
        "star": {f"client{at}": ["server"] for at in range(20)} | {"server": []},
        "hub": {"client": [f"server{at}" for at in range(20)]} | {f"server{at}": [] for at in range(20)},
        "chain": {f"c{at}": [f"c{at + 1}"] if at < 14 else [] for at in range(15)},
        "flat": {f"c{at}": [] for at in range(30)},
        "two": {"speech": ["mouth"], "mouth": []},
        "two hosts": {f"c{at}": [f"c{at - 3}"] if at > 3 else [] for at in range(30)},
        "groups": {f"c{at}": [f"c{at - 5}"] if at > 5 else [] for at in range(30)},
    }[kind]
    for at, (name, needs) in enumerate(uses.items()):
        host = "b" if kind == "two hosts" and at > 2 else "a"
        groups = (f"g{at // 8}",) if kind == "groups" and at < 24 else ()
        made.nodes[name] = PictureNode(
            name, name, "component", host, ("TheComponent",), ((f"Interface{at}", 10000 + at),), groups
        )
        made.lines += [PictureLine(name, other) for other in needs]
    return made


@pytest.mark.parametrize("kind", ["star", "hub", "chain", "flat", "two", "two hosts", "groups"])
def test_networks_of_all_shapes_are_readable_and_have_no_deserts(kind: str) -> None:
    picture = shape(kind)
    made = screen_geometry(picture)
    check(picture, made)
    assert SMALL_ON_SCREEN * min(1300 / made.width, 850 / made.height) >= 11, (made.width, made.height)
    spots = {(cell.layer, cell.slot) for cell in made.cells.values()}
    wide, high = len({layer for layer, _ in spots}), len({slot for _, slot in spots})
    assert len(spots) >= 0.6 * wide * high, (wide, high)
    empty = 0  # the largest rectangle of empty cells is small
    for left, top in product(range(wide), range(high)):
        for right, bottom in product(range(left, wide), range(top, high)):
            if all((x, y) not in spots for x in range(left, right + 1) for y in range(top, bottom + 1)):
                empty = max(empty, (right - left + 1) * (bottom - top + 1))
    assert empty <= max(1, len(spots) // 4), (empty, wide, high)


def test_a_chain_that_is_too_long_goes_on_below_from_the_left() -> None:
    made = screen_geometry(shape("chain"))
    order = sorted(made.cells, key=lambda name: (made.cells[name].slot, made.cells[name].layer))
    assert order == [f"c{at}" for at in range(15)]


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


NAMES = (
    "camera_front", "object_detector", "people_tracker", "speech_recogniser", "dialog_manager", "diagnostics_aggregator",
)  # fmt: skip


def long_names(uses: int) -> Picture:
    """Thirty processes with long names: each uses so many others, all the same one (-1), or the one before (-2)."""
    random, made = Random(5), Picture("Robot", [Box("", "this machine")])
    for number in range(30):
        name, others = f"{NAMES[number % 6]}{number // 6}", list(made.nodes)
        made.nodes[name] = PictureNode(name, name, "component", "", ("sleep",), ((name.capitalize(), 23000),))
        used = others[:1] if uses == -1 else others[-1:] if uses == -2 else random.sample(others, min(number, uses))
        made.lines += [PictureLine(name, other, other.capitalize()) for other in used]
    return made


@pytest.mark.parametrize("uses", [0, 1, 2, 4, -1, -2])
def test_a_picture_has_the_shape_of_a_screen_however_long_its_names_and_many_its_lines_are(uses: int) -> None:
    picture = long_names(uses)
    made = screen_geometry(picture)
    check(picture, made)
    assert SMALL_ON_SCREEN * min(1300 / made.width, 850 / made.height) >= 11, (made.width, made.height)
    assert 0.9 < made.width / made.height < 2, (made.width, made.height)


def test_a_picture_of_five_hundred_has_the_shape_of_a_screen() -> None:
    """Twenty groups on five hosts, at the size of their blocks from afar."""
    pick, made = Random(9), Picture("Fleet", [Box(f"h{host}", f"h{host} (127.0.0.{host})") for host in range(5)])
    for number in range(500):
        name, group = f"component{number}", number // 25
        made.nodes[name] = PictureNode(
            name, name, "program", f"h{number // 100}", ("sleep",), ((f"Interface{number % 20}", 20000 + number),),
            (f"g{group}",),
        )  # fmt: skip
        near = [other for other in range(group * 25, number) if pick.random() < 0.07]
        far = [pick.randrange(number)] if number and pick.random() < 0.3 else []
        made.lines += [PictureLine(name, f"component{one}", kind="after") for one in dict.fromkeys((*near[:3], *far))]
    geometry = screen_geometry(made)
    assert min(1300 / geometry.width, 850 / geometry.height) > 0.22, (geometry.width, geometry.height)
    assert 0.9 < geometry.width / geometry.height < 2


def test_titles_have_room_for_what_is_beside_them() -> None:
    made = screen_geometry(Picture("Robot", [], {
        "a": PictureNode("a", "a_process_with_a_name", "component"), "b": PictureNode("b", "a_topic_with_a_name", "topic"),
    }))  # fmt: skip
    for name, room in (("a", 12), ("b", 44)):  # the sign of its state, and its rate
        box = made.nodes[name]
        assert box.x + 12 + width(box.texts[0], 13, bold=True) + room <= box.x + box.width - 6


def test_nothing_is_drawn_of_nothing() -> None:
    made = screen_geometry(Picture("Nothing"))
    assert (made.nodes, made.lines, made.hosts) == ({}, [], {})


@pytest.mark.parametrize("seed", range(8))
def test_nodes_are_where_a_person_moved_them(seed: int) -> None:
    """What was not moved stays, and no line crosses a node, wherever a node is put: beside the picture, or on others."""
    picture, random = random_picture(seed, 6 + 4 * seed), Random(seed)
    before = screen_geometry(picture)
    names = random.sample(list(picture.nodes), 2)
    far = before.nodes[names[1]]
    picture.positions = {
        names[0]: (before.width + 100, 300), names[1]: (far.x + random.randrange(60), far.y + 200), "gone": (1, 1),
    }  # fmt: skip
    after = screen_geometry(picture, before.cells)
    for name in names:
        assert (after.nodes[name].x, after.nodes[name].y) == picture.positions[name]
    for one, other in combinations(after.nodes.values(), 2):
        assert not overlap(one, other)
    grown = {picture.nodes[name].box for name in names}
    aside = [name for name, node in picture.nodes.items() if name not in names and node.box in grown
             and (before.nodes[name].x, before.nodes[name].y) != (after.nodes[name].x, after.nodes[name].y)]  # fmt: skip
    assert len(aside) <= 4
    for one, other in combinations(after.hosts, 2):
        assert {one, other} <= grown or not overlap(after.hosts[one], after.hosts[other])
    for line, points, old in zip(picture.lines, after.lines, before.lines, strict=True):
        source, target = after.nodes[line.source], after.nodes[line.target]
        assert (points[0][0], points[-1][0]) == (source.x + source.width, target.x)
        assert source.y < points[0][1] < source.y + source.height
        assert target.y < points[-1][1] < target.y + target.height
        parts = segments(points)
        assert all((a[0] == b[0]) != (a[1] == b[1]) for a, b in parts)
        for at, part in enumerate(parts):
            for name, box in after.nodes.items():
                is_end = (at == 0 and name == line.source) or (at == len(parts) - 1 and name == line.target)
                assert is_end or not crosses(part, box), (line, name, part, points, old)
    for node in picture.nodes.values():
        assert not node.box or inside(after.hosts[node.box], after.nodes[node.name])
        for group, host, frame in after.groups:
            assert (node.box, *node.groups[:1]) != (host, group) or inside(frame, after.nodes[node.name])
    assert all(x <= after.width and y <= after.height for points in after.lines for x, y in points)


def test_positions_that_change_nothing_change_nothing() -> None:
    picture = random_picture(5, 20)
    before = screen_geometry(picture)
    picture.positions = {name: (box.x, box.y) for name, box in before.nodes.items()}
    assert screen_geometry(picture, before.cells) == before


def test_a_line_turns_in_the_gap_between_close_nodes() -> None:
    nodes = {name: PictureNode(name, name, "component") for name in ("a", "b", "c")}
    picture = Picture("Robot", [], nodes, [PictureLine("a", "b"), PictureLine("c", "b")])
    wide = screen_geometry(picture).nodes["a"].width
    picture.positions = {"c": (40, 100), "b": (40 + wide + 8, 104), "a": (400, 400)}
    made = screen_geometry(picture)
    for line, points in zip(picture.lines, made.lines, strict=True):
        for part in segments(points):
            for name, box in made.nodes.items():
                one = thin(*part)
                is_inside = one.x < box.x + box.width and box.x < one.x + one.width
                is_inside = is_inside and one.y < box.y + box.height and box.y < one.y + one.height
                assert not is_inside, (line, name, points)
