"""Which engine runs a network."""

from __future__ import annotations

from robocomp_yaml.deploy.engine import Engine
from robocomp_yaml.deploy.local.obstacles import not_here
from robocomp_yaml.network.network import Network


def make_engine(name: str | None, network: Network) -> Engine:
    """The engine of that name; without one, `local` where all runs on this machine, else `icegrid`."""
    if name == "icegrid" or (name is None and (network.is_distributed or not_here(network))):
        from robocomp_yaml.deploy.icegrid.engine import IceGridEngine

        return IceGridEngine()
    from robocomp_yaml.deploy.local.engine import LocalEngine

    return LocalEngine()
