"""What a compile is asked to emit, and where to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import Workspace

if TYPE_CHECKING:
    from robocomp_yaml.emit.ports import PortTable


class EmitOptions(msgspec.Struct):
    """`output` is `-o DIR` or None; `below` are the folders that were asked for (`-o` mirrors what lies below them);
    `targets` what to emit, all when empty; `workspace_of` the workspace of a document; `ports` those of a
    component's workspace (asked for only where its configuration leaves some open). `only` limits it to some
    components, for the user's own files there: interfaces and schemas are left out. `standalone`: components have
    all that they need in their own folders, instead of sharing it."""

    output: str | None
    below: Sequence[str]
    targets: frozenset[str]
    workspace_of: Callable[[str], Workspace]
    ports: Callable[[LinkedComponent], PortTable]
    only: Callable[[LinkedComponent], bool] | None = None
    standalone: bool = False

    def wants(self, target: str) -> bool:
        return not self.targets or target in self.targets
