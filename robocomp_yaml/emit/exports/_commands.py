"""What every form needs of a process: its words, and its name as a file's."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.network.network import CONFIG, Network, Process


def without_config(process: Process) -> tuple[str, ...]:
    """The program and its arguments but for that which names its configuration."""
    program, *arguments = process.command
    return program, *(word for word in arguments if CONFIG not in word)


def file_name(name: str) -> str:
    """A name for files, units and the like: members of a group have dots in theirs."""
    return re.sub(r"[^A-Za-z0-9_.-]", "_", name)


def by_host(network: Network) -> Iterator[tuple[str, list[Process]]]:
    """The processes of each host, with the folder that its files stand in: '' where there is one host only."""
    used = dict.fromkeys(process.host for process in network.processes.values())
    for host in used:
        folder = f"{file_name(host)}/" if len(used) > 1 else ""
        yield folder, [process for process in network.processes.values() if process.host == host]


def configs(folder: str, processes: list[Process]) -> dict[str, str]:
    """The configurations of processes, below a folder."""
    return {f"{folder}{process.config.path}": process.config.text for process in processes if process.config}
