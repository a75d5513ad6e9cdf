"""The PDSL that a component's configs imply."""

from __future__ import annotations

import re
from collections.abc import Sequence

from robocomp_yaml.legacy.document import Entry, List, Map, Notes, Raw, Value
from robocomp_yaml.legacy.settings.entries import STRING
from robocomp_yaml.legacy.settings.headers import free
from robocomp_yaml.legacy.settings.plan import Path, Plan, Spelled
from robocomp_yaml.legacy.settings.shapes import Field, ListOf, Record, Scalar, Shape, leaves
from robocomp_yaml.source.allowances import GUESSED

MARK = f"rcyaml: {GUESSED}"
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


def pdsl_document(component: str, plans: Sequence[Plan]) -> Map:
    return _Writer().document(component, plans)


class _Writer:
    def __init__(self) -> None:
        self.types = Map(block=True)
        self.known: dict[str, Record] = {}

    def document(self, component: str, plans: Sequence[Plan]) -> Map:
        document = Map(block=True)
        document.put("component", component)
        parameters = self.parameters([plan for plan in plans if not plan.built_in])
        if self.types.entries:
            document.put("types", self.types)
        document.put("parameters", parameters)
        legacy = Map(block=True)
        for plan in plans:
            if plan.spelled is not None:
                legacy.put(".".join(plan.path), _spelling(plan.spelled))
        if legacy.entries:
            document.put("legacy", legacy)
        return document

    def parameters(self, plans: Sequence[Plan]) -> Map:
        top = Map(block=True)
        groups: dict[Path, Map] = {(): top}
        siblings: dict[Path, set[str]] = {}
        for plan in plans:
            for depth in range(1, len(plan.path)):
                path = plan.path[:depth]
                if path not in groups:
                    groups[path] = Map(block=True)
                    body = Map([Entry("group", groups[path])])
                    self._code_name(body, path, siblings)
                    groups[path[:-1]].put(path[-1], body)
            body = Map()
            assert plan.shape is not None
            self.type(plan.shape, plan.path[-1], plan, body)
            if _is_sometimes_empty(plan):
                body.put("default", "")
            elif plan.optional:
                body.put("optional", Raw("true"))
            self._code_name(body, plan.path, siblings)
            short = body.entries[0].value if len(body.entries) == 1 and body.entries[0].key == "type" else body
            notes = Notes(tail=[MARK]) if plan.guessed else Notes()
            groups[plan.path[:-1]].put(plan.path[-1], short, notes)
        return top

    def _code_name(self, body: Map, path: Path, siblings: dict[Path, set[str]]) -> None:
        """`as:` where the name is no identifier, or another one's."""
        used = siblings.setdefault(path[:-1], set())
        name = re.sub(r"[^A-Za-z0-9_]", "_", path[-1])
        name = f"p{name}" if name[0].isdigit() else name
        own = free(name, used)
        used.add(own)
        if own != path[-1]:
            body.put("as", own)

    def type(self, shape: Shape, name: str, plan: Plan, body: Map) -> None:
        if isinstance(shape, ListOf):
            body.put("list", self.element(shape.element, name, plan))
        else:
            body.put("type", self.element(shape, name, plan))

    def element(self, shape: Shape, name: str, plan: Plan) -> Value:
        if isinstance(shape, Scalar):
            return shape.kind
        if isinstance(shape, ListOf):
            return Map([Entry("list", self.element(shape.element, name, plan))])
        return self.struct(shape, name, plan)

    def struct(self, shape: Record, name: str, plan: Plan) -> str:
        own = "".join(part[:1].upper() + part[1:] for part in re.split(r"[^A-Za-z0-9]+", name) if part) or "Record"
        own = own if _IDENTIFIER.match(own) else f"T{own}"
        title = next((known for known, record in self.known.items() if record == shape and known == own), "")
        if title:
            return title
        title = free(own, self.known)
        self.known[title] = shape
        docs = {column.name: column.doc for column in plan.docs}
        members, used = Map(block=True), dict[Path, set[str]]()
        for field in shape.fields:
            members.put(field.name, self.member(field, plan, docs.get(field.name, ""), used))
        self.types.put(title, Map([Entry("struct", members)]))
        return title

    def member(self, field: Field, plan: Plan, doc: str, used: dict[Path, set[str]]) -> Value:
        body = Map()
        self.type(field.shape, field.name, plan, body)
        if field.optional:
            body.put("optional", Raw("true"))
        if doc:
            body.put("doc", doc)
        self._code_name(body, (field.name,), used)
        return body.entries[0].value if len(body.entries) == 1 and body.entries[0].key == "type" else body


def _is_sometimes_empty(plan: Plan) -> bool:
    """An optional text that is empty somewhere: without a default it would read as left out."""
    texts = [leaf for given in plan.given.values() for leaf in leaves(given.item.value)]
    return plan.optional and plan.shape == Scalar(STRING) and any(not leaf.text for leaf in texts if leaf)


def _spelling(spelled: Spelled) -> Value:
    if not (spelled.columns or spelled.separators or spelled.fields or spelled.first or "{i}" in spelled.key):
        return spelled.key
    body = Map()
    if spelled.fields:
        body.put("fields", Map([Entry(name, key) for name, key in spelled.fields.items()]))
    else:
        body.put("key", spelled.key)
    if spelled.first:
        body.put("first", Raw(str(spelled.first)))
    if spelled.columns:
        body.put("columns", _texts(spelled.columns))
        if spelled.separator != ",":
            body.put("separator", spelled.separator)
    if spelled.separators:
        body.put("separators", _texts(spelled.separators))
        if spelled.trailing:
            body.put("trailing", Raw("true"))
    return body


def _texts(texts: Sequence[str]) -> List:
    listed = List()
    for text in texts:
        listed.put(text)
    return listed
