"""What a process is started with: the network's description of it, and what its files held at that time.

An engine keeps the spec of each process that it started; a plan compares it, field by field, with what the network
says now.
"""

from __future__ import annotations

from typing import Any

import msgspec

from robocomp_yaml.network.network import Network, Process
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import regular

_NOT_KEPT = ("span", "extra", "build")


class ProcessSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`command` is the process's own with the path of its configuration put in. `digests` are those of the watched
    files, '' for one that is not there. Holds the text of the configuration: keep it where only its owner can read."""

    process: Process
    address: str
    command: tuple[str, ...]
    config_path: str
    digests: tuple[tuple[str, str], ...] = ()

    @property
    def name(self) -> str:
        return self.process.name

    def as_data(self) -> dict[str, Any]:
        """As JSON's types; what `of_data` reads."""
        data: dict[str, Any] = msgspec.to_builtins(self)
        for part in (data["process"], *data["process"]["endpoints"]):
            for name in _NOT_KEPT:
                part.pop(name, None)
        return data

    @classmethod
    def of_data(cls, data: dict[str, Any]) -> ProcessSpec | None:
        """None where another version of rcyaml wrote the data."""
        try:
            return msgspec.convert(data, cls)
        except ValueError:
            return None


def spec_of(network: Network, process: Process, digests: dict[str, str]) -> ProcessSpec:
    """What the process would be started with now. `digests` remembers files that were looked at already."""
    for path in process.watched:
        if path not in digests:
            digests[path] = _digest_of(path)
    config = network.config_path(process)
    return ProcessSpec(
        process,
        network.address(process),
        process.words(config),
        config,
        tuple((path, digests[path]) for path in process.watched),
    )


def _digest_of(path: str) -> str:
    """'' where there is no file, or none that can be read. Special files are never opened: they may block."""
    try:
        with open(path, "rb", opener=regular) as file:
            return digest(file.read())
    except OSError:
        return ""
