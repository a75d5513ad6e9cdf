"""`rcyaml deploy install` and `uninstall`: their calls of the library, and their output."""

from __future__ import annotations

from robocomp_yaml.api import installing
from robocomp_yaml.commands._deploying import DeploySession
from robocomp_yaml.deploy.install.units import SYSTEM, HostUnit
from robocomp_yaml.diag import terminal


def install(session: DeploySession, manager: str, *, prints: bool, dry_run: bool) -> None:
    """Installs the deployment, or prints what that would write, and ends the command."""
    found = session.run(lambda: installing.planned(session.deployment, manager))
    if not (prints or dry_run):
        found = session.run(lambda: installing.install(session.deployment, manager), "interrupted")
    data: dict[str, object] = {"dry_run": prints or dry_run, "units": [_data(one) for one in found]}
    if session.format_ == "json":
        session.end(data)
    if prints:
        for one in found:
            terminal.data(f"# {one.host.name}: {_path(one)}\n{one.text}")
    elif session.prints_progress:
        what = "would write" if dry_run else "wrote"
        terminal.say(*(f"{one.host.name}  {what} {_path(one)}" for one in found))
        terminal.say(*(f"{one.host.name}  {note}" for one in found for note in one.notes), err=True)
    session.end()


def uninstall(session: DeploySession) -> None:
    """Removes the units, and ends the command."""
    hosts = session.run(lambda: installing.uninstall(session.deployment))
    if session.format_ == "json":
        session.end({"uninstalled": hosts})
    if session.prints_progress:
        terminal.say(f"{session.network.name}: uninstalled from {', '.join(hosts)}")
    session.end()


def _path(one: HostUnit) -> str:
    folder = "/etc/systemd/system" if one.manager == SYSTEM else "~/.config/systemd/user"
    return f"{folder}/{one.name}"


def _data(one: HostUnit) -> dict[str, object]:
    """Without the further files, which contain secrets."""
    return {"host": one.host.name, "manager": one.manager, "path": _path(one), "text": one.text, "notes": one.notes}
