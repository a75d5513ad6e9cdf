"""What a process is started with: the network's description of it, and what its files held at that time.

An engine keeps the spec of each process that it started; a plan compares it, field by field, with what the network
says now.
"""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass, fields
from typing import Any

from robocomp_yaml.network.network import CONFIG, ConfigFile, Endpoint, Network, Process, Readiness, Restart, Variable
from robocomp_yaml.source.digest import digest

_NOT_KEPT = ("span", "extra")


@dataclass(frozen=True, slots=True)
class Spec:
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
        process = {key: value for key, value in asdict(self.process).items() if key not in _NOT_KEPT}
        process["endpoints"] = [
            {key: value for key, value in endpoint.items() if key not in _NOT_KEPT}
            for endpoint in process["endpoints"]
        ]
        data = {key: getattr(self, key) for key in ("address", "command", "config_path", "digests")}
        return {"process": process, **data}

    @classmethod
    def of_data(cls, data: dict[str, Any]) -> Spec:
        """Raises KeyError, TypeError or ValueError where another version of rcyaml wrote the data."""
        process = dict(data["process"])
        known = {field.name for field in fields(Process)}
        if unknown := set(process) - known:
            raise ValueError(f"no fields of a process: {sorted(unknown)}")
        config = process["config"]
        process.update(
            env=tuple(Variable(**entry) for entry in process["env"]),
            config=ConfigFile(**config) if config else None,
            endpoints=tuple(Endpoint(**entry) for entry in process["endpoints"]),
            ready=_readiness(process["ready"]),
            restart=Restart(**process["restart"]),
        )
        for key in ("command", "after", "watched", "folders", "aliases", "groups"):
            process[key] = tuple(process[key])
        digests = tuple((path, hash_) for path, hash_ in data["digests"])
        return cls(Process(**process), data["address"], tuple(data["command"]), data["config_path"], digests)


def spec_of(network: Network, process: Process, digests: dict[str, str]) -> Spec:
    """What the process would be started with now. `digests` remembers files that were looked at already."""
    for path in process.watched:
        if path not in digests:
            digests[path] = _digest_of(path)
    config = network.config_path(process)
    return Spec(
        process,
        network.address(process),
        tuple(part.replace(CONFIG, config) for part in process.command),
        config,
        tuple((path, digests[path]) for path in process.watched),
    )


def _readiness(data: dict[str, Any]) -> Readiness:
    return Readiness(**{**data, "pings": tuple(data["pings"]), "command": tuple(data["command"])})


def _digest_of(path: str) -> str:
    """'' where there is no file, or none that can be read. Special files are never opened: they may block."""
    if not os.path.isfile(path):
        return ""
    try:
        with open(path, "rb") as file:
            return digest(file.read())
    except OSError:
        return ""
