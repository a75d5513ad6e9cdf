"""The files that a process needs on its host: its program with the user's libraries that it loads, its code, and what
it shares with others of its workspace.

They do not include configurations, which a deployment writes, nor the user's data.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from robocomp_yaml.link import workspace
from robocomp_yaml.network import shared_libraries
from robocomp_yaml.network.network import COMPONENT, Network, Process

SYSTEM = re.compile(r"/(?:(?:bin|boot|dev|etc|lib|lib32|lib64|proc|run|sbin|sys|usr)(?:/|\Z)|\Z)")
"""Folders of the system, which a deployment does not bring to other machines."""
_GENERATED = "generated"


def home_of(process: Process) -> str:
    """The folder of a component, of a program that of its file; '' for a program that is looked up in PATH."""
    home = os.path.dirname(process.command[0]) if os.path.isabs(process.command[0]) else ""
    is_component = process.kind == COMPONENT and os.path.basename(home) == "bin"
    return os.path.dirname(home) if is_component else home


def shared_folders(home: str) -> list[str]:
    """The folders that a component in Python reads when it starts, and shares with other components of its workspace. A
    program that was built contains what it needs."""
    if not os.path.isfile(os.path.join(home, _GENERATED, "component.py")):
        return []
    root = workspace.root_above(home)
    if root is None or os.path.isdir(os.path.join(home, _GENERATED, "runtime")):
        return []
    shared, _ = workspace.read(root)
    folders = (os.path.abspath(folder) for folder in (shared.runtime_folder, shared.slice_folder))
    return [folder for folder in folders if os.path.isdir(folder)]


def needed(process: Process, known: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """The files of a process, as absolute paths. A missing program is one of them. `known` caches folders, and the
    libraries of programs."""
    program = process.command[0]
    own = [program] if os.path.isabs(program) and not SYSTEM.match(program) else []
    if own and program not in known:
        searched = next((one.value.split(":") for one in process.env if one.name == "LD_LIBRARY_PATH"), [])
        known[program] = tuple(shared_libraries.of(program, SYSTEM.match, searched))
    own += known.get(program, ())
    for folder in shared_folders(home_of(process)):
        if folder not in known:
            known[folder] = tuple(_below(folder))
        own += known[folder]
    return tuple(dict.fromkeys((*own, *process.watched))) if own else ()


def on_host(network: Network, host: str) -> dict[str, tuple[str, ...]]:
    """The files of all processes of a host, each with the names of the processes that need it."""
    known: dict[str, tuple[str, ...]] = {}
    found: dict[str, tuple[str, ...]] = {}
    for process in network.enabled():
        for path in needed(process, known) if process.host == host else ():
            found[path] = (*found.get(path, ()), process.name)
    return found


def _below(folder: str) -> Iterator[str]:
    for where, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name != "__pycache__" and not name.startswith("."))
        yield from (os.path.join(where, name) for name in sorted(names) if not name.startswith("."))
