"""Effective values as TOML, nested as RoboComp components with ConfigLoader read them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.parameters.layers.effective import Effective
from robocomp_yaml.parameters.layers.merge import Origin, node_of, step
from robocomp_yaml.parameters.spelling import references
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    Type,
    leaves,
)
from robocomp_yaml.parameters.writing.properties import legacy_file, properties
from robocomp_yaml.parameters.writing.sections import CLASSIC, Section, dialect
from robocomp_yaml.semantics import connections
from robocomp_yaml.semantics.spellings import placeholders
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.tree import Scalar
from robocomp_yaml.source.yaml_text import quoted

_NUMBER = re.compile(r"[-+]?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?\Z")
_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
Table = dict[str, Any]


def toml_text(values: LayeredValues, effective: Effective) -> str:
    """The text of a TOML file, with a table for the first part of each key. Keys under `Ice` stay dotted."""
    table: Table = {}
    sections = properties(values, effective, quoted=True)[0]
    connections = [section for section in sections if section.title != "Parameters"]
    others = _connections(connections, dialect(values) != CLASSIC)
    for key, literal in [*others, *_parameters(effective, bool(legacy_file(values)))]:
        _put(table, key, literal)
    top = {key: value for key, value in table.items() if not isinstance(value, dict)}
    blocks = ["".join(f"{_key(key)} = {value}\n" for key, value in top.items())] if top else []
    for name, inner in table.items():
        if isinstance(inner, dict):
            blocks += _tables(inner, _key(name), dotted=name == "Ice")
    return "\n".join(blocks)


def _connections(sections: list[Section], unquotes: bool) -> Iterator[tuple[list[str], str]]:
    """`unquotes`: quotes around a text belong to its file, and are not part of the text."""
    for section in sections:
        for made in section.properties:
            name, _, tail = made.key.rpartition(".")
            key = made.key
            if tail == "Endpoints" and name:
                key = connections.endpoints(name)[1]
            elif key == connections.MANAGER[0]:
                key = connections.MANAGER[1]
            elif key.endswith("Proxy") and "." not in key and key != "Proxy":
                key = connections.proxy(key.removesuffix("Proxy"))[1]
            is_bare = made.value in ("true", "false") or _NUMBER.match(made.value)
            plain = unquoted(made.value) if unquotes or made.read is not None else made.value
            yield key.split(".", 1), made.value if is_bare else quoted(plain)


def _parameters(effective: Effective, only_set: bool) -> Iterator[tuple[list[str], str]]:
    """`only_set`: defaults are omitted, so that a migrated document is written as its legacy file."""
    for path, member in leaves(effective.parameters.root):
        data: Any = effective.data
        where: Origin = effective.merged
        for name in path.split("."):
            data = data.get(name) if isinstance(data, dict) else None
            where = step(where, name) if where is not None else None
        if data is None or (only_set and where is None):
            continue
        spelling = effective.parameters.spelling(path)
        is_plain = spelling is not None and bool(spelling.key) and not placeholders(spelling.key)
        key = spelling.key if spelling is not None and is_plain else path
        yield key.split("."), _literal(member.type, data, where or (member.default.node if member.default else None))


def _put(table: Table, key: list[str], literal: str) -> None:
    for part in key[:-1]:
        inner = table.setdefault(part, {})
        if not isinstance(inner, dict):
            _put(table, [".".join(key)], literal)
            return
        table = inner
    table[key[-1]] = literal


def _tables(table: Table, name: str, *, dotted: bool) -> Iterator[str]:
    plain = {key: value for key, value in table.items() if not isinstance(value, dict)}
    lines = "".join(f"{key if dotted else _key(key)} = {value}\n" for key, value in plain.items())
    if lines or not table:
        yield f"[{name}]\n{lines}"
    for key, inner in table.items():
        if isinstance(inner, dict):
            yield from _tables(inner, f"{name}.{_key(key)}", dotted=dotted)


def _key(key: str) -> str:
    return key if _BARE.match(key) else quoted(key)


def _literal(type_: Type, data: Any, where: Origin) -> str:
    match type_:
        case RecordType():
            types = {member.name: member.type for member in type_.members if member.name in data}
            return _inline({name: _literal(each, data[name], step(where, name)) for name, each in types.items()})
        case ListType(element=element):
            return "[" + ", ".join(_literal(element, item, step(where, n)) for n, item in enumerate(data)) + "]"
        case MapType(element=element):
            return _inline({name: _literal(element, item, step(where, name)) for name, item in data.items()})
        case BasicType() | EnumType():
            return _scalar(type_, data, where)


def _inline(literals: Mapping[str, str]) -> str:
    """An inline table."""
    return "{" + ", ".join(f"{_key(name)} = {literal}" for name, literal in literals.items()) + "}"


def _scalar(type_: BasicType | EnumType, data: Any, where: Origin) -> str:
    if isinstance(data, dict):
        return quoted(references.text(data, node_of(where), None))
    if isinstance(data, bool):
        return "true" if data else "false"
    if isinstance(data, str):
        return quoted(data)
    if isinstance(type_, BasicType) and type_.is_integer:
        return str(int(data))
    node = node_of(where)
    spelled = node.lexeme if isinstance(node, Scalar) and node.data == data else repr(data)
    return spelled if re.fullmatch(r"[-+]?[0-9]+\.[0-9]+", spelled) else repr(float(data))
