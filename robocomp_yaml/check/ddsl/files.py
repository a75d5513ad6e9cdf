"""Whether the executables, programs and folders of a network exist, for processes on this machine.

`check` reports missing ones as warnings, because a fresh checkout has no builds; `deploy` requires them.
"""

from __future__ import annotations

import os
import shutil
import socket
from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.deployment import CONFIG
from robocomp_yaml.network.network import ICESTORM, Network, Process, is_loopback


def missing(network: Network, *, environment: bool = False) -> Iterator[Diagnostic]:
    """A warning for each process that cannot be started. With `environment`, programs are also looked up in PATH."""
    local = {name for name, host in network.hosts.items() if is_this_machine(host.address)}
    for process in network.enabled():
        program = process.command[0]
        if process.host not in local or CONFIG in program:  # reported as an error already
            continue
        if process.component and not os.path.lexists(program):
            yield codes.NOT_BUILT.at(process.span, name=process.name, path=_shown(program), hint=process.build)
        elif problem := _problem(process, program, environment):
            yield codes.NO_PROGRAM.at(process.span, name=process.name, problem=problem, hint=_hint(process))


def is_this_machine(address: str) -> bool:
    """Whether an address is one of this machine. Host names are compared, not resolved."""
    if is_loopback(address) or address == socket.gethostname():
        return True
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    try:
        packed = socket.inet_pton(family, address)
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.bind((socket.inet_ntop(family, packed), 0))
    except OSError:
        return False
    return True


def _problem(process: Process, program: str, environment: bool) -> str:
    if "/" in program:
        if os.path.isdir(program):
            return f"{_shown(program)} is a folder"
        if not os.path.exists(program):
            return f"there is no {_shown(program)}"
        if not os.access(program, os.X_OK):
            return f"{_shown(program)} is not executable"
    elif environment:
        path = next((variable.value for variable in process.env if variable.name == "PATH"), None)
        if shutil.which(program, path=path) is None:
            return f"PATH finds no '{program}'"
    # rcyaml creates the folder of an IceStorm when it starts the deployment
    if process.kind != ICESTORM and not os.path.isdir(process.cwd):
        return f"there is no folder {_shown(process.cwd)} to run in"
    return ""


def _hint(process: Process) -> str:
    if process.kind == ICESTORM:
        return "install Debian's zeroc-icebox and libzeroc-icestorm3.7"
    program = process.command[0]
    if os.path.isfile(program) and not os.access(program, os.X_OK):
        return f"`chmod +x {_shown(program)}`"
    return ""


def _shown(path: str) -> str:
    """A path relative to the current folder, if it is below it."""
    relative = os.path.relpath(path)
    return path if relative.startswith("..") else relative
