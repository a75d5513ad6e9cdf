"""The components that a legacy network may start: those of the same run, and documents that are there already."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml.legacy.convert import Converted
from robocomp_yaml.legacy.document import data
from robocomp_yaml.legacy.draft import ComponentDraft
from robocomp_yaml.legacy.networks.command import NodeCommand
from robocomp_yaml.source.discover import of_kind
from robocomp_yaml.source.heading import root_of


class KnownComponent(msgspec.Struct, frozen=True):
    """A component's document at `path`; `implements` and `requires` are interfaces, the latter by proxy name."""

    name: str
    path: str
    implements: tuple[str, ...] = ()
    requires: Mapping[str, str] = {}


def of_run(files: Iterable[Converted], chosen: Mapping[str, str]) -> list[KnownComponent]:
    """Those that this run writes."""
    return [
        _known(chosen[file.path], data(file.draft.document))
        for file in files if isinstance(file.draft, ComponentDraft)
    ]  # fmt: skip


def of_folder(folder: str, but: Iterable[str]) -> list[KnownComponent]:
    """Those that stand below a folder, but for these paths."""
    skipped = {os.path.normpath(path) for path in but}
    found = []
    for path in of_kind(folder, "cdsl"):
        if path not in skipped:
            root = root_of(path)
            if root is not None and isinstance(root.data, dict):
                found.append(_known(path, root.data))
    return found


def match(command: NodeCommand, known: Iterable[KnownComponent]) -> KnownComponent | None:
    """The component that a command runs, by its name; of several, the one in the folder where it runs, else none."""
    same = [component for component in known if component.name.lower() == command.stem.lower()]
    if len(same) > 1:
        place = posixpath.normpath(command.folder).split("/")
        same = [item for item in same if os.path.basename(os.path.dirname(os.path.abspath(item.path))) in place]
    return same[0] if len(same) == 1 else None


def _known(path: str, content: Mapping[str, object]) -> KnownComponent:
    implements, requires = content.get("implements"), content.get("requires")
    needed: dict[str, str] = {}
    for item in requires if isinstance(requires, list) else []:
        for name, interface in item.items() if isinstance(item, dict) else [(item, item)]:
            told = interface.get("interface", name) if isinstance(interface, dict) else interface
            needed[str(name)] = str(told).rpartition(".")[2]
    served = implements if isinstance(implements, list) else []
    names = [str(next(iter(item), "")) if isinstance(item, dict) else str(item) for item in served]
    return KnownComponent(
        str(content.get("component", "")), path, tuple(name.rpartition(".")[2] for name in names), needed
    )
