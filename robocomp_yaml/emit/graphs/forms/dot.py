"""The picture for Graphviz: `dot -Tsvg`."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.picture import Picture, PictureLine, PictureNode

_RED = "#c62828"
_SHAPES = {
    parts.COMPONENT: 'shape=box, style="rounded,filled", fillcolor="#e8f0fe"',
    parts.PROGRAM: 'shape=box, style="filled", fillcolor="#f1f3f4"',
    parts.ICESTORM: 'shape=cylinder, style="filled", fillcolor="#f3e8fd"',
    parts.TOPIC: 'shape=ellipse, style="filled", fillcolor="#f3e8fd"',
    parts.OUTSIDE: 'shape=box, style="dashed"',
}
_LINES = {
    parts.USES: "", parts.PUBLISHES: 'color="#8430ce"', parts.SUBSCRIBES: 'color="#8430ce", dir=back',
    parts.AFTER: 'style=dashed, color="#80868b"',
}  # fmt: skip


def draw(picture: Picture) -> str:
    lines = [
        f"digraph {_quoted(picture.name)} {{", '  graph [fontname="Helvetica", compound=true];',
        '  node [fontname="Helvetica", fontsize=11];', '  edge [fontname="Helvetica", fontsize=9];',
    ]  # fmt: skip
    for number, box in enumerate(picture.boxes):
        lines += [f"  subgraph cluster_{number} {{", f"    label={_quoted(box.title)};"]
        lines += [f"    {_node(node)}" for node in picture.inside(box.name)]
        lines.append("  }")
    lines += [f"  {_node(node)}" for node in picture.inside("")]
    lines += [f"  {line}" for line in _lines(picture)]
    return "\n".join([*lines, "}"]) + "\n"


def _node(node: PictureNode) -> str:
    more = f', color="{_RED}", penwidth=2, tooltip={_quoted(*_faults(node))}' if node.faults else ""
    more += "" if node.enabled else ', fontcolor="#9aa0a6"'
    return f"{_quoted(node.name)} [label={_quoted(*node.texts())}, {_SHAPES[node.kind]}{more}];"


def _lines(picture: Picture) -> Iterator[str]:
    for line in picture.lines:
        label = line.label if line.kind == parts.USES else ""
        words = [f"label={_quoted(label)}"] if label else []
        words += [_LINES[line.kind]] if _LINES[line.kind] else []
        words += [f'color="{_RED}"', f'fontcolor="{_RED}"', f"tooltip={_quoted(*_faults(line))}"] if line.faults else []
        yield f"{_quoted(line.source)} -> {_quoted(line.target)}" + (f" [{', '.join(words)}]" if words else "") + ";"


def _faults(part: PictureNode | PictureLine) -> list[str]:
    return [fault.text for fault in part.faults]


def _quoted(*lines: str) -> str:
    text = "\n".join(lines)
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
