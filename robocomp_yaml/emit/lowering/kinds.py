"""Lowers types of parameters to expressions that build the types of the run time:
`decimal("float").atLeast(0).below(1).in("rad")`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    ResolvedMember,
    Size,
    Type,
    nested,
)

if TYPE_CHECKING:
    from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling

_LIMITS = {"at_least": "atLeast", "above": "above", "at_most": "atMost", "below": "below"}


class Builders(msgspec.Struct, frozen=True):
    """How a language spells the calls. `prefix` is the prefix of all functions. `text` makes a literal of a text,
    `value` one of any plain data, `listed` a list of expressions, and `pattern` a matcher for a pattern."""

    prefix: str
    text: Callable[[str], str]
    value: Callable[[object], str]
    listed: Callable[[Sequence[str]], str]
    pattern: Callable[[str], str]

    def kind(self, type_: Type, functions: Mapping[str, str], group: str | None = None) -> str:
        """The expression for a type. `functions` maps records to the functions that build their types; `group` is the
        path of a group."""
        match type_:
            case BasicType():
                return self._plain(type_)
            case EnumType(name=name, allowed=allowed):
                names = self.listed([self.text(word) for word in allowed])
                return f"{self.prefix}choice({self.text(name)}, {names}){'.secret()' * type_.secret}"
            case ListType(element=element, size=size, unique=unique):
                made = f"{self.prefix}list({self.kind(element, functions)}){_size(size)}"
                return f"{made}.unique()" if unique else made
            case MapType(element=element, size=size):
                return f"{self.prefix}map({self.kind(element, functions)}){_size(size)}"
            case _:
                return f"{functions[type_.name or group or '']}()"

    def member(self, start: str, member: ResolvedMember, functions: Mapping[str, str], group: str | None) -> str:
        """The expression for a member; `start` is the call up to the name of the member."""
        made = f"{start}, {self.kind(member.type, functions, group)})"
        made += f".byDefault({self.value(member.default.data)})" if member.default is not None else ""
        return made + "".join(f".{word}()" for word in ("optional", "editable") if getattr(member, word))

    def _plain(self, type_: BasicType) -> str:
        if type_.name == "bool":
            made = f"{self.prefix}truth()"
        elif type_.name == "string":
            made = f"{self.prefix}text()"
        else:
            made = f"{self.prefix}{'whole' if type_.is_integer else 'decimal'}({self.text(type_.name)})"
        return made + "".join(f".{limit}" for limit in self._limits(type_)) + ".secret()" * type_.secret

    def _limits(self, type_: BasicType) -> Iterator[str]:
        if type_.values:
            yield f"oneOf({self.listed([self.value(literal.value) for literal in type_.values])})"
        for name, end in type_.range.limits.items() if type_.range else ():
            yield f"{_LIMITS[name]}({self.value(end)})"
        if type_.pattern is not None:
            yield f"matching({self.pattern(type_.pattern.portable)}, {self.text(type_.pattern.text)})"
        if type_.unit:
            yield f"in({self.text(type_.unit)})"

    def spelling(self, spelling: LegacySpelling) -> str:
        """The arguments that build a spelling of properties."""
        fields = self.listed([self.listed([self.text(name), self.text(key)]) for name, key in spelling.fields])
        words = [
            self.text(spelling.key), fields, str(spelling.first), self.texts(spelling.columns),
            self.text(spelling.separator), self.texts(spelling.separators), "true" if spelling.trailing else "false",
            self.text(spelling.count),
        ]  # fmt: skip
        return ", ".join(words)

    def texts(self, words: Sequence[str]) -> str:
        """A list of literals."""
        return self.listed([self.text(word) for word in words])


def _size(size: Size) -> str:
    if size.most is not None:
        return f".size({size.least}, {size.most})"
    return f".size({size.least})" if size.least else ""


def pattern_count(type_: Type) -> int:
    """The number of patterns in a type."""
    return sum(isinstance(one, BasicType) and one.pattern is not None for one in nested(type_))
