"""Start and end of what the engine itself needs: the registry on this machine, and a node on every host."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import registered, ssh
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import HALTED, DeployFailed, EngineHangs
from robocomp_yaml.deploy.here import is_here, is_near
from robocomp_yaml.deploy.icegrid import daemons, ending, settings
from robocomp_yaml.deploy.icegrid.daemons import NodeStart, outcome
from robocomp_yaml.deploy.icegrid.failures import GridFailed, Unreachable
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles, Registry, free_port, registry_address
from robocomp_yaml.deploy.install import installed
from robocomp_yaml.deploy.local import procfs, record
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.time_limit import until
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, NetworkHost

if TYPE_CHECKING:
    from robocomp_yaml.deploy.icegrid.grid import GridSession

_PATIENCE = 20.0  # seconds: far more than is needed, also on a busy machine
_ENDS_WITHIN, _REGISTRY_ENDS_WITHIN = 15.0, 3.0
_RECONNECTS_WITHIN = 15.0  # seconds in which a node reconnects to the registry
_BY_SYSTEMD = NodeStart(
    "systemd starts it there, and it does not reach the registry yet",
    hint="`systemctl status 'rcyaml-*'` on that host shows why (`systemctl --user` for the units of a user)",
)
_ENDING = threading.Lock()  # a node
_PARALLEL = 8  # connections over SSH
_RUN_WITHIN = 30.0  # seconds for the script of a node


def reached(files: GridFiles, network: Network) -> GridSession | None:
    """A session with the running registry. If processes should run, a registry that was killed with its guard is
    started again; else None. Raises DeployFailed."""
    registry = files.registry()
    one = registered.of_folder(files.folder)
    if registry is None and one and registered.restore(files.folder):  # the folder was deleted
        registry = files.registry()
    is_pending = one is not None and bool(one.pending)
    is_left = is_pending or bool(files.desired()) or any(files.nodes().values())  # nodes that rcyaml started
    if registry is None or not (is_left or daemons.is_alive(files.registry_folder)):
        return None
    return _session(files, registry, network)


def is_running_without_files(files: GridFiles, network: Network) -> bool:
    """False if there is no registry, and no process on this machine. Raises EngineHangs if processes run although the
    files that lead to their registry are gone or damaged."""
    if files.registry() is not None or not record.running(network.folder):
        return False
    reason = "processes of it run, and its files are damaged: `rcyaml deploy down` ends them"
    failed = codes.FOLDER.at(Span(network.path), path=shown_path(network.folder), reason=reason)
    raise EngineHangs(failed, partial(asyncio.to_thread, record.end_hung, network.folder))


def continue_halted(files: GridFiles, network: Network) -> list[Diagnostic]:
    """Lets all go on that was halted (SIGSTOP) of what supervises the deployment on this machine. Returns a diagnostic
    if there was something."""
    halted = procfs.halted(files.folder)
    for pid in halted:
        procfs.send(pid, signal.SIGCONT)
    return [codes.NOT_SUPERVISED.at(Span(network.path), what=HALTED)] if halted else []


def created(files: GridFiles, network: Network) -> GridSession:
    """A session with the registry, which is started if none runs at an address that all hosts reach. Raises
    DeployFailed."""
    ending.stop(files)
    address = registry_address(network.hosts.values())
    registry = files.registry()
    if registry is None or registry.address != address:
        end_daemons(files)
        try:
            if registry is None:
                record.clear_up(network.folder)  # processes that run although their folder was removed
                record.remove(network.folder)
            own_folder.make(network.folder)
            settings.make_key(files)
            registry = Registry(address, free_port(address))
            files.keep_registry(registry)
        except OSError as error:
            raise _failed(network, reason_of(error)) from error
    return _session(files, registry, network)


def _session(files: GridFiles, registry: Registry, network: Network) -> GridSession:
    if not (daemons.is_alive(files.registry_folder) or registry.listens):
        try:
            daemons.start_registry(files, registry)
        except OSError as error:
            raise _failed(network, reason_of(error)) from error
    try:  # while the registry starts, which takes about as long as the import of Ice
        from robocomp_yaml.deploy.icegrid.grid import reach
    except ImportError as error:
        raise _failed(network, str(error)) from error
    try:
        with suppress(Unreachable):
            return reach(files, registry, _PATIENCE)
        daemons.end_hung(files.registry_folder)  # all processes go on without it
        return reach(files, registry, _PATIENCE)
    except Unreachable as error:
        raise _failed(network, daemons.last_words(files.registry_folder) or str(error)) from error


def ensure_nodes(
    grid: GridSession, files: GridFiles, network: Network, hosts: Iterable[NetworkHost]
) -> dict[str, Diagnostic]:
    """Starts the missing nodes: on this machine directly, on other hosts over SSH, unless systemd starts them there. A
    node that rcyaml did not start has some seconds to reconnect to the registry. Returns a diagnostic for each host
    without a node, by its name."""
    registry = files.registry()
    assert registry
    known = files.nodes()
    hosts = list(hosts)
    _end_homeless(grid, [host for host in hosts if is_here(host)])
    missing = [host for host in hosts if not grid.has_node(host.name)]
    scripts = {host.name: daemons.write_script(files, host, network.hosts.values(), registry) for host in missing}
    begin = time.monotonic()
    by_systemd = set(installed.hosts_of(files.folder))
    waiting = {host.name: _BY_SYSTEMD for host in missing if host.name in by_systemd and not is_here(host)}
    tried = {**_started([host for host in missing if host.name not in waiting], scripts), **waiting}
    by_hand = [host for host in missing if tried[host.name].reason and not known.get(host.name, True)]
    until(lambda: all(grid.has_node(host.name) for host in by_hand), _RECONNECTS_WITHIN + begin - time.monotonic())
    tried |= {host.name: daemons.NodeStart(was_running=True) for host in by_hand if grid.has_node(host.name)}
    is_started = {name: not start.reason for name, start in tried.items() if not start.was_running}
    files.keep_nodes({**{host.name: False for host in hosts}, **known, **is_started})
    faults = {}
    for host in missing:
        reason = tried[host.name].reason
        hint = tried[host.name].hint
        by_hand_too = f"start it by hand, then try again: {daemons.by_hand(shown_path(scripts[host.name]), host)}"
        hint = f"{hint}; or {by_hand_too}" if hint else by_hand_too
        own = f"{files.on(host.name).root}/nodes/{host.name}"
        is_up = bool(reason) or until(partial(grid.has_node, host.name), _PATIENCE)
        if not is_up and not (is_here(host) and _has_ended_hung(grid, host.name)):
            words = daemons.last_words(own) or f"see {own}/log on that host"
            reason = f"it was started, but does not reach the registry at {registry.address}:{registry.port}: {words}"
            hint = "all hosts must reach each other over TCP: check for a firewall between them"
        if reason:
            hint = "" if is_here(host) else hint
            faults[host.name] = codes.NO_NODE.at(
                network.span_of_host(host), name=host.name, address=host.address, reason=reason, hint=hint
            )  # fmt: skip
    return faults


def _end_homeless(grid: GridSession, hosts: Iterable[NetworkHost]) -> None:
    """Ends the nodes of this machine whose folder somebody deleted, with their processes: they can start nothing."""
    for host in hosts:
        if not os.path.exists(f"{grid.files.root}/nodes/{host.name}/run") and grid.has_node(host.name):
            grid.shut_down_node(host.name)
            until(lambda host=host: not grid.has_node(host.name), _ENDS_WITHIN)  # type: ignore[misc]


def _has_ended_hung(grid: GridSession, host: str) -> bool:
    """Kills the node of this machine, which does not answer, with its processes. Returns whether its guard has started
    it again."""
    daemons.end_hung(f"{grid.files.root}/nodes/{host}")
    return until(lambda: grid.has_node(host), _PATIENCE)


def stop(grid: GridSession, name: str, spec: ProcessSpec | None) -> None:
    """Stops a process. A node of this machine that hangs does not prevent that: it is killed. Raises GridFailed."""
    try:
        return grid.stop(name)
    except Unreachable:
        if spec is None or not is_near(spec):
            raise
    with _ENDING:  # of several stops, the first one does it
        if not grid.has_node(spec.process.host):
            _has_ended_hung(grid, spec.process.host)
    return grid.stop(name)


def _started(hosts: Sequence[NetworkHost], scripts: Mapping[str, str]) -> dict[str, daemons.NodeStart]:
    """Starts the nodes of these hosts in parallel. Returns the results by the names of the hosts."""
    with ThreadPoolExecutor(_PARALLEL) as pool:
        outcomes = pool.map(lambda host: _start(host, scripts[host.name]), hosts)
        return {host.name: outcome for host, outcome in zip(hosts, outcomes, strict=True)}


def ended(grid: GridSession | GridFiles, network: Network) -> list[str]:
    """Ends what the engine runs: servers, the nodes that it started, and the registry; with its files only, what runs
    on this machine. Returns the hosts that do not answer: these are ended later, by a process that also ends the
    registry then. Without a node, nothing runs on this machine."""
    if isinstance(grid, GridFiles):
        end_here(grid)
        registered.forget(grid.folder)
        return []
    from robocomp_yaml.deploy.icegrid import leftovers

    files = grid.files
    nodes = files.nodes()
    lost = [host for host, is_started in nodes.items() if is_started or leftovers.of_host(files, host)]
    dead = {host for host in nodes if not grid.has_node(host)}
    dead_here = {host for host in dead if host in network.hosts and is_here(network.hosts[host])}
    lost = [host for host in lost if host in dead - dead_here]
    with suppress(GridFailed):  # a node does not answer: its servers have ended, or end when it is back
        grid.remove(network.name)
    files.keep_desired(())
    for host, is_started in nodes.items():
        if host not in dead:
            end_node(grid, host, is_started=is_started)
    if not (lost or daemons.is_alive(files.registry_folder)):
        grid.shut_down()  # its files were deleted, so that its guard is unknown
    grid.close()
    if lost:
        ending.begin(files, lost)
    else:
        end_here(files)
        registered.forget(files.folder)
    return lost


def end_idle_nodes(
    grid: GridSession, specs: Mapping[str, ProcessSpec | None], far: Collection[str]
) -> None:  # fmt: skip
    """Ends the nodes of other hosts on which nothing of the deployment is left, after a move. `far` are the other hosts
    that were used before."""
    from robocomp_yaml.deploy.icegrid import leftovers

    nodes, used = grid.files.nodes(), {spec.process.host for spec in specs.values() if spec}
    for host, is_started in list(nodes.items()):
        if host in far and host not in used and grid.has_node(host) and not leftovers.of_host(grid.files, host):
            # The folder of configurations can be shared by all hosts.
            end_node(grid, host, is_started=is_started, with_configurations=False)
            if is_started:
                del nodes[host]
    grid.files.keep_nodes(nodes)


def end_node(
    grid: GridSession, host: str, *, is_started: bool | None = None, with_configurations: bool = True
) -> None:  # fmt: skip
    """Removes the configurations of this deployment from a host, and ends its node, with its key, if rcyaml started it.
    A node that was started by hand stays."""
    from robocomp_yaml.deploy.icegrid import leftovers

    files = grid.files
    is_started = files.nodes().get(host, False) if is_started is None else is_started
    leftovers.clean(grid, host, everything=with_configurations, with_key=is_started)
    if is_started:
        grid.shut_down_node(host)


def end_here(files: GridFiles) -> None:
    """Ends what runs on this machine. The deployment's key stays only if a node needs it that was started by hand."""
    nodes = files.nodes()
    end_daemons(files)
    left = {host: is_started for host, is_started in nodes.items() if not is_started}
    files.keep_nodes(left)
    files.drop_configurations(with_key=not left)


