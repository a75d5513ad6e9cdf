"""`rcyaml deploy ls`: the deployments of this user. It imports little, because it reads no document."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

import click
import msgspec

from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.listing import ListedDeployment, listed
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.render.json import dumps


def list_running(ctx: click.Context, format_: str) -> NoReturn:
    """Prints the user's list of deployments."""
    found = listed()
    if format_ == "json":
        terminal.data(dumps({"deployments": msgspec.to_builtins(found)}), json=True)
    elif found:
        terminal.say(*_lines(found))
    else:
        terminal.say("no deployment is running")
    ctx.exit(0)


def _lines(found: Sequence[ListedDeployment]) -> list[terminal.Shown]:
    """A table of deployments."""
    rows = [("DEPLOYMENT", "STATE", "ENGINE", "HOSTS", "DOCUMENT")]
    for one in found:
        document = shown_path(one.document) + ("" if one.has_document else " (gone)")
        state = f"{one.state}, installed" if one.installed else one.state
        rows.append((one.name, state, one.engine, ", ".join(one.hosts), document))
    return terminal.table(rows)
