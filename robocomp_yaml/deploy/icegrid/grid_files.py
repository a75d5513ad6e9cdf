"""The files of the IceGrid engine, and the address of its registry.

The deployment's folder has the same path on every host, unless `path:` of a host says otherwise. `state/icegrid`
contains the deployment's key, the registry's files, a folder for each node, the status files of the `run` scripts, and
the desired processes.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import socket
from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

import msgspec

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import openssl
from robocomp_yaml.deploy.here import folder_on, is_here
from robocomp_yaml.deploy.own_address import own_address, towards_address
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.network.network import NetworkHost, is_loopback

KEEPER = "rcyaml.keeper"
"""The id of the keeper's server. No process can have this name."""

KEY, CERTIFICATE = "key.pem", "certificate.pem"
"""The names of the files with the deployment's key and certificate."""

Kind = TypeVar("Kind")
Missing = TypeVar("Missing")

_ROOT = "state/icegrid"
_ANSWERS_WITHIN = 1.0  # seconds
_DESIRED, _SPECS, _REGISTRY, _NODES, _RULES, _FOLDERS = (
    f"{_ROOT}/{name}.json" for name in ("wanted", "specs", "registry", "nodes", "rules", "folders")
)


class Registry(msgspec.Struct, frozen=True):
    """The address and the TCP port of a deployment's registry."""

    address: str
    port: int

    @property
    def listens(self) -> bool:
        """Whether something listens there: also a registry whose files were deleted."""
        try:
            with socket.create_connection((self.address, self.port), _ANSWERS_WITHIN):
                return True
        except OSError:
            return False


class GridFiles(msgspec.Struct, frozen=True):
    """The files of the engine in a deployment's folder. Methods that write raise OSError."""

    folder: str

    def on(self, host: str) -> GridFiles:
        """The files on the host of this name."""
        folder = self._read(_FOLDERS, dict[str, str], {}).get(host, self.folder)
        return GridFiles(folder) if folder != self.folder else self

    def keep_folders(self, hosts: Iterable[NetworkHost]) -> None:
        """Keeps the folders that the deployment has on these hosts, and on those that were used before."""
        known = self._read(_FOLDERS, dict[str, str], {})
        folders = {host.name: folder_on(host, self.folder) for host in hosts}
        if any(known.get(name, self.folder) != path for name, path in folders.items()):
            self._write(_FOLDERS, known | folders)

    @property
    def root(self) -> str:
        return f"{self.folder}/{_ROOT}"

    @property
    def registry_folder(self) -> str:
        return f"{self.root}/registry"

    @property
    def key(self) -> str:
        return f"{self.root}/{KEY}"

    @property
    def certificate(self) -> str:
        return f"{self.root}/{CERTIFICATE}"

    def status(self, name: str) -> str:
        return f"{self.root}/status/{name}"

    def rule(self, name: str) -> str:
        """The path of a restart rule that is newer than the start of `run`."""
        return f"{self.root}/rules/{name}"

    def next_rule(self) -> int:
        """A number for a new rule, higher than those of all earlier rules."""
        number = self._read(_RULES, int, 0) + 1
        self._write(_RULES, number)
        return number

    def log(self, name: str) -> str:
        return f"{self.folder}/logs/{name}.log"

    def registry(self) -> Registry | None:
        return self._read(_REGISTRY, Registry, None)

    def keep_registry(self, registry: Registry) -> None:
        self._write(_REGISTRY, {"address": registry.address, "port": registry.port})

    def desired(self) -> set[str]:
        """The names of the processes that should run, whatever happens to their nodes."""
        return set(self._read(_DESIRED, list[str], []))

    def keep_desired(self, names: Iterable[str]) -> None:
        self._write(_DESIRED, sorted(names))

    def nodes(self) -> dict[str, bool]:
        """The hosts that had a node after the last `up`, with whether rcyaml started it, and therefore ends it. A node
        can also be started by hand."""
        return self._read(_NODES, dict[str, bool], {})

    def keep_nodes(self, nodes: Mapping[str, bool]) -> None:
        self._write(_NODES, dict(nodes))

    def specs(self) -> dict[str, ProcessSpec | None]:
        """The specs of the processes; None for one that another version of rcyaml wrote."""
        return {
            name: ProcessSpec.of_data(data) for name, data in self._read(_SPECS, dict[str, dict[str, Any]], {}).items()
        }

    def keep_specs(self, specs: dict[str, ProcessSpec | None]) -> None:
        kept = self._read(_SPECS, dict[str, dict[str, Any]], {})
        self._write(_SPECS, {name: spec.as_data() if spec else kept.get(name) for name, spec in specs.items()})

    def drop_configurations(self, *, with_key: bool) -> None:
        """Removes all that contains a configuration, after the registry has ended; `with_key` also the key. Without
        the key, the registry gets another port, too."""
        for name in ("registry/data", "rules") + (("hosts", "nodes") if with_key else ()):
            shutil.rmtree(f"{self.root}/{name}", ignore_errors=True)
        own_folder.remove(self.folder, _SPECS)
        openssl.remove_unfinished(self.root)
        if with_key:
            for path in (self.key, self.certificate, f"{self.folder}/{_REGISTRY}"):
                with contextlib.suppress(OSError):
                    os.unlink(path)
        with contextlib.suppress(OSError):
            for name in os.listdir(f"{self.folder}/config"):
                own_folder.remove(self.folder, f"config/{name}")

    @property
    def copied(self) -> list[str]:
        """The files that the user's list of deployments keeps, so that the deployment is reached without its folder."""
        return [f"{_ROOT}/key.pem", f"{_ROOT}/certificate.pem", _REGISTRY, _NODES, _SPECS, _DESIRED, _FOLDERS]

    def _read(self, path: str, kind: type[Kind], missing: Missing) -> Kind | Missing:
        """The content of a file; `missing` without a file, or with one in another format: of another version, or
        damaged."""
        try:
            with open(f"{self.folder}/{path}", encoding="utf-8") as file:
                return msgspec.convert(json.load(file), kind)
        except (FileNotFoundError, NotADirectoryError, ValueError):
            return missing

    def _write(self, path: str, data: Any) -> None:
        own_folder.write(self.folder, path, json.dumps(data))


def registry_address(hosts: Iterable[NetworkHost]) -> str:
    """The address of this machine for all these hosts: a loopback address if all are this machine, else the address of
    its own entry, else the address from which it reaches the first of the others."""
    every = list(hosts)
    others = [host.address for host in every if not is_here(host)]
    if not others:
        return "127.0.0.1"
    own = [host for host in every if host.address not in others and not is_loopback(host.address)]
    return (own_address(own[0], every) if own else "") or towards_address(others[0])


def free_port(address: str) -> int:
    with socket.create_server((address, 0)) as probe:
        port: int = probe.getsockname()[1]
        return port
