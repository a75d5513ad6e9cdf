"""The units of an installed deployment, as texts.

On the operator's machine, a service runs `boot`, which brings the deployment up with its engine: order, readiness,
restarts and limits are those of `up`. On each other host, a service runs the node of IceGrid, which starts what the
registry asks for as soon as that can be reached. The order of boots does not matter.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.deploy.engines import LOCAL
from robocomp_yaml.deploy.here import folder_on, is_here
from robocomp_yaml.emit.exports.systemd import UnitFile, folder, percent, plain, quoted
from robocomp_yaml.network.network import Network, NetworkHost

USER, SYSTEM = "user", "system"
OWN = "state/boot"
"""The folder, in the deployment's own, of the files that units refer to."""
_BOOT = "robocomp_yaml.deploy.install.boot"
# What the operator's programs may need to be found, in addition to the variables that the document names.
_KEPT = ("PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "ROBOCOMP", "RCYAML_PATH", "RCYAML_PYTHON", "RCYAML_LOG_LIMIT",
         "XDG_STATE_HOME", "LANG", "LC_ALL")  # fmt: skip


class HostUnit(msgspec.Struct, frozen=True):
    """The unit of a host: its name, the manager that starts it (USER or SYSTEM), its text, and further files by path,
    which only the owner can
    read. `notes` are what the user should know after it was written."""

    host: NetworkHost
    name: str
    manager: str
    text: str
    files: Mapping[str, str] = {}
    is_here: bool = True
    notes: tuple[str, ...] = ()


def target(manager: str) -> str:
    """What a manager starts at boot."""
    return "multi-user.target" if manager == SYSTEM else "default.target"


def name_of(network: Network, *, is_node: bool = False) -> str:
    return f"rcyaml-{network.name}{'-node' * is_node}.service"


def needed_variables(network: Network, host: str = "") -> list[str]:
    """The operator's variables that processes of a host read; of all hosts without one."""
    processes = [process for process in network.enabled() if host in ("", process.host)]
    return sorted({variable.source for process in processes for variable in process.env if variable.source})


def of_network(network: Network, engine: str, manager: str, user: str) -> list[HostUnit]:
    """The units of all hosts; the first one is that of this machine. `manager` overrides that of the hosts, '' does
    not."""
    used = {process.host for process in network.enabled()}
    hosts = [host for host in network.hosts.values() if host.name in used]
    near = next((host for host in hosts if is_here(host)), NetworkHost("this machine"))
    found = [_of_operator(network, near, engine, manager or near.systemd or USER, user)]
    for host in hosts if engine != LOCAL else ():
        if not is_here(host):
            found.append(_of_node(network, host, manager or host.systemd or USER))
    return found


def _of_operator(network: Network, host: NetworkHost, engine: str, manager: str, user: str) -> HostUnit:
    own = f"{network.folder}/{OWN}"
    unit = _head(network, manager, f"{network.name}, a deployment of rcyaml")
    unit.put("Type", "notify")
    unit.put("NotifyAccess", "main")
    words = [sys.executable, "-m", _BOOT, network.path, network.folder, engine]
    unit.put("ExecStart", " ".join(quoted(word, doubled="$") for word in words))
    unit.put("WorkingDirectory", folder(os.path.dirname(network.path)))
    unit.put("TimeoutStartSec", "infinity")
    unit.put("TimeoutStopSec", "90")
    names = sorted({*needed_variables(network), *_KEPT})
    values = {name: os.environ[name] for name in names if name in os.environ}
    _tail(unit, own, manager, user if manager == SYSTEM else "")
    return HostUnit(host, name_of(network), manager, unit.text, {f"{own}/environment": environment(values)})


def _of_node(network: Network, host: NetworkHost, manager: str) -> HostUnit:
    own = f"{folder_on(host, network.folder)}/{OWN}"
    unit = _head(network, manager, f"the node of {network.name} on {host.name}, of rcyaml")
    unit.put("Type", "exec")
    unit.put("ExecStart", " ".join(quoted(word, doubled="$") for word in ("/bin/bash", f"{own}/node")))
    unit.put("TimeoutStopSec", "30")
    values = {name: os.environ[name] for name in needed_variables(network, host.name) if name in os.environ}
    _tail(unit, own, manager, host.ssh.user if manager == SYSTEM else "")
    files = {f"{own}/environment": environment(values)}
    return HostUnit(host, name_of(network, is_node=True), manager, unit.text, files, is_here=False)


def _head(network: Network, manager: str, description: str) -> UnitFile:
    unit = UnitFile()
    unit.comment(f"Written by `rcyaml deploy install` for {network.path}")
    unit.section("Unit")
    unit.put("Description", plain(description))
    if manager == SYSTEM:
        unit.put("Wants", "network-online.target")
        unit.put("After", "network-online.target")
    unit.put("StartLimitIntervalSec", "0")
    unit.section("Service")
    return unit


def _tail(unit: UnitFile, own: str, manager: str, user: str) -> None:
    unit.put("EnvironmentFile", f"-{percent(own)}/environment")
    if user:
        unit.put("User", user)
    unit.put("Restart", "on-failure")
    unit.put("RestartSec", "2")
    unit.put("KillMode", "mixed")
    unit.section("Install")
    unit.put("WantedBy", target(manager))


def environment(values: Mapping[str, str]) -> str:
    """A file of variables for systemd, whose quotes keep all characters but four."""
    escapes = str.maketrans({char: f"\\{char}" for char in '"\\`$'})
    return "".join(f'{name}="{value.translate(escapes)}"\n' for name, value in values.items())


def script() -> str:
    """The script that writes and removes units on a host."""
    return resources.text("templates/install/units.sh")
