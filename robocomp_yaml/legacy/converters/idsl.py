"""Convert IDSL and Slice to an IDSL document."""

from __future__ import annotations

from collections.abc import Callable

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy import literals
from robocomp_yaml.legacy.document import TRUE, Doc, List, Map, Notes, ReferredName, Value
from robocomp_yaml.legacy.draft import ModuleDraft, ModuleNames, Reader, Reference, plain
from robocomp_yaml.legacy.grammar import token, trees
from robocomp_yaml.legacy.settings.headers import free

FEW = 4
"""A struct with more members is written in block style."""
SHORT = 100

SECTIONS = {
    "constant": "constants", "struct": "types", "enum": "types", "sequence": "types", "dictionary": "types",
    "exception": "exceptions", "interface": "interfaces",
}  # fmt: skip


def convert(reader: Reader) -> ModuleDraft | None:
    """Return the document of a file's module; None, with a diagnostic, where it has none."""
    tree = reader.tree
    modules = trees(tree, "module")
    if not modules:
        reader.diagnostics.append(codes.EMPTY.at(Span(reader.source.path), what="no module"))
        return None
    for extra in modules[1:]:
        reader.refused("refused_second_module", extra.children[0])
    return _IdslConverter(reader).document(tree, modules[0])


class _IdslConverter:
    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.names = ModuleNames("")
        self.seen: dict[str, Span] = {}

    def document(self, tree: Tree[Token], module: Tree[Token]) -> ModuleDraft:
        reader, notes = self.reader, self.reader.notes(module)
        self.names.name = reader.name(module)
        document = Map(block=True)
        document.put("module", self.names.name, Notes(notes.head, notes.tail))
        self._doc(document, module, self.names.name)
        listed, imports = reader.imports(trees(tree, "import", "include"))
        document.put_some("imports", listed)
        sections = {name: Map(block=True) for name in ("constants", "types", "exceptions", "interfaces")}
        for definition in trees(module, *SECTIONS):
            section = sections[SECTIONS[str(definition.data)]]
            self._define(definition, section)
        for name, section in sections.items():
            document.put_some(name, section)
        around = reader.placed.around
        around.foot[:0] = notes.foot
        return ModuleDraft(document, around, tuple(imports), self.names)

    def _define(self, tree: Tree[Token], section: Map) -> None:
        name = self.reader.name(tree)
        if self._is_new(self.seen, name, tree):
            self.names.defined.add(name)
            body = BODIES[str(tree.data)](self, tree, name)
            section.put(name, body, _foot_inside(self.reader.notes(tree), body))

    def _is_new(self, seen: dict[str, Span], name: str, tree: Tree[Token]) -> bool:
        """Whether a name is not used yet; report it otherwise."""
        at = token(tree, "NAME") or tree
        if name in seen:
            self.reader.report(codes.DUPLICATE, at, name=name, related=[Related("the first one is here", seen[name])])
            return False
        seen[name] = self.reader.span(at)
        return True

    def _doc(self, into: Map, tree: Tree[Token], *names: str) -> None:
        doc = self.reader.doc(tree, *names)
        into.put_some("doc", Doc(doc) if doc else None)

    def _type(self, tree: Tree[Token]) -> ReferredName:
        """Return a type as a document names it, and add it to the module's references."""
        qname = next((child for child in trees(tree) if child.data == "qname"), None)
        return self._name(qname) if qname is not None else ReferredName(str(tree.children[0]))

    def _name(self, qname: Tree[Token]) -> ReferredName:
        parts = [plain(child) for child in qname.children if isinstance(child, Token) and child.type == "NAME"]
        if len(parts) > 2:
            self.reader.refused("refused_scope", qname)
        module = parts[0] if len(parts) > 1 else ""
        written = ReferredName(".".join(parts))
        self.names.references.append(Reference(module, parts[-1], written, self.reader.span(qname)))
        return written

    def _literal(self, tree: Tree[Token]) -> Value:
        first = tree.children[0]
        return literals.name(first) if isinstance(first, Tree) else literals.value(first)

    def constant(self, tree: Tree[Token], name: str) -> Map:
        type_, value = trees(tree)
        body = Map()
        body.put("type", self._type(type_))
        body.put("value", self._literal(value))
        self._doc(body, tree, name)
        return body

    def struct(self, tree: Tree[Token], name: str) -> Map:
        body = Map(limit=SHORT)
        self._doc(body, tree, name, self.names.name)
        body.put("struct", self._members(trees(tree, "member"), {}))
        return body

    def exception(self, tree: Tree[Token], name: str) -> Map | None:
        body = self.struct(tree, name)
        if not trees(tree, "member"):
            body.entries.pop()
        return body if body.entries else None

    def _members(self, trees_: list[Tree[Token]], seen: dict[str, Span]) -> Map:
        members = Map(block=len(trees_) > FEW)
        for tree in trees_:
            name = self.reader.name(tree)
            if self._is_new(seen, name, tree):
                members.put(name, self._member(tree, name), self.reader.notes(tree))
        return members

    def _member(self, tree: Tree[Token], name: str) -> Value:
        """Return a member: only its type, unless it has a default or documentation."""
        parts = {str(part.data): part for part in trees(tree)}
        body = Map()
        body.put("type", self._type(parts["type"]))
        if "literal" in parts:
            body.put("default", self._literal(parts["literal"]))
        self._doc(body, tree, name)
        return body if len(body.entries) > 1 else body.entries[0].value

    def enum(self, tree: Tree[Token], name: str) -> Map:
        body, enumerators = Map(), trees(tree, "enumerator")
        self._doc(body, tree, name)
        docs = [self.reader.doc(item) for item in enumerators]
        plain_list = not any(docs) and not any(trees(item) for item in enumerators)
        listed: Map | List = List() if plain_list else Map()
        seen: dict[str, Span] = {}
        for item, doc in zip(enumerators, docs, strict=True):
            key, notes = self.reader.name(item), self.reader.notes(item)
            if not self._is_new(seen, key, item):
                continue
            if isinstance(listed, List):
                listed.put(key, notes)
                continue
            value = self._literal(trees(item)[0]) if trees(item) else None
            if doc:
                long = Map()
                long.put_some("value", value)
                long.put("doc", Doc(doc))
                value = long
            listed.put(key, value, notes)
        body.put("enum", listed)
        return body

    def sequence(self, tree: Tree[Token], name: str) -> Map:
        body = Map()
        self._doc(body, tree, name)
        body.put("sequence", self._type(trees(tree)[0]))
        return body

    def dictionary(self, tree: Tree[Token], name: str) -> Map:
        body, inner = Map(), Map()
        self._doc(body, tree, name)
        for key, part in zip(("key", "value"), trees(tree), strict=True):
            inner.put(key, self._type(part))
        body.put("map", inner)
        return body

    def interface(self, tree: Tree[Token], name: str) -> Map:
        body, methods = Map(block=True), Map(block=True)
        self._doc(body, tree, name, self.names.name)
        declared = trees(tree, "method")
        used_names = {self.reader.name(method).lower() for method in declared}
        used: set[str] = set()
        for method in declared:
            legacy = key = self.reader.name(method)
            if legacy in used:
                key = legacy + free(legacy.lower(), used_names)[len(legacy) :]
                used_names.add(key.lower())
                self.reader.report(codes.OVERLOAD, token(method, "NAME") or method, name=legacy, new=key)
            used.add(key)
            methods.put(key, self._method(method, legacy, key), self.reader.notes(method))
        body.put_some("methods", methods)
        return body

    def _method(self, tree: Tree[Token], legacy: str, key: str) -> Map | None:
        body, parameters = Map(), trees(tree, "parameter")
        self._doc(body, tree, legacy)
        if key != legacy:
            body.put("x-legacy-name", legacy)
        outs = [token(parameter, "OUT") is not None for parameter in parameters]
        if outs != sorted(outs):
            self.reader.repaired("lenient_order", token(tree, "NAME") or tree, legacy)
        seen: dict[str, Span] = {}
        for direction, is_out in (("in", False), ("out", True)):
            selected = [parameter for parameter, out in zip(parameters, outs, strict=True) if out is is_out]
            if selected:
                members = self._members(selected, seen)
                members.block = False
                body.put(direction, members)
        for returned in trees(tree, "type"):
            body.put("returns", self._type(returned))
        thrown = [self._name(qname) for throws in trees(tree, "throws") for qname in trees(throws)]
        body.put_some("throws", List.of(thrown))
        if token(tree, "IDEMPOTENT") is not None:
            body.put("idempotent", TRUE)
        return body if body.entries else None


def _foot_inside(notes: Notes, body: Value) -> Notes:
    """Return the comments of a definition, with those at the end of its block moved below the block's last entry."""
    inner = body.entries[-1] if notes.foot and isinstance(body, Map) and body.entries else None
    if inner is None or not isinstance(inner.value, (Map, List)):
        return notes
    inner.value.block = True
    inner.notes.foot += notes.foot
    return Notes(notes.head, notes.tail)


BODIES: dict[str, Callable[[_IdslConverter, Tree[Token], str], Value]] = {
    "constant": _IdslConverter.constant, "struct": _IdslConverter.struct, "enum": _IdslConverter.enum,
    "sequence": _IdslConverter.sequence, "dictionary": _IdslConverter.dictionary, "exception": _IdslConverter.exception,
    "interface": _IdslConverter.interface,
}  # fmt: skip
