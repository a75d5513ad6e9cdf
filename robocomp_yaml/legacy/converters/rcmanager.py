"""Convert RCManager's XML to a network, which becomes a deployment when the run's components are known."""

from __future__ import annotations

import re

import msgspec
from lark import Token, Tree

from robocomp_yaml.emit.exports.rcmanager import ATTRIBUTES, GENERAL
from robocomp_yaml.legacy.document import DocumentEntry, List, Map, Notes, Raw, Value
from robocomp_yaml.legacy.draft import DeploymentDraft, Reader, named_node
from robocomp_yaml.legacy.grammar import token, trees
from robocomp_yaml.legacy.networks import endpoint
from robocomp_yaml.legacy.networks.node import NetworkDraft, NetworkNode
from robocomp_yaml.source import rcremote

_ENTITIES = {"lt": "<", "gt": ">", "amp": "&", "quot": '"', "apos": "'"}
_ENTITY = re.compile(r"&(?:#x(?P<hex>[0-9a-fA-F]+);|#(?P<decimal>[0-9]+);|(?P<name>\w+);)?")
_SSH = re.compile(r"ssh\s+(?P<user>[\w.-]+)@(?P<host>\S+)")


class _Element(msgspec.Struct, eq=False):
    name: str
    tree: Tree[Token]
    notes: Notes
    attributes: dict[str, str] = {}
    locations: dict[str, Token] = {}
    children: list[_Element] = []

    def get(self, name: str) -> str:
        return self.attributes.get(name, "")

    def location_of(self, name: str) -> Token | Tree[Token]:
        return self.locations.get(name, self.tree)


def convert(reader: Reader) -> DeploymentDraft | None:
    tree = reader.tree
    if trees(tree, "refused_doctype"):
        return None
    return _RcmanagerConverter(reader).draft(trees(tree, "element")[0])


