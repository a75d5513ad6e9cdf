"""A picture in which hosts and groups are closed: each is one node, with the lines of all that is in it."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from msgspec.structs import replace

from robocomp_yaml.emit.graphs.picture import TOPIC, Picture, PictureLine, PictureNode

CLOSED = "closed"
"""The kind of a node that stands for others."""
HOST, GROUP = "host", "group"


def closed(picture: Picture, boxes: Collection[str]) -> tuple[Picture, dict[str, list[str]]]:
    """The picture with these boxes closed: `host NAME` and `group NAME`. Also the members of each new node, whose name
    is that of the box; a group has a node in each host (`group NAME@HOST`). What is closed in a closed host is not
    seen."""
    members: dict[str, list[str]] = {}
    box_of: dict[str, str] = {}
    for node in picture.nodes.values():
        own = (f"{HOST} {node.box}", *(f"{GROUP} {name}" for name in node.groups[:1]))
        box = next((one for one in own if one in boxes), "")
        if box:
            box += f"@{node.box}" if box != own[0] else ""
            members.setdefault(box, []).append(node.name)
            box_of[node.name] = box
    nodes: dict[str, PictureNode] = {}
    for node in picture.nodes.values():
        box = box_of.get(node.name, "")
        if not box:
            nodes[node.name] = node
        elif box not in nodes:
            nodes[box] = _node(picture, box, members[box])
    return replace(picture, nodes=nodes, lines=list(_lines(picture.lines, box_of))), members


def _node(picture: Picture, box: str, members: list[str]) -> PictureNode:
    first = picture.nodes[members[0]]
    kind, _, name = box.partition(" ")
    count = sum(1 for member in members if picture.nodes[member].kind != TOPIC)
    title = (
        next((one.title for one in picture.boxes if one.name == name), name) if kind == HOST else name.partition("@")[0]
    )
    about = ("1 process" if count == 1 else f"{count} processes", " " * 16)  # the states are written there
    return PictureNode(box, title, CLOSED, first.box, about)


def _lines(lines: Iterable[PictureLine], box_of: dict[str, str]) -> Iterable[PictureLine]:
    """The lines between what is seen, those of the same kind between two nodes once."""
    found: dict[tuple[str, str, str, str], PictureLine] = {}
    shut = set(box_of.values())
    for line in lines:
        source, target = box_of.get(line.source, line.source), box_of.get(line.target, line.target)
        if source == target:
            continue
        label = "" if target in shut else line.label
        key = source, target, label, line.kind
        other = found.get(key)
        faults = dict.fromkeys((*(other.faults if other is not None else ()), *line.faults))
        found[key] = replace(line, source=source, target=target, label=label, faults=tuple(faults))
    return found.values()
