"""Running deployments that a document described before: under another name, or at another path. What runs twice because
of that is prevented, and what still runs is named."""

from __future__ import annotations

import os

from robocomp_yaml.deploy import registered
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.local import record
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.network.network import Network


def refuse(network: Network) -> None:
    """Raises Refused if a deployment runs that this document described under another name."""
    if found := under_another_name(network):
        raise Refused(found)


def refuse_start(network: Network) -> None:
    """Raises Refused if a deployment of this name runs whose document is gone: it may be this one, which was moved, and
    would run twice."""
    if found := at_another_path(network):
        raise Refused(f"{found}, before this one starts")


def under_another_name(network: Network) -> str:
    """Which deployment runs that this document described under another name, and what stops it; '' if none does."""
    for one in registered.every():
        if one.document == network.path and one.folder != network.folder and one.name != network.name and _runs(one):
            down = typed("rcyaml", "deploy", "down", one.name)
            document = shown_path(network.path)
            return f"{document} described '{one.name}' before, which still runs as it was started: `{down}` stops it"
    return ""


def at_another_path(network: Network) -> str:
    """Which deployment of this name runs although its document is gone, and what stops it; '' if none does."""
    for one in registered.every():
        is_other = one.name == network.name and one.folder != network.folder and not _was_moved(one, network)
        if is_other and not os.path.exists(one.document) and _runs(one):
            document = shown_path(one.document)
            down = typed("rcyaml", "deploy", "down", document)
            return f"another '{one.name}' runs, whose document {document} is gone: `{down}` stops it"
    return ""


def _was_moved(one: registered.RegisteredDeployment, network: Network) -> bool:
    """Whether it runs in the network's own folder, which was moved with all that is in it."""
    return one.is_supervised and not os.path.exists(one.folder) and record.keeps(network.folder, one.supervisor)


def _runs(one: registered.RegisteredDeployment) -> bool:
    from robocomp_yaml.deploy.listing import runs  # few deployments have another one of their name

    return runs(one)