class _RcmanagerConverter:
    def __init__(self, reader: Reader) -> None:
        self.reader = reader

    def draft(self, tree: Tree[Token]) -> DeploymentDraft:
        root = self.element(tree)
        network = NetworkDraft(notes=root.notes)
        if root.name != "rcmanager":
            self.reader.refused("root", token(tree, "OPEN") or tree, root.name)
        for child in root.children:
            if child.name == "node":
                self.node(child, network)
            else:
                network.extra.entries.append(DocumentEntry(child.name, self.generic(child), child.notes))
        if _texts(network.extra) == {"generalInformation": GENERAL}:
            network.extra.entries.clear()  # as it is exported without
        for name, value in root.attributes.items():
            network.extra.put(name, exact(value))
        return DeploymentDraft(network, self.reader.placed.around)

    def element(self, tree: Tree[Token]) -> _Element:
        """Return an element with its content; report what the grammar does not check."""
        begin, end = token(tree, "OPEN"), token(tree, "CLOSE")
        assert begin is not None
        result = _Element(begin[1:], tree, self.reader.notes(tree))
        if end is not None and end[2:-1].strip() != result.name:
            self.reader.refused("mismatch", end, str(end), open=result.name)
        for attribute in trees(tree, "attribute"):
            name, value = token(attribute, "WORD"), token(attribute, "VALUE")
            assert name is not None and value is not None
            if name in result.attributes:
                self.reader.refused("attribute_twice", name, name)
            result.attributes[str(name)] = self.text(value)
            result.locations[str(name)] = value
        result.children = [self.element(child) for child in trees(tree, "element")]
        return result

    def text(self, value: Token) -> str:
        """Return an attribute's value with its entities resolved, and white space replaced by blanks, as in XML."""

        def character(match: re.Match[str]) -> str:
            if match["name"] in _ENTITIES:
                return _ENTITIES[match["name"]]
            if match["hex"] or match["decimal"]:
                number = int(match["hex"], 16) if match["hex"] else int(match["decimal"])
                if 0x20 <= number < 0xD800 or 0xE000 <= number < 0x110000 or number in (9, 10, 13):
                    return chr(number)
            if match["name"] or match["hex"] or match["decimal"]:
                self.reader.refused("entity", value, match[0])
                return "x"
            self.reader.repaired("ampersand", value)
            return match[0]

        return _ENTITY.sub(character, re.sub(r"[\t\n\r]", " ", value[1:-1]))

    def node(self, element: _Element, network: NetworkDraft) -> None:
        alias = element.get("alias")
        node = named_node(self.reader, network, alias, element.location_of("alias"), element.notes, element.tree)
        if node.name != alias:
            node.extra.put("alias", exact(alias))
        node.endpoint_span = self.reader.span(element.location_of("endpoint"))
        node.endpoint = endpoint.parse(element.get("endpoint"))
        if "endpoint" in element.attributes:
            node.extra.put("endpoint", exact(element.get("endpoint")))
        if node.endpoint is not None and not node.endpoint.is_storm:
            node.interface = node.endpoint.identity
        for name, value in element.attributes.items():
            if name not in ("alias", "endpoint"):
                node.extra.put(name, exact(value))
        self.children(element, node, network)

    def children(self, element: _Element, node: NetworkNode, network: NetworkDraft) -> None:
        by_name: dict[str, _Element] = {}
        for child in element.children:
            if child.name == "dependence":
                alias = child.get("alias")
                if any(alias == known for known, _, _ in node.after):
                    self.reader.repaired("twice", child.tree, f"dependence {alias}")
                    continue
                node.after.append((alias, self.reader.span(child.location_of("alias")), child.notes))
                continue
            if child.name in by_name:
                self.reader.lost("overridden", by_name[child.name].tree, child.name)
                node.extra.entries = [entry for entry in node.extra.entries if entry.key != child.name]
            by_name[child.name] = child
            node.extra.entries.append(self.extra(child))
        _place(node.extra)
        folder = by_name["workingDir"].get("path") if "workingDir" in by_name else ""
        if "upCommand" in by_name:
            node.command = rcremote.parse(by_name["upCommand"].get("command"), folder)
        if "downCommand" in by_name and (user := _SSH.search(by_name["downCommand"].get("command"))):
            network.users.setdefault(user["host"], user["user"])

    def extra(self, child: _Element) -> DocumentEntry:
        """Return an element as RCManager's exporter reads it: a single value, if it has only that."""
        simple = ATTRIBUTES.get(child.name)
        if simple is not None and list(child.attributes) == [simple] and not child.children:
            return DocumentEntry(child.name, exact(child.get(simple)), child.notes)
        return DocumentEntry(child.name, self.generic(child), child.notes)

    def generic(self, element: _Element) -> Map:
        """Return any element: its attributes, and its elements by name; several of one name are a list."""
        result = Map()
        for name, value in element.attributes.items():
            result.put(name, exact(value))
        for name in dict.fromkeys(child.name for child in element.children):
            same = [child for child in element.children if child.name == name]
            if name in element.attributes:
                self.reader.refused("collision", same[0].tree, name)
            elif len(same) == 1:
                result.entries.append(DocumentEntry(name, self.generic(same[0]), same[0].notes))
            else:
                result.put(name, List([DocumentEntry("", self.generic(child), child.notes) for child in same]))
        return result


def _texts(value: Value) -> object:
    """Return the texts of attributes, None where there is something else: a comment."""
    if isinstance(value, Map):
        return {entry.key: None if entry.notes else _texts(entry.value) for entry in value.entries}
    return value.lexeme if isinstance(value, Raw) else value if isinstance(value, str) else None


def _place(extra: Map) -> None:
    """Put a position in one entry, as it is in RCManager's graph."""
    places = [entry for entry in extra.entries if entry.key in ("xpos", "ypos")]
    if len(places) == 2 and not any(one.notes or isinstance(one.value, Map) for one in places):
        places.sort(key=lambda one: one.key)
        extra.entries[extra.entries.index(places[0])] = DocumentEntry("at", List.of(one.value for one in places))
        extra.entries.remove(places[1])


_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]{0,15})(?:\.[0-9]{1,17})?")


def exact(text: str) -> str | Raw:
    """Return a plain number as a number, everything else as text."""
    return Raw(text) if _NUMBER.fullmatch(text) else text
