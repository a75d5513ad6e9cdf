"""Installs the units of a deployment on its hosts, and removes them. The user's own state has a record of each
installed deployment."""

from __future__ import annotations

import getpass
import os
from collections.abc import Iterable

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import registered
from robocomp_yaml.deploy.engines import LOCAL
from robocomp_yaml.deploy.install import units
from robocomp_yaml.deploy.install.installed import Installed, InstalledUnit, forget, keep, of_folder
from robocomp_yaml.deploy.install.units import HostUnit
from robocomp_yaml.deploy.local.obstacles import unset
from robocomp_yaml.deploy.probe import run_on
from robocomp_yaml.deploy.ssh import HostFailed
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, NetworkHost


def install(
    network: Network, engine: str, wanted: list[HostUnit]
) -> tuple[list[HostUnit], list[Diagnostic]]:  # fmt: skip
    """Writes the units on all hosts, and returns those that were written. A host that cannot be reached is reported."""
    diagnostics = [one for process in network.enabled() for one in unset(process)]  # also at the next boot
    if diagnostics:
        return [], diagnostics
    if engine != LOCAL:
        wanted, fault = _with_nodes(network, wanted)
        if fault:
            return [], [fault]
    written: list[HostUnit] = []
    if diagnostics := _unreached(network, wanted):
        return [], diagnostics
    own_folder.make(network.folder)
    before = of_folder(network.folder)
    done = {(one.host.name, one.name): one for one in (before.units if before else ())}
    for unit in wanted:
        texts = ["unit", unit.text, *(text for pair in unit.files.items() for text in pair)]
        try:
            answer = _ask(unit.host, unit.is_here, "install", unit.manager, unit.name, network.path, texts)
        except HostFailed as error:
            diagnostics.append(_fault(network, unit.host, "written", error))
            continue
        done[unit.host.name, unit.name] = InstalledUnit(
            registered.host_of(unit.host), unit.name, unit.manager, tuple(unit.files), unit.is_here
        )
        written.append(replace(unit, notes=_notes(unit, answer)))
    if done:
        keep(Installed(network.name, network.path, network.folder, engine, tuple(done.values())))
    return written, diagnostics


def _with_nodes(network: Network, wanted: list[HostUnit]) -> tuple[list[HostUnit], Diagnostic | None]:
    """The units with the scripts of their nodes, which contain the deployment's key. The nodes count as started by
    hand: `down` leaves them."""
    from robocomp_yaml.deploy.icegrid import daemons, obstacles, settings
    from robocomp_yaml.deploy.icegrid.grid_files import GridFiles, Registry, free_port, registry_address

    files = GridFiles(network.folder)
    try:
        if lacking := obstacles.missing():
            raise OSError(0, lacking)
        own_folder.make(network.folder)
        settings.make_key(files)
        files.keep_folders([unit.host for unit in wanted])
        registry = files.registry()
        if registry is None:
            address = registry_address(network.hosts.values())
            registry = Registry(address, free_port(address))
            files.keep_registry(registry)
        found = []
        for unit in wanted:
            if unit.is_here:
                found.append(unit)
                continue
            with open(
                daemons.write_script(files, unit.host, network.hosts.values(), registry), encoding="utf-8"
            ) as file:
                node = f"foreground=yes\n{file.read()}"
            path = f"{files.on(unit.host.name).folder}/{units.OWN}/node"
            found.append(replace(unit, files={**unit.files, path: node}))
        files.keep_nodes({**files.nodes(), **{unit.host.name: False for unit in found if not unit.is_here}})
    except OSError as error:
        reason = reason_of(error)
        return [], codes.NO_REGISTRY.at(Span(network.path), reason=reason)
    return found, None


def uninstall(network: Network, record: Installed) -> list[Diagnostic]:
    """Removes the units of all hosts. What could not be removed stays in the record, for the next time."""
    diagnostics, left = list[Diagnostic](), list[InstalledUnit]()
    for unit in record.units:
        host = unit.host.host
        texts = [text for path in unit.files for text in (path, "")]
        if not unit.is_here:  # the key of its node
            own = os.path.dirname(os.path.dirname(os.path.dirname(unit.files[0])))
            texts += [f"{own}/state/icegrid/nodes/{host.name}", ""]
        try:
            _ask(host, unit.is_here, "remove", unit.manager, unit.name, record.document, texts)
        except HostFailed as error:
            left.append(unit)
            diagnostics.append(_fault(network, network.hosts.get(host.name, host), "removed", error))
    if left:
        keep(replace(record, units=tuple(left)))
    else:
        forget(record.folder)
    if record.engine != LOCAL and registered.of_folder(record.folder) is None:
        from robocomp_yaml.deploy.icegrid import start_up
        from robocomp_yaml.deploy.icegrid.grid_files import GridFiles

        files, kept = GridFiles(record.folder), {unit.host.name for unit in left}
        gone = {unit.host.name for unit in record.units if not unit.is_here} - kept
        files.keep_nodes({name: own for name, own in files.nodes().items() if name not in gone})
        start_up.end_here(files)
    return diagnostics


def user() -> str:
    return getpass.getuser()


def _ask(
    host: NetworkHost, is_near: bool, what: str, manager: str, unit: str, owner: str, texts: Iterable[str]
) -> dict[str, str]:  # fmt: skip
    """What the script on a host answers. Raises HostFailed, also if it refuses a change."""
    given = "".join(f"{text}\0" for text in (what, manager, unit, units.target(manager), owner, *texts))
    where = NetworkHost(host.name) if is_near else host
    command = ["bash", "-c", units.script(), "units"]
    done = run_on(where, command, given.encode(errors="surrogateescape"))
    answer = dict(line.split("\t", 1) for line in done.output.decode(errors="replace").splitlines() if "\t" in line)
    if done.code:
        raise HostFailed(done.reason())
    if what != "show" and (refused := answer.get("refused")):
        raise HostFailed(refused)
    return answer


def _notes(unit: HostUnit, answer: dict[str, str]) -> tuple[str, ...]:
    if answer.get("systemd") == "no":
        return (f"the {unit.manager} manager of systemd does not answer now: the unit starts at the next boot",)
    if answer.get("lingers") == "no":
        who = unit.host.ssh.user if not unit.is_here and unit.host.ssh.user else user()
        return (
            f"this user's units start only at login: `sudo loginctl enable-linger {who}` on that host changes that",
        )
    return ()


def _unreached(network: Network, wanted: Iterable[HostUnit]) -> list[Diagnostic]:
    """Diagnostics for hosts that cannot be reached: then no host is changed."""
    found = []
    for unit in wanted:
        try:
            _ask(unit.host, unit.is_here, "show", unit.manager, unit.name, network.path, [])
        except HostFailed as error:
            found.append(_fault(network, unit.host, "written", error))
    return found


def _fault(network: Network, host: NetworkHost, what: str, error: HostFailed) -> Diagnostic:
    where = network.span_of_host(host)
    return codes.NO_UNIT.at(where, hint=error.hint, host=host.name, what=what, reason=str(error))
