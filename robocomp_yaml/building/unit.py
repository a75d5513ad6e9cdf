"""A component as it is built: its location, its inputs and its program."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice

import msgspec

from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit.component import source_folders
from robocomp_yaml.emit.layout import GENERATED, SLICE, SOURCES, runtime_folder
from robocomp_yaml.emit.slice import file_name
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import WorkspaceSettings, component_argument


class Unit(msgspec.Struct, frozen=True):
    """`document`, `folder` and `root` are relative to the working folder, as the user passed them. `root` is the folder
    of the workspace, or of a component without one (`is_alone`). `runtime` is the shared run time, '' if the component
    has its own; `slices` are the required Slice files, `sources` the existing files and folders of `uses:`."""

    name: str
    language: TargetLanguage
    document: str
    folder: str
    root: str
    is_alone: bool = False
    runtime: str = ""
    slices: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()

    @property
    def program(self) -> str:
        """The path of the program."""
        return self.path(self.language.program.format(name=self.name))

    @property
    def is_compiled(self) -> bool:
        return os.path.isdir(self.path(GENERATED)) and os.path.isdir(self.path(SOURCES))

    @property
    def command(self) -> str:
        """The command that builds the component."""
        return typed("rcyaml", "build", component_argument(self.name, self.document))

    def path(self, below: str) -> str:
        return os.path.normpath(os.path.join(self.folder, below))


def unit_of(linked: LinkedComponent, workspace: WorkspaceSettings) -> Unit:
    component = linked.component
    folder = os.path.dirname(component.path) or "."
    target = component.language.target
    runtime = runtime_folder(workspace, target) if target.runtime and workspace.declared else ""
    root = (workspace.root or ".") if workspace.declared else folder
    return Unit(
        component.name, target, component.path, folder, root, is_alone=not workspace.declared,
        runtime=runtime if os.path.isdir(runtime) else "",
        slices=tuple(_slices(linked, workspace, folder)), sources=tuple(_sources(linked, workspace, folder)),
    )  # fmt: skip


def _slices(linked: LinkedComponent, workspace: WorkspaceSettings, folder: str) -> Iterator[str]:
    """The Slice files of a component: its own, or those that the workspace shares."""
    for module in linked.modules():
        name = file_name(module)
        own = os.path.join(folder, SLICE, name)
        if os.path.lexists(own):
            yield os.path.normpath(own)
        elif workspace.declared:
            yield os.path.normpath(os.path.join(workspace.slice_folder, name))


def _sources(linked: LinkedComponent, workspace: WorkspaceSettings, folder: str) -> Iterator[str]:
    """The existing files and folders of the repository that are compiled with the component."""
    component = linked.component
    for source in component.sources:
        if source.kind not in component.language.target.has:
            continue
        heads = ("", "classes", "Classes") if source.is_class else ("",)
        places = source_folders(linked, workspace, folder)
        below = [os.path.join(folder, place, head) for place in places for head in heads]
        paths = (os.path.normpath(os.path.join(place, source.path)) for place in below)
        yield from islice(filter(os.path.exists, paths), 1)
