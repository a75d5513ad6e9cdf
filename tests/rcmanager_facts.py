"""What RCManager's XML says, read by other means: nodes with their attributes, and the general part."""

from __future__ import annotations

from xml.etree import ElementTree

Element = tuple[str, tuple[tuple[str, str], ...]]
Facts = tuple[dict[str, tuple[tuple[tuple[str, str], ...], list[Element]]], list[object]]


def facts(text: str | bytes) -> Facts:
    """By alias the attributes and elements of each node; and all other elements, whatever is in them."""
    root = ElementTree.fromstring(text)
    nodes = {}
    for node in root.findall("node"):
        elements = sorted((child.tag, tuple(sorted(child.attrib.items()))) for child in node)
        assert all(len(child) == 0 for child in node)
        nodes[node.attrib["alias"]] = (tuple(sorted(node.attrib.items())), elements)
    return nodes, [_tree(child) for child in root if child.tag != "node"]


def _tree(element: ElementTree.Element) -> object:
    return element.tag, sorted(element.attrib.items()), [_tree(child) for child in element]
