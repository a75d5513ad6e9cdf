"""Documents of parameters and of values as the linker has joined them; `link` adds whose they are."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self, TypeVar

import msgspec

from robocomp_yaml.diag.span import Span

if TYPE_CHECKING:
    from robocomp_yaml.parameters.specification.document import ParameterDocument, ValuesDocument
    from robocomp_yaml.parameters.types import Parameters

Made = TypeVar("Made")


class ResolvedParameters(msgspec.Struct, frozen=True, eq=False):
    """Parameters with their document, if there is one; `broken` when some have no usable type (then values are not
    judged)."""

    parameters: Parameters
    document: ParameterDocument | None = None
    broken: bool = False
    _made: dict[object, Any] = {}

    def once(self, name: object, make: Callable[[], Made]) -> Made:
        """What is made of the parameters once, and used often: validators, say."""
        if name not in self._made:
            self._made[name] = make()
        made: Made = self._made[name]
        return made


class LayeredValues(msgspec.Struct, frozen=True, eq=False):
    """A values document with the documents that it extends, the most general first. `parameters` is None where the
    component is not known; `is_extended` when another document builds on this one, so that it need not be complete;
    `broken` when a layer is missing."""

    document: ValuesDocument
    extends: tuple[Self, ...] = ()
    parameters: ResolvedParameters | None = None
    is_extended: bool = False
    broken: bool = False

    @property
    def head(self) -> Span:
        """Where the document's values begin."""
        root = self.document.root
        entry = root.entries.get("parameters") or root.entries.get("component")
        return entry[0].span if entry else Span(root.file)

    def layers(self) -> list[Self]:
        """This document and all that it builds on: the most general first, each once, this one last."""
        below = [layer for base in self.extends for layer in base.layers()]
        return list(dict.fromkeys([*below, self]))
