"""The model as written, from the trees of PDSL and values documents, which have been validated."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.build_interface import doc, entries, items, span_of, text
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.parameters.specification.document import (
    KINDS,
    ConstraintSpec,
    LimitNodes,
    MemberSpec,
    ParameterDocument,
    TypeSpec,
    ValuesDocument,
)
from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling
from robocomp_yaml.semantics.spellings import placeholders
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, once


def build(root: Mapping, path: str) -> ParameterDocument:
    """The parameters of a document that is valid by `pdsl.schema.json`."""
    return ParameterDocument(
        path=path,
        component=text(root, "component"),
        types=tuple((key.lexeme, _spec(value, key)) for key, value in _named(root, "types")),
        parameters=tuple(once(_entry, key, value) for key, value in _named(root, "parameters")),
        rules=tuple(_rule(item) for item in items(root, "constraints")),
        legacy=tuple(_spelling(key, value) for key, value in _named(root, "legacy")),
        doc=doc(root),
        span=span_of(root, "parameters"),
        component_span=span_of(root, "component"),
    )


def build_values(root: Mapping, path: str) -> ValuesDocument:
    """The values document of a tree that is valid by `config.schema.json`."""
    extends = [
        Literal(node.lexeme, node.lexeme, span=node.span) for node in items(root, "extends") if isinstance(node, Scalar)
    ]
    after = root.get("legacy")
    first = after.get("after") if isinstance(after, Mapping) else None
    if isinstance(first, Scalar):  # the properties before it in the file are a layer
        extends.insert(0, Literal(first.lexeme, first.lexeme, span=first.span))
    return ValuesDocument(path, root, text(root, "component"), tuple(extends), span=span_of(root, "component"))


def _named(parent: Node | None, key: str) -> Iterator[tuple[Scalar, Node]]:
    return ((name, value) for name, value in entries(parent, key) if not name.lexeme.startswith("x-"))


def _entry(key: Scalar, node: Node) -> MemberSpec:
    if not isinstance(node, Mapping):
        return MemberSpec(key.lexeme, _spec(node, key), span=key.span)
    default = node.entries.get("default")
    secret = node.entries.get("secret")
    editable = node.data.get("editable")  # type: ignore[attr-defined]
    return MemberSpec(
        key.lexeme,
        _spec(node, key),
        default=default[1] if default else None,
        default_span=default[0].span if default else None,
        optional=node.data.get("optional") is True,  # type: ignore[attr-defined]
        editable=editable if isinstance(editable, bool) else None,
        secret=secret[0].span if secret is not None and secret[1].data is True else None,
        code_name=text(node, "as"),
        doc=doc(node),
        span=key.span,
    )


def _spec(node: Node, key: Scalar | None = None) -> TypeSpec:
    """A type in its short or long form."""
    if not isinstance(node, Mapping):
        assert isinstance(node, Scalar)
        return TypeSpec((("type", node.span),), node.lexeme, span=node.span, key_span=(key or node).span)
    kinds = tuple((kind, node.entries[kind][0].span) for kind in KINDS if node.get(kind) is not None)
    found = {kind: node.get(kind) for kind, _ in kinds[:1]}
    named, element = found.get("type"), found.get("list") or found.get("map")
    return TypeSpec(
        kinds,
        name=named.lexeme if isinstance(named, Scalar) else "",
        element=_spec(element) if element is not None else None,
        members=tuple(_entry(k, v) for k, v in _named(node, kinds[0][0]))
        if kinds and kinds[0][0] in ("group", "struct")
        else (),
        enumerators=tuple(_enumerators(found.get("enum"))),
        limits=LimitNodes(*(node.get(name) for name in ("range", "values", "pattern", "size", "unique", "unit"))),
        doc=doc(node),
        span=named.span if named is not None else key.span if key is not None else node.span,
        key_span=(key or node).span,
    )


def _enumerators(node: Node | None) -> Iterator[tuple[Literal, str]]:
    if isinstance(node, Sequence):
        for item in node.items:
            assert isinstance(item, Scalar)
            yield Literal(item.lexeme, item.lexeme, span=item.span), ""
    elif isinstance(node, Mapping):
        for name, value in node.items():
            if not name.lexeme.startswith("x-"):
                yield Literal(name.lexeme, name.lexeme, span=name.span), doc(value)


def _rule(node: Node) -> ConstraintSpec:
    if not isinstance(node, Mapping):
        return ConstraintSpec(node, span=node.span)
    that = node.get("that")
    assert that is not None
    return ConstraintSpec(that, text(node, "else"), doc(node), span=that.span)


def _spelling(key: Scalar, node: Node) -> LegacySpelling:
    if not isinstance(node, Mapping):
        assert isinstance(node, Scalar)
        return LegacySpelling(node.lexeme, path=key.lexeme, span=key.span)
    data = node.data
    assert isinstance(data, dict)
    fields = tuple((name.lexeme, value.lexeme) for name, value in entries(node, "fields") if isinstance(value, Scalar))
    return LegacySpelling(
        text(node, "key"),
        fields,
        int(data.get("first", 0)),
        tuple(item.lexeme for item in items(node, "columns") if isinstance(item, Scalar)),
        text(node, "separator", ","),
        tuple(item.lexeme for item in items(node, "separators") if isinstance(item, Scalar)),
        data.get("trailing") is True,
        text(node, "count"),
        path=key.lexeme,
        span=key.span,
        members=tuple(_members(node)),
    )


def _members(node: Mapping) -> Iterator[tuple[str, Span]]:
    """The members that a spelling names: in `columns`, as keys of `fields`, and in braces in `key`."""
    for item in items(node, "columns"):
        if isinstance(item, Scalar):
            yield item.lexeme, item.span
    for name, _ in entries(node, "fields"):
        yield name.lexeme, name.span
    key = node.get("key")
    if not isinstance(key, Scalar):
        return
    for word in placeholders(key.lexeme):
        if word != "i":  # the number of a row
            at = key.lexeme.index(f"{{{word}}}") + 1
            yield word, key.span.inside(key.lexeme, at, at + len(word))
