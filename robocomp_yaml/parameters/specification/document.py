"""The PDSL model as written. Names of types are not resolved; `parameters.types` is the resolved model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.model.located import Located
from robocomp_yaml.source.tree import Mapping, Node

if TYPE_CHECKING:
    from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling

# The keys that define a type, in order of precedence.
KINDS = ("type", "list", "map", "group", "enum", "struct")


class LimitNodes(msgspec.Struct, frozen=True):
    """The nodes of the keys that limit the values of a type; None if a key is missing."""

    range: Node | None = None
    values: Node | None = None
    pattern: Node | None = None
    size: Node | None = None
    unique: Node | None = None
    unit: Node | None = None


class TypeSpec(Located, frozen=True):
    """A type as written. `kinds` are the keys of KINDS that it has, with their locations: one if the type is valid.
    `name` is the value of 'type', `element` of 'list' and 'map', `members` of 'group' and 'struct', `enumerators` of
    'enum'. `key_span` is the location of the name of the type, if it has one."""

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
    """A parameter, or a member of a group or struct, as written. `editable` is None if the key is missing. `secret` is
    the location of the key if it is true."""

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
    """An entry of `constraints:`. `that` is the node of the expression, with the locations for diagnostics."""

    that: Node
    otherwise: str = ""
    doc: str = ""
    span: Span = Span("")


class ParameterDocument(Located, frozen=True):
    """One PDSL document. `component` is the path of a CDSL document or a plain name, as written, or ''."""

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
    """One values document: a layer of the values of a component. `root` is its validated tree. `extends` are paths as
    written, the most general first, with their locations."""

    path: str
    root: Mapping
    component: str = ""
    extends: tuple[Literal, ...] = ()
    span: Span = Span("")

    def section(self, *keys: str) -> Mapping | None:
        """The mapping under these nested keys, or None."""
        node: Node | None = self.root
        for key in keys:
            node = node.get(key) if isinstance(node, Mapping) else None
        return node if isinstance(node, Mapping) else None
