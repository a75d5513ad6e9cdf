"""The IDSL model: what a module defines."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from robocomp_yaml.diag.span import Span

BASIC_TYPES = ("bool", "byte", "short", "int", "long", "float", "double", "string")


def _span() -> Span:
    return field(compare=False, repr=False, kw_only=True, default=Span(""))  # type: ignore[return-value]


@dataclass(frozen=True, slots=True)
class TypeRef:
    """A type as a document names it: `float`, `Pose`, `CommonTypes.Pose` or `RoboCompCommonTypes.Pose`."""

    text: str
    span: Span = _span()

    @property
    def is_basic(self) -> bool:
        return self.text in BASIC_TYPES

    @property
    def module(self) -> str:
        """What stands before the dot, or ''."""
        return self.text.rpartition(".")[0]

    @property
    def name(self) -> str:
        return self.text.rpartition(".")[2]


@dataclass(frozen=True, slots=True)
class Literal:
    """A value as spelled (`lexeme`: `.9`, `2000.`, `True`, without quotes) and as understood."""

    value: bool | int | float | str
    lexeme: str
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Member:
    """A member of a struct or exception, or a parameter of a method (which has no default)."""

    name: str
    type: TypeRef
    doc: str = ""
    unit: str = ""
    default: Literal | None = None
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Struct:
    name: str
    members: tuple[Member, ...]
    doc: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Enumerator:
    """`value` is None where the author gave none (then: one more than the one before, from 0)."""

    name: str
    value: int | None = None
    doc: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Enum:
    name: str
    enumerators: tuple[Enumerator, ...]
    doc: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Sequence:
    name: str
    element: TypeRef
    doc: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Map:
    name: str
    key: TypeRef
    value: TypeRef
    doc: str = ""
    span: Span = _span()


TypeDefinition = Struct | Enum | Sequence | Map


@dataclass(frozen=True, slots=True)
class ExceptionType:
    name: str
    members: tuple[Member, ...]
    doc: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Constant:
    name: str
    type: TypeRef
    value: Literal
    doc: str = ""
    unit: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Method:
    """`returns` is None for a method that returns nothing. `legacy_name` is its name in legacy Slice, where it differs
    (an overload, which IDSL cannot say)."""

    name: str
    inputs: tuple[Member, ...] = ()
    outputs: tuple[Member, ...] = ()
    returns: TypeRef | None = None
    throws: tuple[TypeRef, ...] = ()
    idempotent: bool = False
    doc: str = ""
    legacy_name: str = ""
    returns_doc: str = ""
    returns_unit: str = ""
    span: Span = _span()

    @property
    def can_be_published(self) -> bool:
        """Topics carry one way: no result, no `out`, no exceptions."""
        return self.returns is None and not self.outputs and not self.throws


@dataclass(frozen=True, slots=True)
class Interface:
    """An entry of `interfaces:`, or of `topics:` (`is_topic`)."""

    name: str
    methods: tuple[Method, ...]
    is_topic: bool = False
    doc: str = ""
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Import:
    """An entry of `imports:`: a name without suffix, or a path, as written."""

    text: str
    span: Span = _span()


@dataclass(frozen=True, slots=True)
class Module:
    """One IDSL document. `path` is the document as opened; `stem` its name without `.idsl.yaml`.

    Each tuple keeps the author's order.
    """

    name: str
    path: str
    imports: tuple[Import, ...] = ()
    constants: tuple[Constant, ...] = ()
    types: tuple[TypeDefinition, ...] = ()
    exceptions: tuple[ExceptionType, ...] = ()
    interfaces: tuple[Interface, ...] = ()
    topics: tuple[Interface, ...] = ()
    doc: str = ""
    span: Span = _span()

    @property
    def stem(self) -> str:
        return self.path.rpartition("/")[2].removesuffix(".idsl.yaml")

    @property
    def all_interfaces(self) -> tuple[Interface, ...]:
        return self.interfaces + self.topics

    @property
    def definitions(self) -> Iterator[Constant | TypeDefinition | ExceptionType | Interface]:
        """All that the module defines, in one name space."""
        yield from self.constants
        yield from self.types
        yield from self.exceptions
        yield from self.all_interfaces
