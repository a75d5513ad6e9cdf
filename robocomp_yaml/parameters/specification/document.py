"""The PDSL model as written: names of types are not looked up yet. `parameters.types` is what becomes of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.model.located import Located
from robocomp_yaml.semantics import spellings
from robocomp_yaml.source.tree import Mapping, Node

# The keys that say what a type is, in the order in which they are looked at.
KINDS = ("type", "list", "map", "group", "enum", "struct")


class LimitNodes(msgspec.Struct, frozen=True):
    """The nodes of the keys that limit a type's values, as they stand there; None where a key is missing."""

    range: Node | None = None
    values: Node | None = None
    pattern: Node | None = None
    size: Node | None = None
    unique: Node | None = None
    unit: Node | None = None


class TypeSpec(Located, frozen=True):
    """What a document says about a type. `kinds` are those of KINDS that stand there, with their places: exactly one
    when nothing is wrong. `name` goes with 'type', `element` with 'list' and 'map', `members` with 'group' and
    'struct', `enumerators` with 'enum'. `key_span` is where it has its name, if it has one."""

    kinds: tuple[tuple[str, Span], ...]
    name: str = ""
    element: TypeSpec | None = None
    members: tuple[MemberSpec, ...] = ()
    enumerators: tuple[tuple[Literal, str], ...] = ()
    limits: LimitNodes = LimitNodes()
    doc: str = ""
    span: Span = Span("")
    key_span: Span = Span("")

    @property
    def kind(self) -> str:
        return self.kinds[0][0] if self.kinds else ""


class MemberSpec(Located, frozen=True):
    """A parameter, or a member of a group or struct. `editable` is None where nothing is said; `secret` is the place of
    the key where the document says so."""

    name: str
    spec: TypeSpec
    default: Node | None = None
    default_span: Span | None = None
    optional: bool = False
    editable: bool | None = None
    secret: Span | None = None
    code_name: str = ""
    doc: str = ""
    span: Span = Span("")


class ConstraintSpec(Located, frozen=True):
    """An entry of `constraints:`. `that` is the expression's node: diagnostics point into it."""

    that: Node
    otherwise: str = ""
    doc: str = ""
    span: Span = Span("")


@dataclass(frozen=True)
class LegacySpelling(spellings.Spelling):
    """An entry of `legacy:`: how properties spell the parameter at `path`."""

    path: str = ""
    span: Span = field(default=Span(""), compare=False)


class ParameterDocument(Located, frozen=True):
    """One PDSL document. `component` is a path to a CDSL or a plain name, as written, or ''."""

    path: str
    component: str = ""
    types: tuple[tuple[str, TypeSpec], ...] = ()
    parameters: tuple[MemberSpec, ...] = ()
    rules: tuple[ConstraintSpec, ...] = ()
    legacy: tuple[LegacySpelling, ...] = ()
    doc: str = ""
    span: Span = Span("")
    component_span: Span = Span("")


class ValuesDocument(Located, frozen=True):
    """One values document: a layer of a component's values. `root` is its tree, which has the schema's shape;
    `extends` are paths as written, the most general first, with their places."""

    path: str
    root: Mapping
    component: str = ""
    extends: tuple[Literal, ...] = ()
    span: Span = Span("")

    def section(self, *keys: str) -> Mapping | None:
        """The mapping under these keys, one inside the other."""
        node: Node | None = self.root
        for key in keys:
            node = node.get(key) if isinstance(node, Mapping) else None
        return node if isinstance(node, Mapping) else None
