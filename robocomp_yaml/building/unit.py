"""A component as it is built: where it stands, what it is made of, and what comes of it."""

from __future__ import annotations

import os
from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit.component import source_folders
from robocomp_yaml.emit.layout import GENERATED, SLICE, SOURCES, runtime_folder
from robocomp_yaml.emit.slice import file_name
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import Workspace, named_from_here


class Unit(msgspec.Struct, frozen=True):
    """`document`, `folder` and `root` are as the user named them; `root` is the workspace's, or the component's own
    where it is in none (`is_alone`). `runtime` is the run time that it shares, '' for its own; `slices` are the Slice
    files that it needs, `sources` what it names under `uses:`."""

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
        """What is started."""
        return self.path(self.language.program.format(name=self.name))

    @property
    def is_compiled(self) -> bool:
        return os.path.isdir(self.path(GENERATED)) and os.path.isdir(self.path(SOURCES))

    @property
    def command(self) -> str:
        """How its user has it built."""
        return typed("rcyaml", "build", named_from_here(self.name, self.document))

    def path(self, below: str) -> str:
        return os.path.normpath(os.path.join(self.folder, below))


def unit_of(linked: LinkedComponent, workspace: Workspace) -> Unit:
    component = linked.component
    folder = os.path.dirname(component.path) or "."
    target = component.language.target
    runtime = runtime_folder(workspace, target) if target.runtime and workspace.declared else ""
    return Unit(
        component.name,
        target,
        component.path,
        folder,
        workspace.root or "." if workspace.declared else folder,
        not workspace.declared,
        runtime if os.path.isdir(runtime) else "",
        tuple(_slices(linked, workspace, folder)),
        tuple(_sources(linked, workspace, folder)),
    )


def _slices(linked: LinkedComponent, workspace: Workspace, folder: str) -> Iterator[str]:
    """Its own, or those that it shares with others."""
    for module in linked.modules():
        name = file_name(module)
        own = os.path.join(folder, SLICE, name)
        if os.path.lexists(own):
            yield os.path.normpath(own)
        elif workspace.declared:
            yield os.path.normpath(os.path.join(workspace.slice_folder, name))


def _sources(linked: LinkedComponent, workspace: Workspace, folder: str) -> Iterator[str]:
    """The files and folders of the repository that are compiled with it, where they are there."""
    component = linked.component
    for source in component.sources:
        if source.kind not in component.language.target.has:
            continue
        heads = ("", "classes", "Classes") if source.is_class else ("",)
        places = source_folders(linked, workspace, folder)
        below = [os.path.join(folder, place, head) for place in places for head in heads]
        paths = (os.path.normpath(os.path.join(place, source.path)) for place in below)
        found = next(filter(os.path.exists, paths), None)
        if found is not None:
            yield found
