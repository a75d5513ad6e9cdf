"""Convert CDSL to a CDSL document."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Related
from robocomp_yaml.legacy.document import Doc, List, Map, Notes, Value
from robocomp_yaml.legacy.draft import ComponentBuilder, ComponentDraft, Reader
from robocomp_yaml.legacy.grammar import token, trees, words
from robocomp_yaml.source import regular

LISTS = ("implements", "requires", "publishes", "subscribesto")


def convert(reader: Reader) -> ComponentDraft | None:
    """Return the document of a file's component."""
    tree = reader.tree
    return _CdslConverter(reader).document(tree, trees(tree, "component")[0])


class _CdslConverter(ComponentBuilder):
    def __init__(self, reader: Reader) -> None:
        super().__init__(reader)
        self.seen: dict[str, Tree[Token]] = {}

    def document(self, tree: Tree[Token], component: Tree[Token]) -> ComponentDraft:
        reader, notes = self.reader, self.reader.notes(component)
        name = reader.name(component)
        self.put("component", name, Notes(notes.head, notes.tail))
        doc = reader.doc(component, name)
        if doc:
            self.put("doc", Doc(doc))
        listed, imports = reader.imports(trees(tree, "import"))
        if listed.items:
            self.put("imports", listed)
        for clause in trees(component):
            if clause.data == "communications":
                self._once(clause)
                self._communications(clause)
            elif clause.data in CLAUSES:
                self._once(clause)
                CLAUSES[str(clause.data)](self, clause)
        if self._has_code_of_robocomp():
            self.put("compatibility", "robocomp")
        around = reader.placed.around
        rest = [words(node) for node in trees(tree, "lenient_rest")]
        around.foot[:0] = [*notes.foot, *rest]
        return self.draft(token(component, "NAME") or component, imports, around)

    def _has_code_of_robocomp(self) -> bool:
        """Whether the user's code was written for RoboComp's own generator."""
        return any(re.search(pattern, self._code(name)) for name, pattern in self.reader.rules.code.items())

    def _code_names(self, pattern: str) -> bool:
        """Whether a pattern occurs in the user's code, or in the generic part that RoboComp's tool left."""
        return any(re.search(pattern, self._code(name)) for name in (*self.reader.rules.code, "src/genericworker.h"))

    def _code(self, name: str) -> str:
        return regular.text(os.path.join(os.path.dirname(self.reader.source.path), name)) or ""

    def _once(self, clause: Tree[Token]) -> None:
        """Report a clause that occurs twice, because it is unknown which one is meant."""
        name = str(clause.data)
        if name in self.seen:
            first = Related("the first one is here", self.reader.span(self.seen[name]))
            self.reader.report(codes.DUPLICATE, clause, name=self._keyword(clause), related=[first])
        self.seen.setdefault(name, clause)

    def _keyword(self, clause: Tree[Token]) -> str:
        """Return a clause's first word, as the file spells it."""
        return self.reader.source.text[clause.meta.start_pos : clause.meta.end_pos].split("{")[0].split()[0]

    def _key(self, clause: Tree[Token]) -> str:
        return self.reader.rules.keys[str(clause.data)]

    def _communications(self, clause: Tree[Token]) -> None:
        """Convert the lists of the block. Its own comments are written above the first and below the last list."""
        notes, listed = self.reader.notes(clause), trees(clause, *LISTS)
        for communication in listed:
            self._interfaces(communication)
        if listed:
            self.entries[self._key(listed[0])].notes.head[:0] = [*notes.head, *notes.tail]
            last = self.entries[self._key(listed[-1])]
            assert isinstance(last.value, List)
            last.value.block = last.value.block or bool(notes.foot)
            last.notes.foot += notes.foot
        else:
            self.reader.placed.around.foot += [*notes.head, *notes.tail, *notes.foot]

    def _interfaces(self, clause: Tree[Token]) -> None:
        """Convert a list with its order and repetitions: a second port of the same interface gets a new name."""
        key, notes = self._key(clause), self.reader.notes(clause)
        known = self.entries.get(key)
        if known is None:
            known = self.put(key, List(), notes)
        else:
            known.notes.add(notes)
        assert isinstance(known.value, List)
        same = [item for other in self.reader.tree.find_data(str(clause.data)) for item in trees(other, "interface")]
        declared = Counter(self.reader.name(item) for item in same)
        for item in trees(clause, "interface"):
            known.value.put(self._port(item, known.value, declared), self.reader.notes(item))

    def _port(self, item: Tree[Token], listed: List, declared: Counter[str]) -> Value:
        used = {entry.value.entries[0].key if isinstance(entry.value, Map) else entry.value for entry in listed.items}
        middleware = token(item, "MIDDLEWARE")
        ros = item if middleware is not None and middleware.lower() == "ros" else None
        name = self.reader.name(item)
        # The oldest tool counted the proxies of one interface from 0, in the code and in the configuration.
        from_0 = declared[name] > 1 and self._code_names(rf"\b{name.lower()}0_proxy\b")
        return self.reader.port(name, {str(name) for name in used}, declared, ros, from_0=from_0)

    def language(self, clause: Tree[Token]) -> None:
        word = token(clause, "WORD")
        assert word is not None
        self.put("language", self.reader.word("language", str(word), word), self.reader.notes(clause))

    def gui(self, clause: Tree[Token]) -> None:
        names = [child for child in clause.children if isinstance(child, Token)]
        body = self.reader.gui([str(name) for name in names], [*names])
        self.put("gui", body, self.reader.notes(clause))

    def options(self, clause: Tree[Token]) -> None:
        listed = List()
        for option in trees(clause, "option"):
            name = self.reader.name(option).lower()
            listed.put(name, self.reader.notes(option))
            self.add_option(name, option)
        self.put("options", listed, self.reader.notes(clause))

    def statemachine(self, clause: Tree[Token]) -> None:
        literal = token(clause, "STRING")
        assert literal is not None
        self.put_machine(literal[1:-1].strip(), literal, self.reader.notes(clause))
        if token(clause, "VISUAL") is not None:
            self._keep_unknown(clause, "visual", "true")

    def obsolete(self, clause: Tree[Token]) -> None:
        self._keep_unknown(clause, str(clause.data), self.reader.name(clause))

    def _keep_unknown(self, clause: Tree[Token], name: str, value: str) -> None:
        key = self.reader.rules.keys[name]
        self.put(key, value, self.reader.notes(clause) if name != "visual" else None)
        self.reader.report(codes.NO_PLACE, clause, what=words(clause), key=key)

    def sources(self, clause: Tree[Token]) -> None:
        """Convert sources: paths are files of the user's repository, words are folders of shared classes."""
        self._uses(clause, lambda item, text: ("sources", text.lstrip("/")) if token(item, "STRING") else (
            "classes", text
        ))  # fmt: skip

    def libraries(self, clause: Tree[Token]) -> None:
        self._uses(clause, lambda item, text: ("libraries", Map.of({"link": text})))

    def _uses(self, clause: Tree[Token], convert_item: Callable[[Tree[Token], str], tuple[str, Value]]) -> None:
        """Add the entries of a block to `uses:`, with the comments of the block."""
        uses = self.entries.get("uses") or self.put("uses", Map(block=True))
        assert isinstance(uses.value, Map)
        by_key = {entry.key: entry for entry in uses.value.entries}
        entry = None
        for item in trees(clause, "item"):
            key, value = convert_item(item, str(item.children[0]).strip('"'))
            entry = by_key.get(key) or by_key.setdefault(key, uses.value.put(key, List()))
            assert isinstance(entry.value, List)
            entry.value.put(value, self.reader.notes(item))
        notes = self.reader.notes(clause)
        if entry is not None:
            uses.notes.head += notes.head
            entry.notes.tail += notes.tail
            entry.notes.foot += notes.foot
        else:  # the block has only comments
            self.reader.placed.around.foot += [*notes.head, *notes.tail, *notes.foot]
        if not uses.value.entries:
            del self.entries["uses"]


CLAUSES: dict[str, Callable[[_CdslConverter, Tree[Token]], None]] = {
    "language": _CdslConverter.language, "gui": _CdslConverter.gui, "options": _CdslConverter.options,
    "statemachine": _CdslConverter.statemachine, "useqt": _CdslConverter.obsolete, "worker": _CdslConverter.obsolete,
    "robocompclasses": _CdslConverter.sources, "robocompmodules": _CdslConverter.libraries,
}  # fmt: skip
