"""The options of a compile: what to emit, and where."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import WorkspaceSettings

if TYPE_CHECKING:
    from robocomp_yaml.addresses.table import PortTable


class EmitOptions(msgspec.Struct):
    """`output` is `-o DIR` or None. `below` are the requested folders, whose structure `-o` mirrors. `targets` are what
    to emit: everything if empty. `workspace_of` returns the workspace of a document, `ports` the ports of a component's
    workspace, which are computed only if a configuration does not set all of them. `only` selects components for a
    review of the user's files: interfaces and schemas are skipped. `standalone`: a component has all its files in its
    own folder, and shares none."""

    output: str | None
    below: Sequence[str]
    targets: frozenset[str]
    workspace_of: Callable[[str], WorkspaceSettings]
    ports: Callable[[LinkedComponent], PortTable]
    only: Callable[[LinkedComponent], bool] | None = None
    standalone: bool = False

    def emits(self, target: str) -> bool:
        """Whether a target is emitted."""
        return not self.targets or target in self.targets
