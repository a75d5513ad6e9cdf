"""Obstacles: what would prevent a process from starting on this machine. Also the environment of a process."""

from __future__ import annotations

import functools
import os
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

from robocomp_yaml.deploy import interfaces, limits
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import DeployFailed
from robocomp_yaml.deploy.folder import document_in
from robocomp_yaml.deploy.here import is_here
from robocomp_yaml.deploy.local import procfs, program
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.network.draft import MANAGER, PUBLISH
from robocomp_yaml.network.network import FOLDER, ICESTORM, RUNS, Network, Process

_VALID = 2.0  # seconds for which a check without obstacles is valid


def environment_of(process: Process) -> dict[str, str]:
    """The operator's environment with the variables of the process, except those from files. Python programs get
    PYTHONUNBUFFERED, so that their output is seen immediately."""
    own = {
        variable.name: os.environ.get(variable.source, "") if variable.source else variable.value
        for variable in process.env
        if not variable.file
    }
    return {"PYTHONUNBUFFERED": "1", **os.environ, **own}


def whole_environment_of(process: Process) -> dict[str, str]:
    """The environment of the process as it would start now. Raises OSError if a file of a variable cannot be read."""
    return environment_of(process) | program.variables((one.name, one.file) for one in process.env if one.file)


def obstacles(specs: Sequence[ProcessSpec], own: Collection[int]) -> list[Diagnostic]:
    """The obstacles of all these processes. `own` are pids that are ignored, because they will have ended before."""
    ports = {e.port for spec in specs for e in spec.process.listening if e.protocol != "udp"}
    taken = {
        port: [pid for pid in pids if pid not in own]
        for port, pids in procfs.listeners(ports).items()
        if not pids or not set(pids) <= set(own)
    }
    reason = functools.cache(_reason)  # many processes have the same program
    found = [found for spec in specs for found in (*_of_program(spec, reason), *_of_ports(spec, taken))]
    return [*found, *limits.denied(specs)]


class CheckedSpecs:
    """Specs that have just been checked: if they start immediately, they need not be checked again."""

    def __init__(self) -> None:
        self._specs: dict[str, ProcessSpec] = {}
        self._until = 0.0

    def note(self, specs: Iterable[ProcessSpec]) -> None:
        # A process that waits for others is checked again: they may use its port by then.
        self._specs = {spec.name: spec for spec in specs if not (spec.process.after and spec.process.listening)}
        self._until = time.monotonic() + _VALID

    def require(self, spec: ProcessSpec) -> None:
        """Raises DeployFailed if a spec has an obstacle. A spec in the list is not checked, once. If the list is too
        old, all its specs are checked again together: to find out who listens costs the same for one and for all."""
        is_noted = self._specs.get(spec.name) is spec
        if is_noted and time.monotonic() >= self._until and not obstacles([*self._specs.values()], ()):
            self._until = time.monotonic() + _VALID
        is_checked = is_noted and time.monotonic() < self._until
        self._specs.pop(spec.name, None)
        if not is_checked and (found := obstacles([spec], ())):
            raise DeployFailed(found[0])


def elsewhere(network: Network) -> Diagnostic | None:
    """A diagnostic for the first process that runs on another machine; None if all run on this one."""
    for process in network.enabled():
        host = network.hosts[process.host]
        if not is_here(host):
            where = host.span if host.span.file else process.span
            return deploying.OTHER_MACHINE.at(where, name=process.name, host=host.name, address=host.address)
    return None


def _of_ports(spec: ProcessSpec, taken: dict[int, list[int]]) -> Iterator[Diagnostic]:
    """One diagnostic for each program that uses a port of the process, at its first such port."""
    reported: set[int] = set()
    for endpoint in spec.process.listening:
        if endpoint.port in taken and endpoint.protocol != "udp":
            pid = next(iter(taken[endpoint.port]), 0)
            if pid in reported:
                continue
            reported.add(pid)
            who, how = _owner(pid)
            other = f"choose another port for '{spec.name}'"
            if spec.process.kind == ICESTORM:  # its publishers have a port of their own
                keys = {MANAGER: "port", PUBLISH: "publish"}
                used = [keys[one.interface] for one in spec.process.endpoints if pid in taken.get(one.port, ())]
                which = ", ".join(f"{key}: PORT" for key in used or [keys[endpoint.interface]])
                other = f"give '{spec.name}' other ports: `icestorm: {{{which}}}`"
            yield deploying.PORT_TAKEN.at(
                endpoint.span if endpoint.span.file else spec.process.span,
                hint=f"{how}, or {other}" if how else "",
                name=spec.name, port=endpoint.port, program=who,
            )  # fmt: skip


def _owner(pid: int) -> tuple[str, str]:
    """The process that uses a port, and how to end it: a process of a deployment would be restarted."""
    if not pid:
        return "a program of another user", ""
    owner, _, name = procfs.mark_of(pid).rpartition(":")
    folder, _, deployment = owner.rpartition(f"/{FOLDER}/")
    above, _, _ = owner.rpartition(f"/{RUNS}/")
    if above:
        who = f"'{name}' of `rcyaml run` in {shown_path(above)} (pid {pid})"
        return who, "end it there with Ctrl-C"
    if not folder:
        return f"{procfs.command_line(pid)} (pid {pid})", f"end it (`kill {pid}`)"
    who = f"'{name}' of the deployment {deployment} in {shown_path(folder)} (pid {pid})"
    down = typed("rcyaml", "deploy", "down", shown_path(document_in(folder, deployment)))
    return who, f"take that deployment down (`{down}`)"


def unset(process: Process) -> Iterator[Diagnostic]:
    """A diagnostic for each variable of the operator's environment that a process reads, and that is not set."""
    for variable in process.env:
        if variable.source and variable.source not in os.environ:
            yield deploying.UNSET_VARIABLE.at(
                process.span, hint=f"export {variable.source}=…", name=process.name, variable=variable.source
            )


def _of_program(spec: ProcessSpec, reason: Callable[[str, str, str], str]) -> Iterator[Diagnostic]:
    process = spec.process
    yield from unset(process)
    try:
        environment = whole_environment_of(process) if process.env else os.environ
        why_not = reason(spec.command[0], process.cwd or "/", environment.get("PATH", os.defpath))
    except OSError as error:
        why_not = reason_of(error)
    if why_not:
        hint = "" if os.path.lexists(spec.command[0]) else process.build
        yield deploying.CANNOT.at(process.span, hint=hint, name=spec.name, what="started", reason=why_not)
    if found := interfaces.obstacle(spec):
        yield found


def _reason(command: str, folder: str, path: str) -> str:
    """Why a program cannot be run in a folder, '' if it can."""
    if not os.path.isdir(folder):
        return f"its folder '{folder}' does not exist"
    try:
        program.find(command, folder, {"PATH": path})
    except OSError as error:
        return reason_of(error)
    return ""
