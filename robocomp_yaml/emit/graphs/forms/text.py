"""The picture as text: each host with its processes, and each process with its connections."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.picture import Picture, PictureLine, PictureNode

_ARROWS = {parts.USES: "->", parts.PUBLISHES: "=>", parts.SUBSCRIBES: "<=", parts.AFTER: ".."}


def draw(picture: Picture) -> str:
    lines = [picture.name]
    sections = [(box.name, box.title) for box in picture.boxes] + [("", "")]
    for name, title in sections:
        shown = [node for node in picture.inside(name) if node.kind not in (parts.TOPIC, parts.OUTSIDE)]
        if shown and title:
            lines.append(f"  {title}")
        indent = "    " if title else "  "
        for node in shown:
            lines += [f"{indent}{line}" for line in _node(picture, node)]
    faults = list(picture.all_faults())
    if faults:
        lines.append("problems")
    for owner, fault in faults:
        lines.append(f"  {owner}: {'error' if fault.is_error else 'warning'}[{fault.code}]: {fault.message}")
    return "\n".join(lines) + "\n"


def _node(picture: Picture, node: PictureNode) -> Iterator[str]:
    serves = ", ".join(node.served())
    about = ", ".join([*node.about, *(f"in {group}" for group in node.groups), *([] if node.enabled else ["off"])])
    mark = " !" if node.faults else ""
    yield f"{node.title}{mark}" + (f" ({about})" if about else "") + (f": {serves}" if serves else "")
    for line in picture.lines:
        if line.source == node.name:
            yield f"  {_ARROWS[line.kind]} {_target(picture, line)}{' !' if line.faults else ''}"


def _target(picture: Picture, line: PictureLine) -> str:
    target = picture.nodes[line.target]
    if line.kind == parts.AFTER:
        return f"after {target.title}"
    if target.kind == parts.TOPIC:
        return f"topic {target.title}" + (f" ({line.label})" if line.label else "")
    where = " ".join(target.about[:1]) if target.kind == parts.OUTSIDE else ""
    return f"{line.label} of {target.title}" + (f" ({where})" if where else "")
