"""What all forms need of a process: its command, and its name for files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import msgspec

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.model.deployment import CONFIG
from robocomp_yaml.network import limit_words
from robocomp_yaml.network.network import Network, Process


def without_config(process: Process) -> tuple[str, ...]:
    """The program and its arguments, without the one that names its configuration."""
    program, *arguments = process.command
    return program, *(word for word in arguments if CONFIG not in word)


# It has no line break, because not every form can write one. The content of a file never becomes a part of it.
_READ_FILES = (
    'n=$(printf "\\n."); n=${n%.}; r=$(printf "\\r"); '
    'while [ "$1" != -- ]; do f=$2; case $f in "~/"*) f=${HOME:?}/${f#"~/"};; esac; '
    'v=$([ -f "$f" ] && cat -- "$f" && echo .) && [ "$(tr -d "\\000" <"$f" | wc -c)" -eq "$(wc -c <"$f")" ] || '
    '{ echo "the variable $1 is the text of $f, which cannot be read, or contains a NUL" >&2; exit 1; }; '
    'v=${v%.}; case $v in *"$r$n") v=${v%"$r$n"};; *"$n") v=${v%"$n"};; esac; '
    'export "$1=$v"; shift 2; done; shift; exec "$@"'
)


def with_files(process: Process, command: Iterable[str]) -> list[str]:
    """A command of a process with its variables from files, which a shell reads when the process starts."""
    files = [word for one in process.env if one.file for word in (one.name, one.file)]
    return ["/bin/sh", "-c", _READ_FILES, process.name, *files, "--", *command] if files else list(command)


def limited(process: Process, command: Iterable[str], form: str) -> list[str]:
    """A command of a process behind the programs that set its limits. What they cannot limit is noted."""
    if process.limits.cpu is not None:
        _unwritable.note(f"{form} cannot enforce `cpu: {process.limits.cpu} %`: systemd and compose can")
    return [*limit_words.words(msgspec.to_builtins(process.limits)), *command]


def file_name(name: str) -> str:
    """A name for files: characters other than letters, digits, `_`, `.` and `-` are replaced by `_`."""
    return re.sub(r"[^A-Za-z0-9_.-]", "_", name)


def by_host(network: Network) -> Iterator[tuple[str, list[Process]]]:
    """The processes of each host, with the folder for its files: '' if there is only one host."""
    used = dict.fromkeys(process.host for process in network.processes.values())
    for host in used:
        folder = f"{file_name(host)}/" if len(used) > 1 else ""
        yield folder, [process for process in network.processes.values() if process.host == host]


def configs(folder: str, processes: list[Process]) -> dict[str, str]:
    """The configurations of processes, by their paths below a folder."""
    return {f"{folder}{process.config.path}": process.config.text for process in processes if process.config}
