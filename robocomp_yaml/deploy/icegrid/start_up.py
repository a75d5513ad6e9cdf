"""Bringing up what the engine itself needs: the registry on this machine, and a node on every host."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TYPE_CHECKING

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import DeployFailed
from robocomp_yaml.deploy.icegrid import daemons, settings
from robocomp_yaml.deploy.icegrid.daemons import Start, outcome
from robocomp_yaml.deploy.icegrid.places import (
    Places,
    Registry,
    free_port,
    registry_address,
)
from robocomp_yaml.deploy.local.obstacles import is_here
from robocomp_yaml.deploy.local.record import clear_up
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Host, Network

if TYPE_CHECKING:
    from robocomp_yaml.deploy.icegrid.grid import Grid

_PATIENCE = 20.0  # seconds: far more than is needed, also where a machine is busy
_ENDS_WITHIN, _REGISTRY_ENDS_WITHIN = 15.0, 3.0
_RECONNECTS_WITHIN = 15.0  # seconds in which a node finds a registry that has come back
_LOOK = 0.01
_AT_ONCE = 8  # connections over SSH


def reached(places: Places, network: Network) -> Grid | None:
    """A session with the registry that there is; None where none runs and nothing is to. One that was killed, with all
    that would start it again, is started again."""
    registry = places.registry()
    if registry is None or not (places.wanted() or daemons.is_alive(places.registry_folder)):
        return None
    return _session(places, registry, network)


def created(places: Places, network: Network) -> Grid:
    """A session with the registry, started where none runs, at an address that all hosts reach."""
    address = registry_address(network.hosts.values())
    registry = places.registry()
    if registry is None or registry.address != address:
        _end_here(places)
        try:
            if registry is None:
                clear_up(network.folder)  # what runs although nothing is known of it: someone removed the folder
            own_folder.make(network.folder)
            settings.make_key(places)
            registry = Registry(address, free_port(address))
            places.keep_registry(registry)
        except OSError as error:
            raise _failed(network, error.strerror or str(error)) from error
    return _session(places, registry, network)


def _session(places: Places, registry: Registry, network: Network) -> Grid:
    if not daemons.is_alive(places.registry_folder):
        try:
            daemons.start_registry(places, registry)
        except OSError as error:
            raise _failed(network, error.strerror or str(error)) from error
    try:  # loading Ice takes about as long as the registry does to start
        from robocomp_yaml.deploy.icegrid.grid import Unreachable, reach
    except ImportError as error:
        raise _failed(network, str(error)) from error
    try:
        return reach(places, registry, _PATIENCE)
    except Unreachable as error:
        said = daemons.last_words(places.registry_folder)
        raise _failed(network, said or str(error)) from error


def ensure_nodes(grid: Grid, places: Places, network: Network, hosts: Iterable[Host]) -> dict[str, Diagnostic]:
    """Every host has its node: those of this machine are started, others over SSH, unless one that was started by hand
    finds the registry again. What is wrong with those that have none, by their names."""
    registry = places.registry()
    assert registry
    known = places.nodes()
    hosts = list(hosts)
    missing = [host for host in hosts if not grid.has_node(host.name)]
    scripts = {host.name: daemons.write_script(places, host, registry) for host in missing}
    begin = time.monotonic()
    tried = _started(missing, scripts)
    by_hand = [host for host in missing if tried[host.name].reason and not known.get(host.name, True)]
    _until(lambda: all(grid.has_node(host.name) for host in by_hand), _RECONNECTS_WITHIN + begin - time.monotonic())
    tried |= {host.name: daemons.Start(was_there=True) for host in by_hand if grid.has_node(host.name)}
    is_ours = {name: not start.reason for name, start in tried.items() if not start.was_there}
    places.keep_nodes({**{host.name: False for host in hosts}, **known, **is_ours})
    faults = {}
    for host in missing:
        reason = tried[host.name].reason
        hint = f"start it by hand, then try again: {daemons.by_hand(shown_path(scripts[host.name]), host)}"
        if not reason and not _until(lambda host=host: grid.has_node(host.name), _PATIENCE):  # type: ignore[misc]
            own = f"{places.root}/nodes/{host.name}"
            said = daemons.last_words(own) or f"see {own}/log there"
            reason = f"it was started, and does not reach the registry at {registry.address}:{registry.port}: {said}"
            hint = "all hosts must reach each other over TCP: look for a firewall between them"
        if reason:
            where = host.span if host.span.file else Span(network.path)
            hint = "" if is_here(host.address) else hint
            faults[host.name] = codes.NO_NODE.at(
                where, name=host.name, address=host.address, reason=reason, hint=hint
            )  # fmt: skip
    return faults


def _started(hosts: Sequence[Host], scripts: Mapping[str, str]) -> dict[str, daemons.Start]:
    """Starts the nodes of these hosts, all at once."""
    with ThreadPoolExecutor(_AT_ONCE) as pool:
        outcomes = pool.map(lambda host: _start(host, scripts[host.name]), hosts)
        return {host.name: outcome for host, outcome in zip(hosts, outcomes, strict=True)}


def ended(grid: Grid, places: Places, application: str) -> None:
    """Ends what the engine runs: its servers, the nodes that it started, and the registry."""
    from robocomp_yaml.deploy.icegrid.grid import GridFailed

    with suppress(GridFailed):  # a node that does not answer: its servers are gone, or end when it comes back
        grid.remove(application)
    nodes = places.nodes()
    for host, is_ours in nodes.items():
        if is_ours:
            grid.shut_down_node(host)
    places.keep_wanted(())
    grid.close()
    _end_here(places)
    places.keep_nodes({host: is_ours for host, is_ours in nodes.items() if not is_ours})


def _end_here(places: Places) -> None:
    """Ends the registry, and the nodes of this machine that rcyaml started."""
    nodes = [f"{places.root}/nodes/{host}" for host, is_ours in places.nodes().items() if is_ours]
    for folder in (*nodes, places.registry_folder):
        daemons.end(folder)
    # The registry would wait for a host that is cut off.
    if not _until(lambda: not daemons.is_alive(places.registry_folder), _REGISTRY_ENDS_WITHIN):
        daemons.kill(places.registry_folder)
    _until(lambda: not any(map(daemons.is_alive, (*nodes, places.registry_folder))), _ENDS_WITHIN)


def _start(host: Host, script: str) -> daemons.Start:
    return daemons.start_node_here(script) if is_here(host.address) else run(script, host)


def _until(condition: Callable[[], bool], within: float) -> bool:
    end = time.monotonic() + within
    while not (holds := condition()) and time.monotonic() < end:
        time.sleep(_LOOK)
    return holds


def _failed(network: Network, reason: str) -> DeployFailed:
    return DeployFailed(codes.NO_REGISTRY.at(Span(network.path), reason=reason))


_CONNECT_WITHIN, _RUN_WITHIN = 8.0, 30.0


def run(script: str, host: Host) -> Start:
    """Gives the script to bash on the host. The user's own keys, agent and known hosts are used; nothing is ever
    asked."""
    try:
        import asyncssh
    except ImportError:
        return Start("asyncssh is not installed (`pip install 'rcyaml[ssh]'`), and no node was started by hand")

    with open(script, encoding="utf-8") as file:
        text = file.read()

    async def work() -> Start:
        options = {"username": host.user} if host.user else {}
        async with asyncssh.connect(host.address, connect_timeout=_CONNECT_WITHIN, **options) as connection:
            done = await asyncio.wait_for(connection.run("bash -s", input=text, check=False), _RUN_WITHIN)
        return outcome(done.exit_status, str(done.stdout), str(done.stderr))

    try:
        return asyncio.run(work())
    except TimeoutError:
        return Start("ssh: no answer")
    except OSError as error:
        is_system = error.errno is not None and error.errno > 0  # whose own text is about a call
        return Start(f"ssh: {os.strerror(error.errno or 0) if is_system else error.strerror or error}".lower())
    except asyncssh.HostKeyNotVerifiable:
        return Start("ssh: its key is not the one in your known_hosts, or there is none: connect once with `ssh`")
    except asyncssh.Error as error:
        return Start(f"ssh: {str(error).strip() or 'the connection was closed'}")
