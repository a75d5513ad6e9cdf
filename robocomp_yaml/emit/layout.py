"""Where the files of a component are, relative to its folder, and where those are that it shares with others.

What is the same in all components of a language is its run time. The components of a workspace share one, in the
workspace's `runtime/`, and the Slice of its interfaces, in `slice/`. A component that stands alone has both in its own
folder: one outside of any workspace, one that is asked to, and one whose CommonBehavior is not RoboComp's.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

import msgspec

from robocomp_yaml.emit import runtime
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import WorkspaceSettings
from robocomp_yaml.source.digest import digest

SETTINGS = "etc"
CONFIG, SOURCES = f"{SETTINGS}/config", "src"
GENERATED, SLICE = "generated", "slice"
STATED = "Made for Slice"


class Layout(msgspec.Struct, frozen=True):
    """`slice` is the folder of the component's Slice, `runtime` that of its language's run time: both relative to the
    component's folder, with '/'. `made_for` tells the Slice that the component is generated for from others; '' where
    it has its own, which cannot differ."""

    slice: str = SLICE
    runtime: str = GENERATED
    made_for: str = ""

    @property
    def has_own_slice(self) -> bool:
        return self.slice == SLICE

    @property
    def has_own_runtime(self) -> bool:
        return self.runtime == GENERATED


ALONE = Layout()


def is_settings(path: str) -> bool:
    """Whether a file is in a component's folder of property files."""
    return os.path.basename(os.path.dirname(path)) == SETTINGS


def layout(linked: LinkedComponent, workspace: WorkspaceSettings, root: str, slices: str, made_for: str) -> Layout:
    """Where the parts of a component are whose folder is `root`, if it may share them. `slices` is the folder that the
    Slice of all its modules goes to, which has the fingerprint `made_for`; '' where there is none."""
    target = linked.component.language.target
    if not (workspace.declared and target.runtime and runtime.has_common(linked)):
        return ALONE
    shared = runtime_folder(workspace, target)
    if not slices:
        return Layout(SLICE, _from(root, shared))
    return Layout(_from(root, slices), _from(root, shared), made_for)


def runtime_folder(workspace: WorkspaceSettings, target: TargetLanguage) -> str:
    """Where the run time of a language stands that the components of a workspace share."""
    return os.path.normpath(os.path.join(workspace.runtime_folder, target.name, target.runtime_root))


def fingerprint(texts: Mapping[str, str]) -> str:
    """Of Slice, by the names of its files."""
    return digest("\0".join(part for file in sorted(texts.items()) for part in file).encode())


def stated(fingerprint: str) -> str:
    """How generated code says which Slice it was made for."""
    return f"{STATED} {fingerprint}."


def _from(root: str, folder: str) -> str:
    return os.path.relpath(folder, root or ".").replace(os.sep, "/")