def end_daemons(files: GridFiles) -> None:
    """Ends the registry, and the nodes of this machine that rcyaml started. All else stays, for the next start."""
    nodes = [f"{files.root}/nodes/{host}" for host, is_started in files.nodes().items() if is_started]
    for folder in (*nodes, files.registry_folder):
        daemons.end(folder)
    # The registry would wait for a host without a connection.
    if not until(lambda: not daemons.is_alive(files.registry_folder), _REGISTRY_ENDS_WITHIN):
        daemons.kill(files.registry_folder)
    until(lambda: not any(map(daemons.is_alive, (*nodes, files.registry_folder))), _ENDS_WITHIN)


def _start(host: NetworkHost, script: str) -> daemons.NodeStart:
    return daemons.start_local_node(script) if is_here(host) else run(script, host)


def _failed(network: Network, reason: str) -> DeployFailed:
    return DeployFailed(codes.NO_REGISTRY.at(Span(network.path), reason=reason))


def run(script: str, host: NetworkHost) -> NodeStart:
    """Runs the script with bash on the host, over ssh."""
    with open(script, "rb") as file:
        text = file.read()
    try:
        done = ssh.CLIENT.run(host, ["bash", "-s"], text, _RUN_WITHIN)
    except ssh.SshFailed as error:
        return NodeStart(str(error), hint=error.hint)
    return outcome(done.code, done.output.decode(errors="replace"), done.errors)
