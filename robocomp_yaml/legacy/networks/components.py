"""The components that a legacy network may start: those of the same run, and existing documents."""

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
    """A component whose document is at `path`. `implements` are interfaces; `requires` are interfaces by proxy name."""

    name: str
    path: str
    implements: tuple[str, ...] = ()
    requires: Mapping[str, str] = {}


def of_run(files: Iterable[Converted], documents: Mapping[str, str]) -> list[KnownComponent]:
    """Return the components that a run writes. `chosen` are the paths of documents by the paths of files."""
    return [
        _known(documents[file.path], data(file.draft.document))
        for file in files if isinstance(file.draft, ComponentDraft)
    ]  # fmt: skip


def of_folder(folder: str, but: Iterable[str]) -> list[KnownComponent]:
    """Return the components below a folder, except those at the paths `but`."""
    skipped = {os.path.normpath(path) for path in but}
    found = []
    for path in of_kind(folder, "cdsl"):
        if path not in skipped:
            root = root_of(path)
            if root is not None and isinstance(root.data, dict):
                found.append(_known(path, root.data))
    return found


def match(command: NodeCommand, known: Iterable[KnownComponent]) -> KnownComponent | None:
    """Return the component that a command starts, by its name. Of several, it is the one in the folder of the command,
    else None."""
    same_name = [component for component in known if component.name.lower() == command.stem.lower()]
    if len(same_name) > 1:
        folders = posixpath.normpath(command.folder).split("/")
        same_name = [each for each in same_name if os.path.abspath(each.path).split("/")[-2] in folders]
    return same_name[0] if len(same_name) == 1 else None


def _known(path: str, content: Mapping[str, object]) -> KnownComponent:
    implements, requires = content.get("implements"), content.get("requires")
    required: dict[str, str] = {}
    for item in requires if isinstance(requires, list) else []:
        for name, interface in item.items() if isinstance(item, dict) else [(item, item)]:
            interface_name = interface.get("interface", name) if isinstance(interface, dict) else interface
            required[str(name)] = str(interface_name).rpartition(".")[2]
    served = implements if isinstance(implements, list) else []
    names = [str(next(iter(item), "")) if isinstance(item, dict) else str(item) for item in served]
    interfaces = tuple(name.rpartition(".")[2] for name in names)
    return KnownComponent(str(content.get("component", "")), path, interfaces, required)
