"""The resolved parameters of a component: every type with all its limits, for validation, schemas, accessors and docs.

Enums and structs are shared by name. Other named types are replaced by their definitions, and their limits are combined
with those where the name is used. Values are judged in `double` precision, for `float` too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.model.located import Located
from robocomp_yaml.parameters.patterns.pattern import Pattern
from robocomp_yaml.semantics.limits import (
    INTEGERS,
    LIMITS,
    Number,
    has_size,
    holds,
    range_in_words,
    size_in_words,
)
from robocomp_yaml.source.tree import Node

if TYPE_CHECKING:
    from robocomp_yaml.parameters.specification.expression import Expression
    from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling

BASIC_TYPES = ("bool", *LIMITS, "string")


class Bound(msgspec.Struct, frozen=True):
    """One end of a range. `is_open`: the value itself is excluded."""

    value: Number
    is_open: bool = False
    lexeme: str = ""


class Range(Located, frozen=True):
    low: Bound | None = None
    high: Bound | None = None
    span: Span = Span("")

    def holds(self, value: Number) -> bool:
        return holds(value, **self.limits)

    @property
    def in_words(self) -> str:
        """`from 0 to 2`, `at least 0`, `above 0 and at most 5`."""
        return range_in_words(**{name: bound.lexeme for name, bound in self._ends()})

    @property
    def limits(self) -> dict[str, Number]:
        """The ends by their names in code: `at_least` and `at_most` (inclusive), `above` and `below` (exclusive)."""
        return {name: bound.value for name, bound in self._ends()}

    def _ends(self) -> Iterator[tuple[str, Bound]]:
        if self.low is not None:
            yield "above" if self.low.is_open else "at_least", self.low
        if self.high is not None:
            yield "below" if self.high.is_open else "at_most", self.high


class Size(Located, frozen=True):
    """The number of elements: from `least` to `most`, without an upper limit if `most` is None."""

    least: int = 0
    most: int | None = None
    span: Span = Span("")

    def holds(self, count: int) -> bool:
        return has_size(count, self.least, self.most)

    @property
    def is_any(self) -> bool:
        return not self.least and self.most is None

    @property
    def in_words(self) -> str:
        return size_in_words(self.least, self.most)


class BasicType(msgspec.Struct, frozen=True):
    """A plain type. `values` are the allowed ones, all if it is empty. A `secret` value is never shown."""

    name: str
    range: Range | None = None
    values: tuple[Literal, ...] = ()
    pattern: Pattern | None = None
    unit: str = ""
    secret: bool = False

    @property
    def is_number(self) -> bool:
        return self.name in LIMITS

    @property
    def is_integer(self) -> bool:
        return self.name in INTEGERS


class EnumType(msgspec.Struct, frozen=True):
    """An enum. `allowed` are the enumerators within the limits, in order: all if there are no limits."""

    name: str
    enumerators: tuple[tuple[str, str], ...]  # name and documentation
    allowed: tuple[str, ...]
    doc: str = ""
    secret: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self.enumerators)


class ListType(msgspec.Struct, frozen=True):
    element: Type
    size: Size = Size()
    unique: bool = False


class MapType(msgspec.Struct, frozen=True):
    """Values by name. The keys are texts."""

    element: Type
    size: Size = Size()


class RecordType(msgspec.Struct, frozen=True, dict=True):
    """A struct, or a group, whose `name` is ''."""

    name: str
    members: tuple[ResolvedMember, ...]
    doc: str = ""

    @property
    def is_group(self) -> bool:
        return not self.name

    @cached_property
    def by_name(self) -> Mapping[str, ResolvedMember]:
        return {member.name: member for member in self.members}

    def member(self, name: str) -> ResolvedMember | None:
        return self.by_name.get(name)


ScalarType = BasicType | EnumType
Type = ScalarType | ListType | MapType | RecordType


class Default(Located, frozen=True):
    """A default as plain data. `node` is its node in the document; None for a default of rcyaml."""

    data: object
    node: Node | None = None


class ResolvedMember(Located, frozen=True, dict=True):
    """A parameter, or a member of a group or struct. `code_name` is the name in code, before a language escapes it.

    A member without a default that is not optional is required. A group has neither default nor `optional`. `secret` is
    the key of the document; the type is also secret if the name is the name of a secret.
    """

    name: str
    type: Type
    doc: str = ""
    default: Default | None = None
    optional: bool = False
    editable: bool = False
    secret: bool = False
    code_name: str = ""
    span: Span = Span("")

    @property
    def is_group(self) -> bool:
        return isinstance(self.type, RecordType) and self.type.is_group

    @property
    def required(self) -> bool:
        """Whether a values document must set the member; for a group, whether it must set a member of the group."""
        if isinstance(self.type, RecordType) and self.type.is_group:
            return any(member.required for member in self.type.members)
        return self.default is None and not self.optional

    @property
    def unit(self) -> str:
        return unit_of(self.type)

    @property
    def documentation(self) -> str:
        """The documentation of the member, or else of its type."""
        return self.doc or (self.type.doc if isinstance(self.type, (RecordType, EnumType)) else "")


class ResolvedConstraint(Located, frozen=True):
    """A constraint between parameters. `otherwise` is its message if it does not hold."""

    expression: Expression
    text: str
    otherwise: str = ""
    node: Node | None = None
    span: Span = Span("")

    @property
    def message(self) -> str:
        return self.otherwise or f"this must hold: {self.text}"


class Parameters(msgspec.Struct, frozen=True):
    """All parameters of a component, as the group `root`. `types` are its enums and structs, in the order of the
    document. `spellings` are the entries of `legacy:`."""

    root: RecordType
    types: tuple[EnumType | RecordType, ...] = ()
    constraints: tuple[ResolvedConstraint, ...] = ()
    spellings: tuple[LegacySpelling, ...] = ()
    doc: str = ""

    def spelling(self, path: str) -> LegacySpelling | None:
        return next((spelling for spelling in self.spellings if spelling.path == path), None)


def below(type_: Type | None, step: str | int) -> Type | None:
    """The type one step below: of a member, or of the elements of a list or map; None if the step does not exist. An
    index of a list is a number, or its digits."""
    if isinstance(type_, RecordType):
        member = type_.member(step) if isinstance(step, str) else None
        return member.type if member is not None else None
    if isinstance(type_, ListType):
        return type_.element if isinstance(step, int) or (step.isascii() and step.isdigit()) else None
    return type_.element if isinstance(type_, MapType) else None


def nested(type_: Type) -> Iterator[Type]:
    """A type, and all types inside its lists, maps and records."""
    pending = [type_]
    while pending:
        one = pending.pop()
        yield one
        if isinstance(one, RecordType):
            pending += [member.type for member in reversed(one.members)]
        elif isinstance(one, (ListType, MapType)):
            pending.append(one.element)


def innermost(type_: Type) -> ScalarType | RecordType:
    """The type of the elements of lists and maps, at any depth; the type itself if it is neither."""
    while isinstance(type_, (ListType, MapType)):
        type_ = type_.element
    return type_


def unit_of(type_: Type) -> str:
    """The unit of a number, or of the numbers in a list or map; '' if there is none."""
    type_ = innermost(type_)
    return type_.unit if isinstance(type_, BasicType) else ""


def is_text(type_: Type) -> bool:
    """Whether the values of a type are texts or enumerators."""
    return isinstance(type_, EnumType) or (isinstance(type_, BasicType) and type_.name == "string")


def json_type(type_: ScalarType) -> str:
    """The name of a plain type in JSON Schema."""
    if isinstance(type_, EnumType) or not (type_.is_number or type_.name == "bool"):
        return "string"
    return "boolean" if type_.name == "bool" else "integer" if type_.is_integer else "number"


def is_secret(type_: Type) -> bool:
    """Whether a plain value, or the plain values in a list or map, are secret."""
    type_ = innermost(type_)
    return not isinstance(type_, RecordType) and type_.secret


def leaves(record: RecordType, prefix: str = "", *, groups: bool = False) -> Iterator[tuple[str, ResolvedMember]]:
    """Every parameter by its dotted path, those in groups included; with `groups`, also the groups."""
    for member in record.members:
        path, is_group = f"{prefix}{member.name}", isinstance(member.type, RecordType) and member.type.is_group
        if groups or not is_group:
            yield path, member
        if isinstance(member.type, RecordType) and is_group:
            yield from leaves(member.type, f"{path}.", groups=groups)
