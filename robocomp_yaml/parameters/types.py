"""The parameters of a component, resolved: every type with all its limits, for validation, schemas, accessors, docs.

Enums and structs are shared by name; other named types are replaced by what they stand for, their limits joined with
those of the place that names them. Values are judged as they are written (`double` precision for `float` too): a
range's limits are compared before anything is narrowed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.model.located import Located
from robocomp_yaml.parameters.patterns.pattern import Pattern
from robocomp_yaml.parameters.specification.document import LegacySpelling
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

BASIC_TYPES = ("bool", *LIMITS, "string")


class Bound(msgspec.Struct, frozen=True):
    """One end of a range; `is_open` when the value itself is not allowed."""

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
        """Its ends by what code calls them: `at_least` and `at_most` may be reached, `above` and `below` not."""
        return {name: bound.value for name, bound in self._ends()}

    def _ends(self) -> Iterator[tuple[str, Bound]]:
        if self.low is not None:
            yield "above" if self.low.is_open else "at_least", self.low
        if self.high is not None:
            yield "below" if self.high.is_open else "at_most", self.high


class Size(Located, frozen=True):
    """How many entries: from `least` to `most` (None: any number)."""

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
    """`values` are the only ones allowed (none: any). What is `secret` is never shown."""

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
    """`allowed` are the enumerators that the place allows, in order: all of them where nothing is said."""

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
    """Values by name: the keys are texts."""

    element: Type
    size: Size = Size()


class RecordType(msgspec.Struct, frozen=True):
    """A struct (`name` is its own), or a group (`name` is ''), whose members stand directly in their parent."""

    name: str
    members: tuple[ResolvedMember, ...]
    doc: str = ""

    @property
    def is_group(self) -> bool:
        return not self.name

    def member(self, name: str) -> ResolvedMember | None:
        return next((member for member in self.members if member.name == name), None)


ScalarType = BasicType | EnumType
Type = ScalarType | ListType | MapType | RecordType


class Default(Located, frozen=True):
    """A default as plain data. `node` is where it stands; None for one that a document did not write."""

    data: object
    node: Node | None = None


class ResolvedMember(Located, frozen=True):
    """A parameter, or a member of a group or struct. `code_name` is the name in code before a language's escaping.

    Required when it has neither a default nor is optional; a group has neither, its members may. `secret` where the
    document says so: its type knows it whatever says so.
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
        """Whether a values document has to give it; for a group: whether it has to give something in it."""
        if isinstance(self.type, RecordType) and self.type.is_group:
            return any(member.required for member in self.type.members)
        return self.default is None and not self.optional

    @property
    def unit(self) -> str:
        return unit_of(self.type)

    @property
    def documentation(self) -> str:
        """What is said of it, or else of its type."""
        return self.doc or (self.type.doc if isinstance(self.type, RecordType | EnumType) else "")


class ResolvedConstraint(Located, frozen=True):
    """What must hold between parameters, and what to say otherwise."""

    expression: Expression
    text: str
    otherwise: str = ""
    node: Node | None = None
    span: Span = Span("")

    @property
    def message(self) -> str:
        return self.otherwise or f"this must hold: {self.text}"


class Parameters(msgspec.Struct, frozen=True):
    """All the parameters of a component, as one group. `types` are the enums and structs by name, in the document's
    order; `spellings` the legacy table by dotted path."""

    root: RecordType
    types: tuple[EnumType | RecordType, ...] = ()
    constraints: tuple[ResolvedConstraint, ...] = ()
    spellings: tuple[LegacySpelling, ...] = ()
    doc: str = ""

    def spelling(self, path: str) -> LegacySpelling | None:
        return next((spelling for spelling in self.spellings if spelling.path == path), None)


def below(type_: Type | None, step: str | int) -> Type | None:
    """The type one step further down: of a member, or of the entries of a list or map; None where the step leads
    nowhere. Places in lists are numbers, or their digits."""
    if isinstance(type_, RecordType):
        member = type_.member(step) if isinstance(step, str) else None
        return member.type if member is not None else None
    if isinstance(type_, ListType):
        return type_.element if isinstance(step, int) or (step.isascii() and step.isdigit()) else None
    return type_.element if isinstance(type_, MapType) else None


def nested(type_: Type) -> Iterator[Type]:
    """A type, and all that lists, maps and records of it hold."""
    yield type_
    if isinstance(type_, ListType | MapType):
        yield from nested(type_.element)
    elif isinstance(type_, RecordType):
        for member in type_.members:
            yield from nested(member.type)


def innermost(type_: Type) -> ScalarType | RecordType:
    """What lists and maps, at any depth, hold."""
    while isinstance(type_, ListType | MapType):
        type_ = type_.element
    return type_


def unit_of(type_: Type) -> str:
    """The unit of a number, or of the numbers that a list or map holds."""
    type_ = innermost(type_)
    return type_.unit if isinstance(type_, BasicType) else ""


def is_text(type_: Type) -> bool:
    """Whether the values of a type are texts: an enumerator is one."""
    return isinstance(type_, EnumType) or (isinstance(type_, BasicType) and type_.name == "string")


def json_type(type_: ScalarType) -> str:
    """A plain type as JSON Schema calls it."""
    if isinstance(type_, EnumType) or not (type_.is_number or type_.name == "bool"):
        return "string"
    return "boolean" if type_.name == "bool" else "integer" if type_.is_integer else "number"


def is_secret(type_: Type) -> bool:
    """Whether a plain value is a secret, or the plain values that a list or map holds are."""
    type_ = innermost(type_)
    return not isinstance(type_, RecordType) and type_.secret


def leaves(record: RecordType, prefix: str = "", *, groups: bool = False) -> Iterator[tuple[str, ResolvedMember]]:
    """Every parameter by its dotted path, groups opened; with `groups`, these too."""
    for member in record.members:
        path, is_group = f"{prefix}{member.name}", isinstance(member.type, RecordType) and member.type.is_group
        if groups or not is_group:
            yield path, member
        if isinstance(member.type, RecordType) and is_group:
            yield from leaves(member.type, f"{path}.", groups=groups)
