"""The components that a legacy network may start: those of the same run, and existing documents."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.legacy.convert import Converted
from robocomp_yaml.legacy.document import data
from robocomp_yaml.legacy.draft import ComponentDraft
from robocomp_yaml.link import options
from robocomp_yaml.source.discover import of_kind
from robocomp_yaml.source.heading import root_of
from robocomp_yaml.source.rcremote import NodeCommand

_PROGRAMS = ("bin", "src")
"""The folders of a component that contain its program."""


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
    """Return the component that a command starts: by its name, and by the folder in which its program is. Of several
    with the same name, it is the one in the folder of the command; if none has the name, the only one in the folder of
    the program; else None."""
    all_known = list(known)
    same_name = [component for component in all_known if component.name.lower() == command.stem.lower()]
    if len(same_name) > 1:
        folders = posixpath.normpath(command.folder).split("/")
        same_name = [each for each in same_name if os.path.abspath(each.path).split("/")[-2] in folders]
    if same_name:
        return same_name[0] if len(same_name) == 1 else None
    path = posixpath.normpath(posixpath.join(command.folder, command.program)).split("/")
    if len(path) < 3 or path[-2] not in _PROGRAMS:
        return None
    shared = [(_shared(os.path.dirname(os.path.abspath(each.path)), path[:-2]), each) for each in all_known]
    most = max((length for length, _ in shared), default=0)
    nearest = [component for length, component in shared if length == most > 0]
    return nearest[0] if len(nearest) == 1 else None


def _shared(folder: str, names: Sequence[str]) -> int:
    """Return how many names at the end of a folder's path are those of another path."""
    count = 0
    for mine, other in zip(reversed(folder.split("/")), reversed(names), strict=False):
        if mine != other or not mine:
            break
        count += 1
    return count


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
    listed = content.get("options")
    for option in listed if isinstance(listed, list) else []:
        added = options.meanings().get(str(option).lower())
        if added is not None:
            interfaces = tuple(dict.fromkeys((*interfaces, *added.interfaces["implements"])))
            required |= {name: name for name in added.interfaces["requires"] if name not in required}
    return KnownComponent(str(content.get("component", "")), path, interfaces, required)
