"""What is left of a deployment when nothing of it runs any more: configurations, the token, the history, sockets. Logs
stay."""

from __future__ import annotations

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import history, protection, registered


def after_down(folder: str) -> None:
    """Removes all of it, unless the deployment still has to be ended on a host that does not answer."""
    if registered.of_folder(folder) is None:
        history.remove(folder)
        protection.forget_token(folder)
        own_folder.sweep(folder)


def after_failure(folder: str) -> None:
    """Removes all of it, but what a rollback needs."""
    if history.is_there(folder):
        own_folder.sweep(folder)
    else:
        after_down(folder)
