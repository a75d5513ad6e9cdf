"""The picture as data."""

from __future__ import annotations

from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.emit.graphs.picture import Picture, PictureFault


def draw(picture: Picture) -> str:
    return dumps({
        "name": picture.name,
        "hosts": [{"name": box.name, "title": box.title} for box in picture.boxes],
        "nodes": [
            {
                "name": node.name, "title": node.title, "kind": node.kind, "host": node.box, "about": list(node.about),
                "serves": [{"interface": name, "port": port or None} for name, port in node.serves],
                "groups": list(node.groups), "enabled": node.enabled, "faults": _faults(node.faults),
            }
            for node in picture.nodes.values()
        ],
        "edges": [
            {"from": line.source, "to": line.target, "kind": line.kind, "label": line.label,
             "faults": _faults(line.faults)}
            for line in picture.lines
        ],
        "faults": _faults(picture.faults),
    })  # fmt: skip


def _faults(faults: tuple[PictureFault, ...]) -> list[dict[str, str]]:
    return [
        {"code": fault.code, "severity": "error" if fault.is_error else "warning", "message": fault.message}
        for fault in faults
    ]
