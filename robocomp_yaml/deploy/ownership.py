"""Whose a running network is: only the user who started it sees and changes what runs.

Every engine asks this when it is opened, so that no command takes what it cannot see for a network that does not run.
"""

from __future__ import annotations

from robocomp_yaml.deploy import folder
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import DeployFailed
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network


class NotOwn(DeployFailed):
    """It is unknown what runs, because another user started it."""


def require(network: Network) -> None:
    """Raises NotOwn if another user started the network in its folder."""
    try:
        folder.require_own(network.folder)
    except OSError as error:
        where = shown_path(network.folder)
        raise NotOwn(deploying.FOLDER.at(Span(network.path), path=where, reason=reason_of(error))) from error
