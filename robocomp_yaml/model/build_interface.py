"""Builds a `Module` from the tree of an IDSL document. The tree fits the schema. All builders share its helpers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeVar

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model import interface as model
from robocomp_yaml.model.located import Text
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, once

_Value = TypeVar("_Value")


def build(root: Mapping, path: str) -> model.Module:
    """Returns the module of a document that fits `idsl.schema.json`; `path` is the document as opened."""
    return model.Module(
        name=text(root, "module"),
        path=path,
        imports=imports(root),
        constants=tuple(_constant(key, value) for key, value in entries(root, "constants")),
        types=tuple(once(_type, key, value) for key, value in entries(root, "types")),
        exceptions=tuple(
            model.ExceptionType(key.lexeme, _members(value, "struct"), doc(value), span=key.span)
            for key, value in entries(root, "exceptions")
        ),
        interfaces=tuple(once(_interface, key, value, False) for key, value in entries(root, "interfaces")),
        topics=tuple(once(_interface, key, value, True) for key, value in entries(root, "topics")),
        doc=doc(root),
        span=span_of(root, "module"),
    )


# Helpers of the builders of every kind of document.


def entries(parent: Node | None, key: str) -> Iterator[tuple[Scalar, Node]]:
    """Keys and values of the mapping under `key`, without `x-…`; nothing if the mapping is missing or null."""
    child = parent.get(key) if parent else None
    if isinstance(child, Mapping):
        yield from (entry for name, entry in child.entries.items() if not name.startswith("x-"))


def items(parent: Node | None, key: str) -> list[Node]:
    child = parent.get(key) if parent else None
    return child.items if isinstance(child, Sequence) else []


def text(parent: Node | None, key: str, default: str = "") -> str:
    """The scalar under `key`, as spelled, or the default."""
    child = parent.get(key) if parent else None
    return child.lexeme if isinstance(child, Scalar) else default


def integer(parent: Node | None, key: str) -> int | None:
    """An integer. The schema also allows a float without a fraction, such as `3.0`."""
    child = parent.get(key) if parent else None
    return int(child.data) if isinstance(child, Scalar) and isinstance(child.data, (int, float)) else None


def given(parent: Node, key: str, make: Callable[[Node], _Value]) -> _Value | None:
    """What is made of the value of `key`; None if it is not set."""
    child = parent.get(key)
    return make(child) if child is not None else None


def doc(node: Node | None) -> str:
    return text(node, "doc").strip()


def span_of(parent: Node, key: str) -> Span:
    """The span of the value of `key`, or of the mapping if the key is missing."""
    child = parent.get(key)
    return (child or parent).span


def as_text(node: Node | None) -> Text | None:
    """The text of a scalar, with its span; None for any other node."""
    return Text(node.lexeme, span=node.span) if isinstance(node, Scalar) and node.data is not None else None


def texts(parent: Node | None, key: str) -> Iterator[Text]:
    """The scalars of the list under a key."""
    return filter(None, map(as_text, items(parent, key)))


def imports(root: Mapping) -> tuple[model.Import, ...]:
    return tuple(model.Import(name.text, span=name.span) for name in texts(root, "imports"))


def required(value: _Value | None) -> _Value:
    """A value that the schema requires."""
    assert value is not None
    return value


def type_ref(node: Node | None) -> model.TypeRef | None:
    """A type: the scalar itself, or `type` of a mapping."""
    if isinstance(node, Mapping):
        node = node.get("type")
    return model.TypeRef(node.lexeme, span=node.span) if isinstance(node, Scalar) and node.data is not None else None


def literal(node: Node | None) -> model.Literal | None:
    if not isinstance(node, Scalar) or node.data is None:
        return None
    return model.Literal(node.data, node.lexeme, span=node.span)  # type: ignore[arg-type]


def _constant(key: Scalar, node: Node) -> model.Constant:
    value = required(literal(node.get("value")))
    return model.Constant(key.lexeme, required(type_ref(node)), value, doc(node), text(node, "unit"), span=key.span)


def _member(key: Scalar, node: Node) -> model.Member:
    if isinstance(node, Scalar):  # the short form: its type alone
        return model.Member(key.lexeme, required(type_ref(node)), span=key.span)
    default = literal(node.get("default"))
    return model.Member(key.lexeme, required(type_ref(node)), doc(node), text(node, "unit"), default, span=key.span)


def _members(node: Node | None, key: str) -> tuple[model.Member, ...]:
    return tuple(_member(name, value) for name, value in entries(node, key))


def _struct(key: Scalar, node: Mapping) -> model.Struct:
    return model.Struct(
        key.lexeme, _members(node, "struct"), doc(node), span=key.span, list_span=_key_span(node, "struct")
    )


def _enum(key: Scalar, node: Mapping) -> model.Enum:
    listed = node.get("enum")
    enumerators: list[model.Enumerator] = []
    if isinstance(listed, Sequence):
        enumerators = [model.Enumerator(n.lexeme, span=n.span) for n in listed.items if isinstance(n, Scalar)]
    elif isinstance(listed, Mapping):
        for name, value in entries(node, "enum"):
            number = value.get("value") if isinstance(value, Mapping) else value
            given = number.data if number is not None else None
            whole = int(given) if isinstance(given, (int, float)) else None
            enumerators.append(model.Enumerator(name.lexeme, whole, doc(value), span=name.span))
    return model.Enum(key.lexeme, tuple(enumerators), doc(node), span=key.span, list_span=_key_span(node, "enum"))


def _key_span(parent: Mapping, key: str) -> Span:
    return parent.entries[key][0].span


def _sequence(key: Scalar, node: Mapping) -> model.Sequence:
    return model.Sequence(key.lexeme, required(type_ref(node.get("sequence"))), doc(node), span=key.span)


def _map(key: Scalar, node: Mapping) -> model.Map:
    inner = required(node.get("map"))
    key_type, value_type = required(type_ref(inner.get("key"))), required(type_ref(inner.get("value")))
    return model.Map(key.lexeme, key_type, value_type, doc(node), span=key.span)


TYPE_KINDS: dict[str, Callable[[Scalar, Mapping], model.TypeDefinition]] = {
    "struct": _struct, "enum": _enum, "sequence": _sequence, "map": _map,
}  # fmt: skip


def _type(key: Scalar, node: Node) -> model.TypeDefinition:
    assert isinstance(node, Mapping)
    kind = next(kind for kind in TYPE_KINDS if kind in node.entries)
    return TYPE_KINDS[kind](key, node)


def _interface(key: Scalar, node: Node, is_topic: bool) -> model.Interface:
    methods = tuple(_method(name, value) for name, value in entries(node, "methods"))
    return model.Interface(key.lexeme, methods, is_topic, doc(node), span=key.span)


def _method(key: Scalar, node: Node) -> model.Method:
    throws = (type_ref(item) for item in items(node, "throws"))
    returns = node.get("returns")
    return model.Method(
        key.lexeme,
        inputs=_members(node, "in"),
        outputs=_members(node, "out"),
        returns=type_ref(returns),
        throws=tuple(ref for ref in throws if ref is not None),
        idempotent=isinstance(node, Mapping) and node.data.get("idempotent") is True,  # type: ignore[attr-defined]
        doc=doc(node),
        returns_doc=doc(returns),
        returns_unit=text(returns, "unit"),
        span=key.span,
    )
