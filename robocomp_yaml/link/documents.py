"""Each document read once: bytes to tree to shape to model."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterator
from functools import cache
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.model import build_interface
from robocomp_yaml.plugins import NONE, Plugins
from robocomp_yaml.source import schema
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.heading import COMPONENT, text_at_top
from robocomp_yaml.source.schema_text import MARKED
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Mapping, Node, parse

if TYPE_CHECKING:
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.model.deployment import Deployment
    from robocomp_yaml.model.interface import Module
    from robocomp_yaml.parameters.specification.document import ParameterDocument, ValuesDocument

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
    """What makes the model of a document that has the shape of its kind."""
    module, _, function = _BUILDERS[kind].rpartition(".")
    build: Callable[[Mapping, str], Model] = getattr(importlib.import_module(f"robocomp_yaml.{module}"), function)
    return build


class Document(msgspec.Struct, frozen=True, eq=False):
    """A document as far as it could be read: `model` is None where it has errors of its own, `tree` where it is no
    YAML. `real` is its real path, `module` the name of the module it defines, as far as that can be told;
    `component` is what it says under `component:`, and None where it cannot be read at all."""

    path: str
    real: str
    kind: str
    model: Model | None = None
    module: str = ""
    component: str | None = None
    tree: Node | None = None


class Documents(msgspec.Struct):
    """The documents of a run by real path, with all that is wrong with each by itself. `plugins_of` says which plug-ins
    count for a document."""

    disk: Disk = msgspec.field(default_factory=Disk)
    on_read: Callable[[str], None] = lambda path: None
    plugins_of: Callable[[str], Plugins] = lambda path: NONE
    read: dict[str, Document] = {}
    diagnostics: list[Diagnostic] = []
    _glanced: dict[str, tuple[Document, list[Diagnostic]]] = {}

    def get(self, path: str, kind: str = "") -> Document:
        """The document at a path, read at the first call; `kind` is for one whose name does not say it."""
        document = self.glance(path, kind)
        if document.real not in self.read:
            self.read[document.real], found = self._glanced.pop(document.real)
            self.diagnostics += found
            self.on_read(path)
        return document

    def glance(self, path: str, kind: str = "") -> Document:
        """The same for one that may prove to be none of this run: what is wrong with it is told once it is got."""
        real = os.path.realpath(path)
        document = self.read.get(real)
        if document is not None:
            return document
        if real not in self._glanced:
            self._glanced[real] = self._load(path, real, kind_of(path, self.disk) or kind or "idsl")
        return self._glanced[real][0]

    def trees(self) -> dict[str, Node | None]:
        """The trees of the documents that were got, by their paths."""
        return {document.path: document.tree for document in self.read.values()}

    def _load(self, path: str, real: str, kind: str) -> tuple[Document, list[Diagnostic]]:
        """Bytes → text → tree → shape → model, as far as it goes."""
        nothing = Document(path, real, kind)
        raw, said = self.disk.read(path)
        if raw is None:
            return nothing, said
        text, more = decode(path, raw)
        said = [*said, *more]
        if text is None:
            return nothing, said
        tree, more = parse(path, text)
        said += more
        if tree is None:
            return nothing, said
        misfits = self._misfits(path, kind, tree)
        model = None
        if not has_errors(misfits):
            assert isinstance(tree, Mapping)
            model = builder(kind)(tree, path)
        module, component = text_at_top(tree, "module"), text_at_top(tree, COMPONENT)
        told = [one for one in misfits if not self._is_of_a_plugin(path, kind, tree, one)]
        return Document(path, real, kind, model, module, component, tree), [*said, *told]

    def _is_of_a_plugin(self, path: str, kind: str, tree: Node, said: Diagnostic) -> bool:
        """Whether an unknown language may be that of a plug-in which cannot be had: that is told already."""
        if kind not in MARKED or not isinstance(tree, Mapping) or self.plugins_of(path).whole:
            return False
        language = tree.get("language")
        return said.code == codes.WRONG_SHAPE.id and language is not None and language.span.holds(said.span)

    def _misfits(self, path: str, kind: str, tree: Node) -> list[Diagnostic]:
        """What of a document's shape is not as its kind wants it."""
        more = self.plugins_of(path).languages if kind in MARKED else ()
        diagnostics = schema.validate(kind, tree, more)
        if not diagnostics and kind == "idsl" and isinstance(tree, Mapping):
            diagnostics = list(_kinds_of_types(tree))
        return diagnostics


def _kinds_of_types(tree: Mapping) -> Iterator[Diagnostic]:
    """Each type is of exactly one kind: a rule that a schema can state, but not explain."""
    for key, node in build_interface.entries(tree, "types"):
        assert isinstance(node, Mapping)
        kinds = [kind for kind in build_interface.TYPE_KINDS if kind in node.entries]
        if not kinds:
            hint = "write {struct: …}, {enum: …}, {sequence: …} or {map: …}"
            yield codes.NO_KIND.at(key.span, name=key.lexeme, hint=hint)
        elif len(kinds) > 1:
            yield codes.TWO_KINDS.at(node.entries[kinds[1]][0].span, name=key.lexeme, kinds=" and ".join(kinds))
