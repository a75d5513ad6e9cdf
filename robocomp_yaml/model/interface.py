"""The IDSL model: modules."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.located import Spanned, Text

BASIC_TYPES = ("bool", "byte", "short", "int", "long", "float", "double", "string")


class TypeRef(Text, frozen=True):
    """A type as a document names it: `float`, `Pose`, `CommonTypes.Pose` or `RoboCompCommonTypes.Pose`."""

    @property
    def is_basic(self) -> bool:
        return self.text in BASIC_TYPES

    @property
    def module(self) -> str:
        """The part before the last dot, or ''."""
        return self.text.rpartition(".")[0]

    @property
    def name(self) -> str:
        return self.text.rpartition(".")[2]


class Literal(Spanned, frozen=True):
    """A value as spelled (`lexeme`: `.9`, `2000.`, `True`, without quotes) and as parsed."""

    value: bool | int | float | str
    lexeme: str


class Member(Spanned, frozen=True):
    """A member of a struct or exception, or a parameter of a method (which has no default)."""

    name: str
    type: TypeRef
    doc: str = ""
    unit: str = ""
    default: Literal | None = None


class Struct(Spanned, frozen=True):
    """`list_span` is the span of the key `struct`."""

    name: str
    members: tuple[Member, ...]
    doc: str = ""
    list_span: Span = Span("")


class Enumerator(Spanned, frozen=True):
    """`value` is None if it is not written; then it is the value of the enumerator before, plus 1, or 0 for the
    first."""

    name: str
    value: int | None = None
    doc: str = ""


class Enum(Spanned, frozen=True):
    name: str
    enumerators: tuple[Enumerator, ...]
    doc: str = ""
    list_span: Span = Span("")

    def numbered(self) -> Iterator[tuple[str, int]]:
        """Every enumerator with its value, explicit or counted."""
        value = -1
        for enumerator in self.enumerators:
            value = value + 1 if enumerator.value is None else enumerator.value
            yield enumerator.name, value


class Sequence(Spanned, frozen=True):
    name: str
    element: TypeRef
    doc: str = ""


class Map(Spanned, frozen=True):
    name: str
    key: TypeRef
    value: TypeRef
    doc: str = ""


TypeDefinition = Struct | Enum | Sequence | Map


class ExceptionType(Spanned, frozen=True):
    name: str
    members: tuple[Member, ...]
    doc: str = ""


class Constant(Spanned, frozen=True):
    name: str
    type: TypeRef
    value: Literal
    doc: str = ""
    unit: str = ""


class Method(Spanned, frozen=True):
    """`returns` is None for a method that returns nothing."""

    name: str
    inputs: tuple[Member, ...] = ()
    outputs: tuple[Member, ...] = ()
    returns: TypeRef | None = None
    throws: tuple[TypeRef, ...] = ()
    idempotent: bool = False
    doc: str = ""
    returns_doc: str = ""
    returns_unit: str = ""

    @property
    def can_be_published(self) -> bool:
        """Whether a topic can have the method: it returns nothing, has no `out` and throws nothing."""
        return self.returns is None and not self.outputs and not self.throws


class Interface(Spanned, frozen=True):
    """An entry of `interfaces:`, or of `topics:` (`is_topic`)."""

    name: str
    methods: tuple[Method, ...]
    is_topic: bool = False
    doc: str = ""


class Import(Text, frozen=True):
    """An entry of `imports:`: a name without suffix, or a path, as written."""

    @property
    def stem(self) -> str:
        """The name of the imported document, without folder and suffix."""
        return self.text.rpartition("/")[2].removesuffix(".idsl.yaml")


Definition = Constant | TypeDefinition | ExceptionType | Interface


class Module(Spanned, frozen=True):
    """One IDSL document. `path` is the document as opened; `stem` is its name without `.idsl.yaml`.

    Each tuple has the order of the document.
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

    @property
    def stem(self) -> str:
        return self.path.rpartition("/")[2].removesuffix(".idsl.yaml")

    @property
    def all_interfaces(self) -> tuple[Interface, ...]:
        return self.interfaces + self.topics

    @property
    def definitions(self) -> Iterator[Definition]:
        """All definitions of the module, which share one name space."""
        yield from self.constants
        yield from self.types
        yield from self.exceptions
        yield from self.all_interfaces
