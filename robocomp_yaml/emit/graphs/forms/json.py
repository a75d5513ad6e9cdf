"""The picture as data, with its geometry on a screen: pixels from the upper left corner."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.emit.graphs.geometry import Rectangle
from robocomp_yaml.emit.graphs.picture import Picture, PictureFault, PictureNode
from robocomp_yaml.emit.graphs.screen import ScreenGeometry, screen_geometry


def draw(picture: Picture) -> str:
    return dumps(picture_data(picture, screen_geometry(picture, picture.cells)))


def picture_data(picture: Picture, geometry: ScreenGeometry) -> dict[str, Any]:
    return {
        "width": geometry.width, "height": geometry.height,
        "name": picture.name,
        "hosts": [
            {"name": box.name, "title": box.title, **_at(geometry.hosts.get(box.name))} for box in picture.boxes
        ],
        "groups": [{"name": name, "host": host, **_at(box)} for name, host, box in geometry.groups],
        "nodes": [
            {**node_data(node), "texts": geometry.nodes[node.name].texts, **_at(geometry.nodes[node.name])}
            for node in picture.nodes.values()
        ],
        "edges": [
            {"from": line.source, "to": line.target, "kind": line.kind, "label": line.label,
             "faults": _faults(line.faults), "points": [list(point) for point in points]}
            for line, points in zip(picture.lines, geometry.lines, strict=True)
        ],
        "faults": _faults(picture.faults),
    }  # fmt: skip


def node_data(node: PictureNode) -> dict[str, Any]:
    """A node without its geometry."""
    return {
        "name": node.name, "title": node.title, "kind": node.kind, "host": node.box, "about": list(node.about),
        "serves": [{"interface": name, "port": port or None} for name, port in node.serves],
        "groups": list(node.groups), "enabled": node.enabled, "faults": _faults(node.faults),
        "texts": node.texts(),
    }  # fmt: skip


def _at(box: Rectangle | None) -> dict[str, float]:
    """A host without nodes is nowhere."""
    return {} if box is None else {"x": box.x, "y": box.y, "width": box.width, "height": box.height}


def _faults(faults: tuple[PictureFault, ...]) -> list[dict[str, str]]:
    return [
        {"code": fault.code, "severity": "error" if fault.is_error else "warning", "message": fault.message}
        for fault in faults
    ]
