"""The picture for Mermaid, which GitHub and GitLab draw in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.picture import Picture, PictureNode

_SHAPES = {
    parts.COMPONENT: ("(", ")"), parts.PROGRAM: ("[", "]"), parts.ICESTORM: ("[(", ")]"),
    parts.TOPIC: ("([", "])"), parts.OUTSIDE: ("[/", "/]"),
}  # fmt: skip
_ARROWS = {parts.USES: "-->", parts.PUBLISHES: "==>", parts.SUBSCRIBES: "==>", parts.AFTER: "-.->"}


def draw(picture: Picture) -> str:
    numbers = {name: f"n{number}" for number, name in enumerate(picture.nodes)}
    lines = ["flowchart TD"]
    for number, box in enumerate(picture.boxes):
        lines.append(f"  subgraph h{number}[{_quoted(box.title)}]")
        lines += [f"    {_node(node, numbers)}" for node in picture.inside(box.name)]
        lines.append("  end")
    lines += [f"  {_node(node, numbers)}" for node in picture.inside("")]
    lines += [f"  {line}" for line in _lines(picture, numbers)]
    lines += [f"  {line}" for line in _faults(picture, numbers)]
    return "\n".join(lines) + "\n"


def _node(node: PictureNode, numbers: dict[str, str]) -> str:
    begin, end = _SHAPES[node.kind]
    return f"{numbers[node.name]}{begin}{_quoted(*node.texts())}{end}"


def _lines(picture: Picture, numbers: dict[str, str]) -> Iterator[str]:
    for line in picture.lines:
        source, target = numbers[line.source], numbers[line.target]
        if line.kind == parts.SUBSCRIBES:
            source, target = target, source
        label = f"|{_quoted(line.label)}|" if line.label and line.kind == parts.USES else ""
        yield f"{source} {_ARROWS[line.kind]}{label} {target}"


def _faults(picture: Picture, numbers: dict[str, str]) -> Iterator[str]:
    wrong = [numbers[node.name] for node in picture.nodes.values() if node.faults]
    off = [numbers[node.name] for node in picture.nodes.values() if not node.enabled]
    for name, style, members in (("wrong", "stroke:#c62828,stroke-width:3px", wrong), ("off", "opacity:0.5", off)):
        if members:
            yield f"classDef {name} {style}"
            yield f"class {','.join(members)} {name}"
    for number, line in enumerate(picture.lines):
        if line.faults:
            yield f"linkStyle {number} stroke:#c62828"


def _quoted(*lines: str) -> str:
    """Lines of text in quotes. Characters with a meaning in Mermaid or HTML are escaped."""
    escaped = [re.sub(r"[\"#&<>\\`;]", lambda match: f"#{ord(match[0])};", " ".join(line.split())) for line in lines]
    return '"' + "<br>".join(escaped) + '"'
