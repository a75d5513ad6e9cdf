"""Letting systemd start a deployment when its hosts boot."""

from __future__ import annotations

from robocomp_yaml.api.deploying import Deployment
from robocomp_yaml.deploy.engines import LOCAL
from robocomp_yaml.deploy.install import installed, installing, units
from robocomp_yaml.deploy.install.units import HostUnit
from robocomp_yaml.deploy.local.obstacles import elsewhere
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.emit.exports._unwritable import Unwritable


def planned(deployment: Deployment, manager: str = "") -> list[HostUnit]:
    """The units that `install` writes, without the scripts of nodes, which contain a key. `manager` is `user` or
    `system`, by default that of each host. Raises Refused if a unit cannot express a path."""
    try:
        return units.of_network(deployment.network, deployment.engine, manager, installing.user())
    except Unwritable as error:
        raise Refused(f"{deployment.network.name} cannot be installed: {error}") from error


def install(deployment: Deployment, manager: str = "") -> list[HostUnit]:
    """Writes the units on all hosts, and starts them. Returns those that were written. Raises Faulty if none was."""
    wanted = planned(deployment, manager)
    if deployment.engine == LOCAL and (fault := elsewhere(deployment.network)):
        deployment.add([fault])
        raise Faulty(deployment.diagnostics)
    written, diagnostics = installing.install(deployment.network, deployment.engine, wanted)
    deployment.add(diagnostics)
    if has_errors(diagnostics) and not written:
        raise Faulty(deployment.diagnostics)
    return written


def uninstall(deployment: Deployment) -> list[str]:
    """Takes the deployment down, and removes all that `install` wrote. Returns the names of the hosts. Raises Refused
    if it is not installed."""
    network = deployment.network
    record = installed.of_folder(network.folder)
    if record is None:
        raise Refused(f"{network.name} is not installed")
    installed.forget(network.folder)  # it does not start again at the next boot
    try:
        deployment.down()
    except BaseException:
        installed.keep(record)
        raise
    deployment.add(installing.uninstall(network, record))
    return [unit.host.name for unit in record.units]
