"""Which engine runs a network: a table of them, each imported when it is to run one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml.registry import import_member

if TYPE_CHECKING:
    from collections.abc import Callable

    from robocomp_yaml.deploy.engine import Engine
    from robocomp_yaml.network.network import Network

LOCAL, ICEGRID = "local", "icegrid"
ENGINES = {
    LOCAL: "robocomp_yaml.deploy.local.engine:LocalEngine",
    ICEGRID: "robocomp_yaml.deploy.icegrid.engine:IceGridEngine",
}
"""The class of each, by the name that `--engine` takes."""


def make_engine(name: str | None, network: Network) -> Engine:
    """The engine of that name; without one, `local` where all runs on this machine, else `icegrid`."""
    made: Callable[[], Engine] = import_member(ENGINES[name or _usual(network)])  # type: ignore[assignment]
    return made()


def _usual(network: Network) -> str:
    from robocomp_yaml.deploy.local.obstacles import not_here

    return ICEGRID if network.is_distributed or not_here(network) else LOCAL
