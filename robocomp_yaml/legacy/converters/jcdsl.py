"""Convert JSON of a CDSL to a CDSL document."""

from __future__ import annotations

import json
from collections.abc import Iterator

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy.document import List, Map, Notes
from robocomp_yaml.legacy.draft import ComponentBuilder, ComponentDraft, ImportDraft, Reader, base_name
from robocomp_yaml.legacy.grammar import token, trees

_LISTS = {"implements": "implements", "requires": "requires", "publishes": "publishes", "subscribesto": "subscribes"}
Node = Tree[Token]


def convert(reader: Reader) -> ComponentDraft | None:
    tree = reader.tree
    top = trees(tree)
    if not top or top[0].data != "object":
        at = reader.source.span(0, 1)
        reader.diagnostics.append(codes.SYNTAX.at(at, problem="this is not a JSON object", hint=""))
        return None
    return _JcdslConverter(reader).document(top[0])


class _JcdslConverter(ComponentBuilder):
    def __init__(self, reader: Reader) -> None:
        super().__init__(reader)
        self.imports: list[ImportDraft] = []
        self.options: list[str] = []

    def document(self, top: Node) -> ComponentDraft | None:
        for key, name, value in _pairs(top):
            known = name.lower()
            if known in _LISTS:
                self.put_some(_LISTS[known], self.ports(value))
            elif known in ("name", "component"):
                self.put("component", self.text(value))
            elif known in _CLAUSES:
                _CLAUSES[known](self, value)
            elif known == "innermodelviewer" and _word(value) in ("true", "false", "null"):
                self.options += ["innermodelviewer"] if _word(value) == "true" else []
            else:
                self.keep_unknown(key, name, value)
        if self.options:
            self.put("options", List.of(dict.fromkeys(self.options)))
        named = self.entries.get("component")
        if named is None or not named.value:
            self.reader.report(codes.SYNTAX, top, problem='the component has no "name"', hint="")
            return None
        return self.draft(top, self.imports, Notes())

    def put_some(self, key: str, listed: List) -> None:
        if listed.items:
            self.put(key, listed)

    def text(self, node: Node) -> str:
        """Return a text; report another type."""
        if node.data == "text":
            return _text(node)
        self.reader.report(codes.SYNTAX, node, problem="expected a text", hint="")
        return ""

    def texts(self, node: Node) -> list[str]:
        """Return the texts of a node: one, or the items of an array."""
        return [self.text(item) for item in trees(node)] if node.data == "array" else [self.text(node)]

    def ports(self, node: Node) -> List:
        """Return a list of ports: names, or pairs of a name and its middleware. A second port of the same interface
        gets a number, as in CDSL."""
        listed, used = List(), set[str]()
        for item in trees(node) if node.data == "array" else [node]:
            parts = self.texts(item)
            interface = parts[0] if parts else ""
            if not interface:
                continue
            ros = item if len(parts) > 1 and parts[1].lower() == "ros" else None
            entry = self.reader.port(interface, used, (), ros)
            used.add(entry.entries[0].key if isinstance(entry, Map) else interface)
            listed.put(entry)
        return listed

    def import_(self, node: Node) -> None:
        listed = List()
        for item in trees(node) if node.data == "array" else [node]:
            path = self.text(item)
            if path and not any(known.stem == base_name(path) for known in self.imports):
                self.imports.append(ImportDraft(path, self.reader.span(item), listed.put(base_name(path))))
        self.put_some("imports", listed)

    def language(self, node: Node) -> None:
        name = node
        if node.data == "object":
            values = {name.lower(): value for _, name, value in _pairs(node)}
            for key, spelled, value in _pairs(node):
                if spelled.lower() != "name":
                    self.keep_unknown(key, f"language-{spelled}", value)
            if "name" not in values:
                return
            name = values["name"]
        self.put("language", self.reader.word("language", self.text(name), name))

    def gui(self, node: Node) -> None:
        if _word(node) == "null":
            return
        parts = [_text(value) for _, _, value in _pairs(node)] if node.data == "object" else self.texts(node)
        if parts and parts[0]:
            self.put("gui", self.reader.gui(parts, [node, node]))

    def option(self, node: Node) -> None:
        self.options += [text.lower() for text in self.texts(node) if text]

    def statemachine(self, node: Node) -> None:
        parts = self.texts(node) if _word(node) != "null" else []
        if parts and parts[0]:
            self.put_machine(parts[0], node)
            if "visual" in parts[1:]:
                self.put(self.reader.rules.keys["visual"], "true")

    def keep_unknown(self, key: Node, name: str, value: Node) -> None:
        """Keep an entry that CDSL documents do not have, as text, and report it."""
        kept = f"x-legacy-{name}"
        start, end = value.meta.start_pos, value.meta.end_pos
        self.put(kept, " ".join(self.reader.source.text[start:end].split()))
        self.reader.report(codes.NO_PLACE, key, what=name, key=kept)


_CLAUSES = {
    "imports": _JcdslConverter.import_,
    "language": _JcdslConverter.language,
    "gui": _JcdslConverter.gui,
    "options": _JcdslConverter.option,
    "statemachine": _JcdslConverter.statemachine,
}


def _pairs(node: Node) -> Iterator[tuple[Node, str, Node]]:
    for pair in trees(node, "pair"):
        key, value = trees(pair)
        yield key, _text(key), value


def _text(node: Node) -> str:
    literal = token(node, "STRING")
    if literal is None:
        return ""
    try:
        return str(json.loads(literal))
    except ValueError:  # an escape that is not JSON
        return literal[1:-1]


def _word(node: Node) -> str:
    word = token(node, "WORD") if node.data == "word" else None
    return str(word) if word is not None else ""
