"""The picture as SVG, for people. It needs no other file, and suits light and dark pages."""

from __future__ import annotations

from collections.abc import Iterator
from xml.sax.saxutils import escape

from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.geometry import LINE_HEIGHT, SMALL, EdgePath, Geometry, Point, Rectangle, geometry_of
from robocomp_yaml.emit.graphs.measure import shortened, width
from robocomp_yaml.emit.graphs.picture import Picture, PictureFault, PictureNode
from robocomp_yaml.emit.graphs.routes import Net
from robocomp_yaml.emit.xml_text import IMPOSSIBLE

_ROUND = 4.0
_COLORS = 6
"""The number of colours of lines: lines to different targets differ, so that they can be followed."""
_MARGIN = 16.0

_STYLE = """
text { font-family: Helvetica, Arial, 'Liberation Sans', sans-serif; fill: #202124 }
.paper { fill: #ffffff } .head { font-size: 16px; font-weight: bold } .about { font-size: 11px; fill: #5f6368 }
.host { fill: #f8f9fa; stroke: #bdc1c6 } .hostname { font-size: 11px; font-weight: bold; fill: #5f6368 }
.node { stroke-width: 1.2 } .name { font-size: 13px; font-weight: bold }
.component { fill: #e8f0fe; stroke: #4a76c9 } .program { fill: #eceff1; stroke: #78868e }
.icestorm, .topic { fill: #f3e8fd; stroke: #8e5bbf } .outside { fill: #ffffff; stroke: #78868e; stroke-dasharray: 5 3 }
.off { opacity: 0.5 } .line { fill: none; stroke-width: 1.4 } .tip { stroke: none }
.c0 { stroke: #3b6fb6 } .c1 { stroke: #2e7d5b } .c2 { stroke: #a3682a } .c3 { stroke: #5b6770 } .c4 { stroke: #00808a }
.c5 { stroke: #7a7a1f } .publishes, .subscribes { stroke: #8e5bbf } .after { stroke: #b0b6bc; stroke-width: 1.1 }
.t0 { fill: #3b6fb6 } .t1 { fill: #2e7d5b } .t2 { fill: #a3682a } .t3 { fill: #5b6770 } .t4 { fill: #00808a }
.t5 { fill: #7a7a1f } .tpublishes, .tsubscribes { fill: #8e5bbf } .tafter { fill: #9aa0a6 }
.label { font-size: 10px; fill: #3c4043 }
.line.warned { stroke: #e37400 } .node.warned { stroke: #e37400; stroke-width: 2.4 }
.line.wrong { stroke: #d93025; stroke-width: 2.2 } .node.wrong { stroke: #d93025; stroke-width: 2.4 }
.tip.wrong, .problem.wrong { fill: #d93025 } .tip.warned, .problem.warned { fill: #b35c00 } .problem { font-size: 11px }
@media (prefers-color-scheme: dark) {
text { fill: #e8eaed } .paper { fill: #1b1c1f } .about, .hostname { fill: #a9aeb4 } .label { fill: #c8ccd0 }
.host { fill: #232529; stroke: #4b4f55 } .component { fill: #20304f } .program { fill: #30353a }
.icestorm, .topic { fill: #392a4a } .outside { fill: #1b1c1f }
.c0 { stroke: #7fa8e6 } .c1 { stroke: #6fc29b } .c2 { stroke: #dba36a } .c3 { stroke: #a9b4bd } .c4 { stroke: #4fc3cc }
.c5 { stroke: #c9c95a } .t0 { fill: #7fa8e6 } .t1 { fill: #6fc29b } .t2 { fill: #dba36a } .t3 { fill: #a9b4bd }
.t4 { fill: #4fc3cc } .t5 { fill: #c9c95a } .publishes, .subscribes { stroke: #b98be3 }
.tpublishes, .tsubscribes { fill: #b98be3 } .line.wrong, .node.wrong { stroke: #f28b82 }
.tip.wrong, .problem.wrong { fill: #f28b82 } .line.warned, .node.warned { stroke: #fbae5c }
.tip.warned, .problem.warned { fill: #fbae5c }
}
"""


def draw(picture: Picture) -> str:
    geometry = geometry_of(picture)
    colors = {name: number % _COLORS for number, name in enumerate(picture.nodes)}
    problems = list(_problems(picture, geometry))
    height = geometry.height + len(problems) * LINE_HEIGHT + (_MARGIN if problems else 0)
    wide = max(geometry.width, width(picture.name, 16, bold=True) + width(_count(picture), SMALL) + 4 * _MARGIN)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide:.0f} {height:.0f}" width="{wide:.0f}" '
        f'height="{height:.0f}" role="img">',
        f"<title>{_text(picture.name)}</title>", f"<style>{_STYLE}</style>",
        f'<rect class="paper" width="{wide:.0f}" height="{height:.0f}"/>',
        f'<text class="head" x="{_MARGIN:g}" y="28">{_text(picture.name)}</text>',
        f'<text class="about" x="{2 * _MARGIN + width(picture.name, 16, bold=True):.0f}" y="28">'
        f"{_text(_count(picture))}</text>",
        *(line for block in geometry.hosts.values() for line in _host(block)),
        *(_way(way, colors) for way in geometry.paths),
        *(line for way in geometry.paths for line in _tips(way, colors)),
        *(f'<text class="label" x="{x + 5:g}" y="{y - 6:g}">{_text(net.label)}</text>'
          for net, (x, y) in geometry.labels if net.label),
        *(line for name, block in geometry.nodes.items() for line in _node(picture.nodes[name], block)),
        *problems, "</svg>",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _count(picture: Picture) -> str:
    counts = [(sum(node.kind == kind for node in picture.nodes.values()), kind)
              for kind in (parts.COMPONENT, parts.PROGRAM, parts.TOPIC)]  # fmt: skip
    counts.append((len(picture.boxes), "host"))
    return ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for count, kind in counts if count)


