"""The push of a deployment: all hosts are compared first, and nothing is sent if one of them has a fault."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from robocomp_yaml.deploy.here import is_here
from robocomp_yaml.deploy.push import host_files, planned, sending
from robocomp_yaml.deploy.push.planned import HostPush
from robocomp_yaml.deploy.push.sending import Sent
from robocomp_yaml.deploy.ssh import HostFailed
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.network import files
from robocomp_yaml.network.network import Network, NetworkHost

T = TypeVar("T")
_PARALLEL = 8


def others(network: Network) -> list[NetworkHost]:
    """The other machines on which processes of the network run."""
    used = {process.host for process in network.enabled()}
    return [host for host in network.hosts.values() if host.name in used and not is_here(host)]


def compared(
    network: Network, hosts: Sequence[NetworkHost], names: Collection[str]
) -> tuple[list[HostPush], list[Diagnostic]]:  # fmt: skip
    """What is to be pushed to these hosts; if there are `names`, of these processes only."""

    def work(host: NetworkHost) -> tuple[HostPush, list[Diagnostic]]:
        own = files.on_host(network, host.name)
        if names:
            own = {path: used for path, used in own.items() if set(used) & set(names)}
        runs = {host.there(path): path for path, used in own.items() if path in planned.programs(network, used)}
        there = host_files.ask(network, host, runs, (host.there(path) for path in own if host.there(path) not in runs))
        push, faults = planned.plan(network, host, own, there, whole=not names)
        if not there.rsync and not push.is_empty:
            faults.append(_without_rsync(network, host, "it"))
        return push, faults

    found, diagnostics = _on_each(network, hosts, work)
    if shutil.which("rsync") is None:
        diagnostics += [_without_rsync(network, push.host, "this machine") for push, _ in found if not push.is_empty]
    return [push for push, _ in found], diagnostics + [fault for _, faults in found for fault in faults]


def push(
    network: Network, hosts: Sequence[NetworkHost], names: Collection[str], report: Sent, *, dry_run: bool
) -> tuple[list[HostPush], list[Diagnostic]]:  # fmt: skip
    """Brings the files to these hosts. `dry_run` changes nothing."""
    pushes, diagnostics = compared(network, hosts, names)
    if has_errors(diagnostics):
        return [], diagnostics
    if dry_run:
        return pushes, diagnostics
    by_host = {one.host: one for one in pushes}

    def work(host: NetworkHost) -> HostPush:
        sending.carry_out(by_host[host], report)
        return by_host[host]

    done, failed = _on_each(network, list(by_host), work)
    return done, diagnostics + failed


def _on_each(
    network: Network, hosts: Sequence[NetworkHost], work: Callable[[NetworkHost], T]
) -> tuple[list[T], list[Diagnostic]]:  # fmt: skip
    """The results on all hosts, in parallel, and a diagnostic for each that fails."""

    def one(host: NetworkHost) -> T | Diagnostic:
        try:
            return work(host)
        except HostFailed as error:
            return _fault(network, host, str(error), error.hint)

    with ThreadPoolExecutor(_PARALLEL) as pool:
        results = list(pool.map(one, hosts))
    failed = [result for result in results if isinstance(result, Diagnostic)]
    return [result for result in results if not isinstance(result, Diagnostic)], failed


def _fault(network: Network, host: NetworkHost, reason: str, hint: str) -> Diagnostic:
    where = network.span_of_host(host)
    return codes.NO_PUSH.at(where, hint=hint, name=host.name, address=host.address, reason=reason)


def _without_rsync(network: Network, host: NetworkHost, where: str) -> Diagnostic:
    hint = f"install it on {'that host' if where == 'it' else where} (Debian: rsync)"
    return _fault(network, host, f"{where} has no rsync", hint)
