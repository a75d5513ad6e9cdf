"""What a process is started with: the network's description of it, and the digests of its files at that time.

An engine keeps the spec of each process that it started. A plan compares it, field by field, with the current network.
"""

from __future__ import annotations

from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml.deploy.here import folder_on, is_behind, is_here
from robocomp_yaml.network.network import Network, NetworkHost, Process
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import content

_NOT_KEPT = ("span", "own_span", "extra", "build")
_FORMER = {"explicit"}
"""Fields of earlier versions that did not change how a process runs."""


class ProcessSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`command` is the command of the process with the path of its configuration. `digests` are those of the watched
    files here, '' for a missing one; all other paths are those on the host. `is_behind` is True for a host that ssh
    reaches at a port of this machine. A spec contains the text of the configuration, and so secrets: only the owner may
    read it."""

    process: Process
    address: str
    command: tuple[str, ...]
    config_path: str
    digests: tuple[tuple[str, str], ...] = ()
    is_behind: bool = False

    @property
    def name(self) -> str:
        return self.process.name

    @property
    def config_files(self) -> dict[str, str]:
        """The texts of its configuration's files, by their paths in the deployment's folder."""
        return self.process.config.files if self.process.config else {}

    def as_data(self) -> dict[str, Any]:
        """The spec in types of JSON, which `of_data` reads."""
        data: dict[str, Any] = msgspec.to_builtins(self)
        for part in (data["process"], *data["process"]["endpoints"]):
            for name in _NOT_KEPT:
                part.pop(name, None)
        return data

    @classmethod
    def of_data(cls, data: dict[str, Any]) -> ProcessSpec | None:
        """The spec; None if another version of rcyaml wrote the data, or if they are damaged."""
        try:
            process = {name: value for name, value in data["process"].items() if name not in _FORMER}
            return msgspec.convert({**data, "process": process}, cls)
        except (ValueError, LookupError, TypeError, AttributeError):
            return None


def spec_of(network: Network, process: Process, digests: dict[str, str]) -> ProcessSpec:
    """The spec with which the process would be started now. `digests` caches digests by path."""
    for path in process.watched:
        if path not in digests:
            digests[path] = _digest_of(path)
    host = network.hosts[process.host]
    there = process if not host.folders or is_here(host) else _on(host, process)
    config = f"{folder_on(host, network.folder)}/{process.config.path}" if process.config else ""
    return ProcessSpec(
        there,
        host.address,
        there.words(config),
        config,
        tuple((path, digests[path]) for path in process.watched),
        is_behind(host),
    )


def _on(host: NetworkHost, process: Process) -> Process:
    """The process with the paths of its files on its host. The texts of its user, such as arguments, stay."""
    program, *arguments = process.command
    env = (replace(one, file=host.there(one.file)) if one.file.startswith("/") else one for one in process.env)
    config = process.config
    for path in process.folders:  # an IceStorm's configuration has the path of its database
        if config:
            config = replace(config, text=config.text.replace(path, host.there(path)))
    return replace(
        process,
        command=(host.there(program) if program.startswith("/") else program, *arguments),
        cwd=host.there(process.cwd),
        env=tuple(env),
        config=config,
        folders=tuple(map(host.there, process.folders)),
    )


def _digest_of(path: str) -> str:
    """The digest of a file, '' if it cannot be read. Special files are never opened, because they can block."""
    raw = content(path)
    return digest(raw) if raw is not None else ""