def _host(block: Rectangle) -> Iterator[str]:
    yield f'<rect class="host" {_place(block)} rx="8"/>'
    yield f'<text class="hostname" x="{block.x + 10:g}" y="{block.y + 17:g}">{_text(block.texts[0])}</text>'


def _node(node: PictureNode, block: Rectangle) -> Iterator[str]:
    corner = block.height / 2 if node.kind == parts.TOPIC else {parts.PROGRAM: 2}.get(node.kind, 8)
    off = "" if node.enabled else ' class="off"'
    tooltip = "\n".join([*node.texts(), *(fault.text for fault in node.faults)])
    yield f"<g{off}><title>{_text(tooltip)}</title>"
    yield f'<rect class="node {node.kind}{_fault(node.faults)}" {_place(block)} rx="{corner:g}"/>'
    for number, line in enumerate(block.texts):
        style = "name" if number == 0 else "about"
        y = block.y + LINE_HEIGHT * (number + 1) + 3
        yield f'<text class="{style}" x="{block.middle:g}" y="{y:g}" text-anchor="middle">{_text(line)}</text>'
    yield "</g>"


def _way(way: EdgePath, colors: dict[str, int]) -> str:
    style = f"{_color(way.net, colors, 'c')}{_fault(way.branch.faults)}"
    title = f"{way.branch.source} {way.net.kind} {way.net.label or way.net.target}"
    title = "\n".join([title, *(fault.text for fault in way.branch.faults)])
    return f'<path class="line {style}" d="{_path(way.points)}"><title>{_text(title)}</title></path>'


def _tips(way: EdgePath, colors: dict[str, int]) -> Iterator[str]:
    """The head of the arrow: at the target; at the source if events flow from the target."""
    x, y = way.points[0] if way.net.kind == parts.SUBSCRIBES else way.points[-1]
    back = 7 if way.net.kind == parts.SUBSCRIBES else -7
    style = f"{_color(way.net, colors, 't')}{_fault(way.branch.faults)}"
    yield f'<path class="tip {style}" d="M{x:g} {y:g}l-3.5 {back}h7z"/>'


def _color(net: Net, colors: dict[str, int], prefix: str) -> str:
    if net.kind == parts.USES:
        return f"{prefix}{colors[net.target]}"
    return net.kind if prefix == "c" else f"t{net.kind}"


def _path(points: list[Point]) -> str:
    """The path with round corners; points on a straight line are omitted."""
    kept = [points[0]]
    for point, after in zip(points[1:], [*points[2:], None], strict=True):
        straight = after is not None and (kept[-1][0] == point[0] == after[0] or kept[-1][1] == point[1] == after[1])
        if point != kept[-1] and not straight:
            kept.append(point)
    made = [f"M{kept[0][0]:g} {kept[0][1]:g}"]
    for before, corner, after in zip(kept, kept[1:], kept[2:], strict=False):
        enter, leave = _towards(corner, before), _towards(corner, after)
        made.append(f"L{enter[0]:g} {enter[1]:g}Q{corner[0]:g} {corner[1]:g} {leave[0]:g} {leave[1]:g}")
    return "".join([*made, f"L{kept[-1][0]:g} {kept[-1][1]:g}"])


def _towards(corner: Point, other: Point) -> Point:
    """The point at which a round corner begins."""
    wide, high = other[0] - corner[0], other[1] - corner[1]
    length = abs(wide) + abs(high)
    share = min(_ROUND, length / 2) / length
    return corner[0] + wide * share, corner[1] + high * share


def _problems(picture: Picture, geometry: Geometry) -> Iterator[str]:
    room = max(geometry.width, 640.0) - 2 * _MARGIN
    for number, (owner, fault) in enumerate(picture.all_faults()):
        y = geometry.height + LINE_HEIGHT * (number + 1)
        text = f"{fault.code} {owner}: {fault.message}"
        style = "wrong" if fault.is_error else "warned"
        line = shortened(text, SMALL, room)
        position = f'x="{_MARGIN:g}" y="{y:g}"'
        yield f'<text class="problem {style}" {position}><title>{_text(text)}</title>{_text(line)}</text>'


def _fault(faults: tuple[PictureFault, ...]) -> str:
    return " wrong" if any(fault.is_error for fault in faults) else " warned" if faults else ""


def _place(block: Rectangle) -> str:
    return f'x="{block.x:g}" y="{block.y:g}" width="{block.width:g}" height="{block.height:g}"'


def _text(text: str) -> str:
    """A text, escaped for XML, without the characters that XML cannot contain."""
    return escape(IMPOSSIBLE.sub("", text.replace("\r", "")))
