"""The layout of a component: the paths of its files, and of those that it shares with other components.

All components of a language have the same run time. The components of a workspace share one, in the workspace's
`runtime/`, and the Slice of interfaces, in `slice/`. A standalone component has both in its own folder: one outside of
a workspace, one compiled with `--standalone`, and one whose CommonBehavior is not that of RoboComp.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

import msgspec

from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.workspace import WorkspaceSettings
from robocomp_yaml.source.digest import digest

SETTINGS = "etc"
CONFIG, SOURCES = f"{SETTINGS}/config", "src"
GENERATED, SLICE = "generated", "slice"
STATED = "Made for Slice"


class Layout(msgspec.Struct, frozen=True):
    """`slice` is the folder of the component's Slice, `runtime` that of its language's run time, both relative to the
    component's folder, with '/'. `made_for` is the fingerprint of the Slice for which the component is generated; ''
    if it has its own Slice, which cannot differ."""

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


def runtime_folder(workspace: WorkspaceSettings, target: TargetLanguage) -> str:
    """The folder of the run time of a language that the components of a workspace share."""
    return os.path.normpath(os.path.join(workspace.runtime_folder, target.name, target.runtime_root))


def fingerprint(texts: Mapping[str, str]) -> str:
    """The fingerprint of Slice files, by name."""
    return digest("\0".join(part for file in sorted(texts.items()) for part in file).encode())


def stated(fingerprint: str) -> str:
    """The sentence in generated code that names the Slice for which it was generated."""
    return f"{STATED} {fingerprint}."
