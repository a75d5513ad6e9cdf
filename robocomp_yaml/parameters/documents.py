"""Linked documents of parameters and of values. `link` extends them with their components."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import TYPE_CHECKING, Any, Self, TypeVar

import msgspec

from robocomp_yaml.diag.span import Span

if TYPE_CHECKING:
    from robocomp_yaml.diag.diagnostic import Diagnostic
    from robocomp_yaml.parameters.specification.document import ParameterDocument, ValuesDocument
    from robocomp_yaml.parameters.types import Parameters

Made = TypeVar("Made")


class ResolvedParameters(msgspec.Struct, frozen=True, eq=False):
    """Parameters with their document, if they have one. `broken`: some have no valid type, so that values are not
    judged. `made` is what `once` returned: it depends on the parameters alone, and is kept as long as they are.
    `faults` are those of values documents."""

    parameters: Parameters
    document: ParameterDocument | None = None
    broken: bool = False
    made: dict[Hashable, Any] = {}
    faults: dict[LayeredValues, Sequence[Diagnostic]] = {}

    def once(self, name: Hashable, make: Callable[[], Made]) -> Made:
        """The result of `make`, cached by name: validators, for example."""
        if name not in self.made:
            self.made[name] = make()
        made: Made = self.made[name]
        return made


class LayeredValues(msgspec.Struct, frozen=True, eq=False):
    """A values document with the documents that it extends, the most general first. `parameters` is None if the
    component is unknown. `is_extended`: another document extends this one, so that this one may be incomplete.
    `broken`: a layer is missing."""

    document: ValuesDocument
    extends: tuple[Self, ...] = ()
    parameters: ResolvedParameters | None = None
    is_extended: bool = False
    broken: bool = False

    @property
    def head(self) -> Span:
        """The location of the first key of values, for diagnostics without a location of their own."""
        root = self.document.root
        entry = root.entries.get("parameters") or root.entries.get("component")
        return entry[0].span if entry else Span(root.file)

    def causes(self) -> tuple[object, ...]:
        """What its values depend on, as causes for a memory."""
        own = self.parameters
        of_parameters = (own.parameters, own.document, own.broken) if own is not None else None
        return of_parameters, *((layer.document, layer.is_extended, layer.broken) for layer in self.layers())

    def layers(self) -> list[Self]:
        """All layers, each once: the most general first, this document last."""
        below = [layer for base in self.extends for layer in base.layers()]
        return list(dict.fromkeys([*below, self]))
