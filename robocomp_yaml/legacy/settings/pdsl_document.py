"""Write the PDSL that a component's configs imply."""

from __future__ import annotations

import re
from collections.abc import Sequence

from robocomp_yaml.legacy.document import TRUE, List, Map, Notes, Raw, Value
from robocomp_yaml.legacy.settings.entries import STRING
from robocomp_yaml.legacy.settings.headers import free
from robocomp_yaml.legacy.settings.plan import ParameterPlan, Path
from robocomp_yaml.legacy.settings.shapes import ListShape, MemberShape, RecordShape, ScalarShape, Shape, leaves
from robocomp_yaml.semantics.spellings import Spelling
from robocomp_yaml.source.allowances import GUESSED

MARK = f"rcyaml: {GUESSED}"
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


def pdsl_document(component: str, plans: Sequence[ParameterPlan]) -> Map:
    """Return the PDSL of a component with the parameters of these plans."""
    return _PdslWriter().document(component, plans)


class _PdslWriter:
    def __init__(self) -> None:
        self.types = Map(block=True)
        self.known: dict[str, RecordShape] = {}

    def document(self, component: str, plans: Sequence[ParameterPlan]) -> Map:
        document = Map(block=True)
        document.put("component", component)
        parameters = self.parameters([plan for plan in plans if not plan.built_in])
        document.put_some("types", self.types)
        document.put("parameters", parameters)
        legacy = Map(block=True)
        for plan in plans:
            if plan.spelled is not None:
                legacy.put(".".join(plan.path), _spelling(plan.spelled))
        document.put_some("legacy", legacy)
        return document

    def parameters(self, plans: Sequence[ParameterPlan]) -> Map:
        top = Map(block=True)
        groups: dict[Path, Map] = {(): top}
        siblings: dict[Path, set[str]] = {}
        for plan in plans:
            for depth in range(1, len(plan.path)):
                path = plan.path[:depth]
                if path not in groups:
                    groups[path] = Map(block=True)
                    body = Map.of({"group": groups[path]})
                    self._code_name(body, path, siblings)
                    groups[path[:-1]].put(path[-1], body)
            body = Map()
            assert plan.shape is not None
            self.type(plan.shape, plan.path[-1], plan, body)
            if _is_sometimes_empty(plan):
                body.put("default", "")
            elif plan.optional:
                body.put("optional", TRUE)
            self._code_name(body, plan.path, siblings)
            short = body.entries[0].value if len(body.entries) == 1 and body.entries[0].key == "type" else body
            notes = Notes(tail=[MARK]) if plan.guessed else Notes()
            groups[plan.path[:-1]].put(plan.path[-1], short, notes)
        return top

    def _code_name(self, body: Map, path: Path, siblings: dict[Path, set[str]]) -> None:
        """Add `as:` where a name is not an identifier, or is used already."""
        used = siblings.setdefault(path[:-1], set())
        name = re.sub(r"[^A-Za-z0-9_]", "_", path[-1])
        name = f"p{name}" if name[0].isdigit() else name
        own = free(name, used)
        used.add(own)
        if own != path[-1]:
            body.put("as", own)

    def type(self, shape: Shape, name: str, plan: ParameterPlan, body: Map) -> None:
        key, element = ("list", shape.element) if isinstance(shape, ListShape) else ("type", shape)
        body.put(key, self.element(element, name, plan))

    def element(self, shape: Shape, name: str, plan: ParameterPlan) -> Value:
        if isinstance(shape, ScalarShape):
            return shape.kind
        if isinstance(shape, ListShape):
            return Map.of({"list": self.element(shape.element, name, plan)})
        return self.struct(shape, name, plan)

    def struct(self, shape: RecordShape, name: str, plan: ParameterPlan) -> str:
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
        self.types.put(title, Map.of({"struct": members}))
        return title

    def member(self, field: MemberShape, plan: ParameterPlan, doc: str, used: dict[Path, set[str]]) -> Value:
        body = Map()
        self.type(field.shape, field.name, plan, body)
        if field.optional:
            body.put("optional", TRUE)
        body.put_some("doc", doc)
        self._code_name(body, (field.name,), used)
        return body.entries[0].value if len(body.entries) == 1 and body.entries[0].key == "type" else body


def _is_sometimes_empty(plan: ParameterPlan) -> bool:
    """Whether an optional text is empty in a config. It needs a default, because an empty property means a missing
    one."""
    texts = [leaf for value in plan.values.values() for leaf in leaves(value.item.value)]
    return plan.optional and plan.shape == ScalarShape(STRING) and any(not leaf.text for leaf in texts)


def _spelling(spelled: Spelling) -> Value:
    if not (spelled.columns or spelled.separators or spelled.fields or spelled.first or "{i}" in spelled.key):
        return spelled.key
    body = Map()
    body.put_some("fields", Map.of(dict(spelled.fields)))
    body.put_some("key", "" if spelled.fields else spelled.key)
    body.put_some("first", Raw(str(spelled.first)) if spelled.first else None)
    body.put_some("columns", List.of(spelled.columns))
    body.put_some("separator", spelled.separator if spelled.columns and spelled.separator != "," else "")
    body.put_some("separators", List.of(spelled.separators))
    body.put_some("trailing", TRUE if spelled.separators and spelled.trailing else None)
    return body
