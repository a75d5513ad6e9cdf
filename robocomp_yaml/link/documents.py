"""Reads each document once: decode, parse, validate, build."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from collections.abc import Mapping as Map
from functools import cache, partial
from typing import TYPE_CHECKING, cast

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.memory import Memory
from robocomp_yaml.model import build_interface
from robocomp_yaml.plugins import NONE, Plugins
from robocomp_yaml.source import schema
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.heading import COMPONENT, text_at_top
from robocomp_yaml.source.schema_text import MARKED
from robocomp_yaml.source.syntax import Rejected, SyntaxFault
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Mapping, Node, parse

if TYPE_CHECKING:
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.model.deployment import Deployment
    from robocomp_yaml.model.interface import Module
    from robocomp_yaml.parameters.specification.document import ParameterDocument, ValuesDocument
    from robocomp_yaml.source.parts import Parts

    Model = Module | Component | ParameterDocument | ValuesDocument | Deployment

_BUILDERS = {
    "idsl": "model.build_interface.build",
    "cdsl": "model.build_component.build",
    "pdsl": "parameters.specification.build.build",
    "ddsl": "model.build_deployment.build",
    "config": "parameters.specification.build.build_values",
}


@cache
def builder(kind: str) -> Callable[[Mapping, str], Model]:
    """The function that builds the model of a document that fits the schema of its kind."""
    module, _, function = _BUILDERS[kind].rpartition(".")
    build: Callable[[Mapping, str], Model] = getattr(importlib.import_module(f"robocomp_yaml.{module}"), function)
    return build


def read_tree(path: str, disk: Disk) -> tuple[Node | None, list[Diagnostic]]:
    """The tree of a YAML file, None if it cannot be read, decoded or parsed, and diagnostics."""
    raw, diagnostics = disk.read(path)
    return _tree_of(path, raw) if raw is not None else (None, diagnostics)


def _tree_of(path: str, raw: bytes, parts: Parts | None = None) -> tuple[Node | None, list[Diagnostic]]:
    text, diagnostics = decode(path, raw)
    if text is None:
        return None, diagnostics
    if parts is None:
        try:
            return parse(path, text, by_libyaml=True)
        except Rejected:
            parts = {}  # most of its entries are right
    from robocomp_yaml.source.parts import parse_in_parts  # most runs edit nothing, and read what is right

    try:
        tree = parse_in_parts(path, text, parts)
    except SyntaxFault as fault:
        return None, [fault.diagnostic]
    return (tree, []) if tree is not None else parse(path, text)


class Document(msgspec.Struct, frozen=True, eq=False):
    """A document as far as it can be read. `model` is None if it does not fit its schema, `tree` if it is no YAML.
    `real` is its real path, `module` the name of the module that it defines, or ''; `component` is the text under
    `component:`, and None if the document cannot be parsed."""

    path: str
    real: str
    kind: str
    model: Model | None = None
    module: str = ""
    component: str | None = None
    tree: Node | None = None


class Documents(msgspec.Struct):
    """The documents of a run by real path, with the diagnostics of each by itself. `plugins_of` returns the plug-ins of
    a document's workspace; `on_read` is called with the path of each document. `memory` keeps documents by content.
    `known` are documents that another run read; their diagnostics were reported there."""

    disk: Disk = msgspec.field(default_factory=Disk)
    on_read: Callable[[str], None] = lambda path: None
    plugins_of: Callable[[str], Plugins] = lambda path: NONE
    memory: Memory = msgspec.field(default_factory=partial(Memory, once=True))
    known: Map[str, Document] = {}
    read: dict[str, Document] = {}
    diagnostics: list[Diagnostic] = []
    _glanced: dict[str, tuple[Document, list[Diagnostic]]] = {}

    def get(self, path: str, kind: str = "") -> Document:
        """The document at a path, which becomes part of the run. `kind` is for a name that does not have the kind."""
        document = self.glance(path, kind)
        if document.real in self.known:
            self.read[document.real] = document
        elif document.real not in self.read:
            self.read[document.real], diagnostics = self._glanced.pop(document.real)
            self.diagnostics += diagnostics
            self.on_read(path)
        return document

    def glance(self, path: str, kind: str = "") -> Document:
        """The document at a path, which may be no part of the run: its diagnostics are not reported before `get`."""
        real = self.disk.real(path)
        document = self.read.get(real) or self.known.get(real)
        if document is not None:
            return document
        if real not in self._glanced:
            self._glanced[real] = self._load(path, real, kind_of(path, self.disk) or kind or "idsl")
        return self._glanced[real][0]

    def _load(self, path: str, real: str, kind: str) -> tuple[Document, list[Diagnostic]]:
        raw, diagnostics = self.disk.read(path)
        if raw is None:
            return Document(path, real, kind), diagnostics
        plugins = self.plugins_of(path) if kind in MARKED else NONE
        causes = raw, plugins.languages, plugins.whole
        return self.memory.result(
            ("document", path, real, kind),
            causes,
            lambda: _made(Document(path, real, kind), raw, plugins, self.memory),
        )


def _made(document: Document, raw: bytes, plugins: Plugins, memory: Memory) -> tuple[Document, list[Diagnostic]]:
    """Decodes, parses, validates and builds, until a pass reports an error."""
    path, kind = document.path, document.kind
    tree, diagnostics = _tree_of(path, raw, memory.parts(path))
    if tree is None:
        return document, diagnostics
    misfits = _misfits(kind, tree, plugins)
    model = None
    if not has_errors(misfits):
        assert isinstance(tree, Mapping)
        model = made = builder(kind)(tree, path)
        if kind == "ddsl":  # an edit of a comment makes the same
            model = memory.result(("model", document.real), cast("Deployment", made).causes(), lambda: made)
    module, component = text_at_top(tree, "module"), text_at_top(tree, COMPONENT)
    diagnostics += (misfit for misfit in misfits if not _is_of_a_plugin(kind, tree, misfit, plugins))
    return Document(path, document.real, kind, model, module, component, tree), diagnostics


def _is_of_a_plugin(kind: str, tree: Node, misfit: Diagnostic, plugins: Plugins) -> bool:
    """Whether an unknown language may be that of a plug-in that cannot be loaded, which is reported already."""
    if kind not in MARKED or not isinstance(tree, Mapping) or plugins.whole:
        return False
    language = tree.get("language")
    return misfit.code == codes.WRONG_SHAPE.id and language is not None and language.span.holds(misfit.span)


def _misfits(kind: str, tree: Node, plugins: Plugins) -> list[Diagnostic]:
    """Validates a document by the schema of its kind."""
    diagnostics = schema.validate(kind, tree, plugins.languages)
    if not diagnostics and kind == "idsl" and isinstance(tree, Mapping):
        diagnostics = list(_kinds_of_types(tree))
    return diagnostics


def _kinds_of_types(tree: Mapping) -> Iterator[Diagnostic]:
    """Checks that each type has exactly one kind. The schema could say so, but not with a helpful message."""
    for key, node in build_interface.entries(tree, "types"):
        assert isinstance(node, Mapping)
        kinds = [kind for kind in build_interface.TYPE_KINDS if kind in node.entries]
        if not kinds:
            hint = "write {struct: …}, {enum: …}, {sequence: …} or {map: …}"
            yield codes.NO_KIND.at(key.span, name=key.lexeme, hint=hint)
        elif len(kinds) > 1:
            yield codes.TWO_KINDS.at(node.entries[kinds[1]][0].span, name=key.lexeme, kinds=" and ".join(kinds))
