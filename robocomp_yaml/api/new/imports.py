"""The imports of a new component: the documents of the workspace that define its interfaces."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.link.workspace import read
from robocomp_yaml.pipeline import analyse, search_folders


def interface_folder(root: str) -> str:
    """The folder for new interfaces: the first one that the workspace declares."""
    declared = read(root)[0].interfaces
    return declared[0] if declared else os.path.join(root, "interfaces")


def interfaces_of(root: str, include: Sequence[str] = ()) -> dict[str, list[tuple[str, str]]]:
    """The interfaces and topics that documents of the workspace define: by name, the sorted (module, path) of each."""
    folders = [root, *read(root)[0].interfaces, *include]
    program = analyse([folder for folder in folders if os.path.isdir(folder)], include).program
    found: dict[str, set[tuple[str, str]]] = {}
    for linked in program.modules.values():
        for one in linked.module.all_interfaces:
            found.setdefault(one.name, set()).add((linked.module.name, linked.module.path))
    return {name: sorted(found[name]) for name in sorted(found)}


def imports_for(root: str, document: str, names: Sequence[str], include: Sequence[str] = ()) -> list[str]:
    """The imports that a component document needs for these interfaces. Raises Refused if one is unknown or
    ambiguous."""
    if not names:
        return []
    known = interfaces_of(root, include)
    paths = [_defining(name, known) for name in names]
    searched = {os.path.realpath(folder) for folder in _searched(root, include)}
    return list(dict.fromkeys(_spelled(path, document, searched) for path in paths))


def _searched(root: str, include: Sequence[str]) -> Iterator[str]:
    yield from read(root)[0].interfaces
    yield from search_folders(include)


def _defining(interface: str, known: dict[str, list[tuple[str, str]]]) -> str:
    """The document that defines an interface, named as `Interface` or `Module.Interface`."""
    module, _, name = interface.rpartition(".")
    candidates = [
        (defining, path)
        for defining, path in known.get(name, ())
        if not module or module in (defining, os.path.basename(path).removesuffix(".idsl.yaml"))
    ]
    if not candidates:
        hint = meant(name, known, "`rcyaml new interface NAME` writes one")
        raise Refused(f"no document of this workspace defines an interface '{interface}'{hint}")
    if len(candidates) > 1:
        named = " or ".join(f"{defining}.{name}" for defining, _ in candidates)
        raise Refused(f"several documents define an interface '{interface}': write {named}")
    return candidates[0][1]


def _spelled(path: str, document: str, searched: set[str]) -> str:
    """The text of an import: the name of the document if its folder is searched, else a relative path."""
    name = os.path.basename(path).removesuffix(".idsl.yaml")
    if os.path.realpath(os.path.dirname(path)) in searched:
        return name
    return os.path.relpath(os.path.join(os.path.dirname(path), name), os.path.dirname(document))
