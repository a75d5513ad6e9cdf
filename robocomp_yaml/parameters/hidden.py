"""Secret values, by types and names: found and hidden, for all output that people read."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from robocomp_yaml import secrets
from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.types import BasicType, EnumType, ListType, MapType, RecordType, Type, below, nested
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.references import is_sound
from robocomp_yaml.source.secret_nodes import named_nodes, plain_below
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence


def holds_secret(type_: Type) -> bool:
    """Whether a value of a type is secret or contains a secret."""
    return any(isinstance(each, (BasicType, EnumType)) and each.secret for each in nested(type_))


def secret_names(type_: Type) -> Iterator[str]:
    """The names of members with `secret: true`."""
    for record in nested(type_):
        if isinstance(record, RecordType):
            yield from (member.name for member in record.members if member.secret)


def secrets_of(linked: ResolvedParameters) -> tuple[str, ...]:
    """The names of the secret members of a component's parameters, sorted, each once."""
    return linked.once("secret names", lambda: tuple(sorted(set(secret_names(linked.parameters.root)))))


def hidden(type_: Type, data: Any) -> Any:
    """The data with its secrets hidden. Valid references stay, because they show the source of a value, not the
    value."""
    match type_:
        case BasicType() | EnumType():
            return plain(type_, data)
        case ListType(element=element) if isinstance(data, list):
            return [hidden(element, item) for item in data]
        case MapType(element=element) if isinstance(data, dict):
            named = {key: secrets.HIDDEN for key, item in data.items() if _is_named(key, item)}
            return {key: hidden(element, item) for key, item in data.items()} | named
        case RecordType() if isinstance(data, dict):
            members = type_.by_name
            return {key: hidden(members[key].type, item) if key in members else item for key, item in data.items()}
        case _:
            return data


def plain(type_: Type, data: Any) -> Any:
    """One plain value, hidden if it is secret. Passwords in URLs are always hidden."""
    if isinstance(type_, (BasicType, EnumType)) and type_.secret:
        return data if data is None or data == "" or is_sound(data) else secrets.HIDDEN
    return secrets.url(data) if isinstance(data, str) else data


def _is_named(key: str, data: Any) -> bool:
    """Whether an element of a map is secret by its own name."""
    return isinstance(data, str) and data != "" and secrets.is_secret(key)


def nodes(type_: Type, node: Node) -> Iterator[Scalar]:
    """Every secret plain value below a node. Where a node does not fit its type, only names decide."""
    match type_:
        case BasicType() | EnumType():
            if type_.secret and not is_sound(node.data):
                yield from plain_below(node)
        case ListType(element=element) if isinstance(node, Sequence):
            for item in node.items:
                yield from nodes(element, item)
        case MapType(element=element) if isinstance(node, Mapping):
            for key, value in node.items():
                named = secrets.is_secret(key.lexeme) and isinstance(value.data, str)
                yield from plain_below(value) if named else nodes(element, value)
        case RecordType() if isinstance(node, Mapping):
            for key, value in node.items():
                yield from _of_member(type_, key, value)
        case _:
            if not is_sound(node.data):
                yield from plain_below(node) if holds_secret(type_) else named_nodes(node)


def _of_member(record: RecordType, key: Scalar, value: Node) -> Iterator[Scalar]:
    """The secrets in an entry of a record. The key may be a path, as under `set:`."""
    steps = [key.lexeme] if record.member(key.lexeme) else paths.parse(key.lexeme) or [key.lexeme]
    type_: Type | None = record
    for step in steps:
        type_ = below(type_, 0 if isinstance(type_, ListType) else step)  # any step into a list counts as an index
    if type_ is not None and not (isinstance(value.data, str) and secrets.is_secret(steps[-1])):
        yield from nodes(type_, value)
    elif type_ is not None or secrets.is_secret(key.lexeme) or _is_close(record, key.lexeme):
        yield from plain_below(value)
    else:
        yield from named_nodes(value)


def _is_close(record: RecordType, name: str) -> bool:
    """Whether an unknown name is probably a misspelled name of a secret."""
    from difflib import get_close_matches  # rarely needed, slow to import

    known = [member.name.lower() for member in record.members if holds_secret(member.type)]
    return bool(known) and bool(get_close_matches(name.lower(), known, 1, 0.7))


def of_defaults(type_: Type) -> Iterator[Scalar]:
    """The secret values in the defaults of a record's members."""
    for member in type_.members if isinstance(type_, RecordType) else ():
        if member.default is not None and member.default.node is not None:
            yield from nodes(member.type, member.default.node)
        elif isinstance(member.type, RecordType) and member.is_group:
            yield from of_defaults(member.type)
