"""Bringing the files of a deployment to its other hosts."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from robocomp_yaml.api.deploying import Deployment
from robocomp_yaml.deploy.push import pushing
from robocomp_yaml.deploy.push.planned import HostPush
from robocomp_yaml.diag.errors import Refused


def push(
    deployment: Deployment, names: Iterable[str] = (), *, dry_run: bool = False,
    report: Callable[[str, str], None] | None = None,
) -> list[HostPush]:  # fmt: skip
    """Brings to each other host what its processes need, and deletes what an earlier push brought and nothing needs any
    more. Each of `names` is a host, a process or a group. `report` is called with the host and the path of each file
    that was sent. What prevents it is in the diagnostics; then no host is changed, unless a connection was lost."""
    network, wanted = deployment.network, list(names)
    hosts = pushing.others(network)
    by_name = {host.name: host for host in hosts}
    here = [name for name in wanted if name in network.hosts and name not in by_name]
    if here:
        raise Refused(f"nothing is pushed to '{here[0]}': it is this machine, or no process runs there")
    of_hosts = [name for name in wanted if name in by_name]
    processes = deployment.chosen(name for name in wanted if name not in by_name)
    if processes and not of_hosts:
        used = {network.processes[name].host for name in processes}
        hosts = [host for host in hosts if host.name in used]
    elif of_hosts:
        hosts = [by_name[name] for name in of_hosts]
    done, diagnostics = pushing.push(network, hosts, processes, report or _ignore, dry_run=dry_run)
    deployment.add(diagnostics)
    return done


def _ignore(host: str, path: str) -> None:
    """Drops an event."""
