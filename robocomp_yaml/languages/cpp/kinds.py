"""Types of parameters as expressions of the C++ run time's types, and the spellings of their properties."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from robocomp_yaml.languages.cpp.literals import string, text, value
from robocomp_yaml.model.parameters import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    Size,
    Type,
)
from robocomp_yaml.model.pdsl import Spelling


def kind(type_: Type, functions: Mapping[str, str], group: str | None = None) -> str:
    """`functions` make the types of records; `group` is the path of a group."""
    match type_:
        case BasicType():
            return _plain(type_)
        case EnumType(name=name, allowed=allowed):
            return f"runtime::choice({text(name)}, {{{', '.join(map(text, allowed))}}}){'.secret()' * type_.secret}"
        case ListType(element=element, size=size, unique=unique):
            made = f"runtime::list({kind(element, functions)}){_size(size)}"
            return f"{made}.unique()" if unique else made
        case MapType(element=element, size=size):
            return f"runtime::map({kind(element, functions)}){_size(size)}"
        case _:
            return f"{functions[type_.name or group or '']}()"


def _plain(type_: BasicType) -> str:
    if type_.name == "bool":
        made = "runtime::truth()"
    elif type_.name == "string":
        made = "runtime::text()"
    else:
        made = f"runtime::{'whole' if type_.is_integer else 'decimal'}({text(type_.name)})"
    return made + "".join(f".{limit}" for limit in _limits(type_)) + ".secret()" * type_.secret


def _limits(type_: BasicType) -> Iterator[str]:
    if type_.values:
        yield f"oneOf({{{', '.join(value(literal.value) for literal in type_.values)}}})"
    low, high = (type_.range.low, type_.range.high) if type_.range else (None, None)
    if low is not None:
        yield f"{'above' if low.is_open else 'atLeast'}({value(low.value)})"
    if high is not None:
        yield f"{'below' if high.is_open else 'atMost'}({value(high.value)})"
    if type_.pattern is not None:
        yield f"matching(runtime::pattern({string(type_.pattern.portable)}), {string(type_.pattern.text)})"
    if type_.unit:
        yield f"in({string(type_.unit)})"


def _size(size: Size) -> str:
    if size.most is not None:
        return f".size({size.least}, {size.most})"
    return f".size({size.least})" if size.least else ""


def spelling(spelling: Spelling) -> str:
    """All members, in their order: C++17 has no names for them."""
    fields = ", ".join(f"{{{text(name)}, {text(key)}}}" for name, key in spelling.fields)
    words = [
        text(spelling.key), f"{{{fields}}}", str(spelling.first), _texts(spelling.columns), text(spelling.separator),
        _texts(spelling.separators), "true" if spelling.trailing else "false", text(spelling.count),
    ]  # fmt: skip
    return f"runtime::Spelling{{{', '.join(words)}}}"


def _texts(words: tuple[str, ...]) -> str:
    return f"{{{', '.join(map(text, words))}}}"


def pattern_count(type_: Type) -> int:
    """How many patterns a type has."""
    match type_:
        case BasicType(pattern=pattern):
            return int(pattern is not None)
        case ListType(element=element) | MapType(element=element):
            return pattern_count(element)
        case RecordType(members=members):
            return sum(pattern_count(member.type) for member in members)
        case _:
            return 0
