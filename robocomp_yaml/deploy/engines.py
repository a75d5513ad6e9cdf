"""Which engine runs a network: a row an engine."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robocomp_yaml.deploy.engine import Engine
    from robocomp_yaml.network.network import Network

LOCAL, ICEGRID = "local", "icegrid"
ENGINES = {LOCAL: "local.engine:LocalEngine", ICEGRID: "icegrid.engine:IceGridEngine"}
"""Every engine by its name: where its class is, which is imported when it is to run something."""


def make_engine(name: str | None, network: Network) -> Engine:
    """The engine of that name; without one, `local` where all runs on this machine, else `icegrid`."""
    from robocomp_yaml.deploy.local.obstacles import not_here

    if name is None:
        name = ICEGRID if network.is_distributed or not_here(network) else LOCAL
    module, _, class_ = ENGINES[name].partition(":")
    made: Engine = getattr(importlib.import_module(f"robocomp_yaml.deploy.{module}"), class_)()
    return made
