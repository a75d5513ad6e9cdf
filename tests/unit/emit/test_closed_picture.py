"""Pictures in which hosts and groups are closed."""

from __future__ import annotations

from robocomp_yaml.emit.graphs.closed import CLOSED, closed
from robocomp_yaml.emit.graphs.picture import AFTER, USES, Box, Picture, PictureFault, PictureLine, PictureNode
from robocomp_yaml.emit.graphs.screen import screen_geometry

FAULT = PictureFault("RC1", True, "wrong")


def picture() -> Picture:
    made = Picture("Robot", [Box("a", "a (10.0.0.1)"), Box("b", "b")])
    for name, host, groups in (("x", "a", ("g",)), ("y", "a", ("g", "h")), ("z", "a", ()), ("w", "b", ("g",))):
        made.nodes[name] = PictureNode(name, name, "component", host, groups=groups)
    made.lines = [
        PictureLine("z", "x", "I", USES), PictureLine("z", "y", "J", USES, (FAULT,)), PictureLine("x", "y", "I", USES),
        PictureLine("x", "z", "K", USES), PictureLine("z", "y", "", AFTER),
    ]  # fmt: skip
    return made


def test_a_closed_group_is_one_node_with_the_lines_of_its_members() -> None:
    seen, members = closed(picture(), {"group g"})
    assert members == {"group g@a": ["x", "y"], "group g@b": ["w"]}
    assert list(seen.nodes) == ["group g@a", "z", "group g@b"]
    node = seen.nodes["group g@a"]
    assert (node.title, node.kind, node.about[0]) == ("g", CLOSED, "2 processes")
    assert [(one.source, one.target, one.label, one.kind, one.faults) for one in seen.lines] == [
        ("z", "group g@a", "", USES, (FAULT,)), ("group g@a", "z", "K", USES, ()), ("z", "group g@a", "", AFTER, ()),
    ]  # fmt: skip
    assert len(screen_geometry(seen).lines) == 3


def test_a_closed_host_hides_its_groups_and_keeps_its_box() -> None:
    seen, members = closed(picture(), {"host a", "group g", "group nobody"})
    assert members == {"host a": ["x", "y", "z"], "group g@b": ["w"]}
    assert [(node.title, node.box, node.about[0]) for node in seen.nodes.values()] == [
        ("a (10.0.0.1)", "a", "3 processes"), ("g", "b", "1 process"),
    ]  # fmt: skip
    assert seen.lines == []
    assert set(screen_geometry(seen).hosts) == {"a", "b"}


def test_nothing_is_closed_without_a_box() -> None:
    made = picture()
    seen, members = closed(made, ())
    assert (seen.nodes, seen.lines, members) == (made.nodes, made.lines, {})
