"""The table of engines. An engine is imported when it is used."""

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
"""The class of each engine, by its name for `--engine`."""


def make_engine(name: str | None, network: Network) -> Engine:
    """The engine of that name; without a name, `local` if all processes run on this machine, else `icegrid`."""
    made: Callable[[], Engine] = import_member(ENGINES[name or _usual(network)])  # type: ignore[assignment]
    return made()


def _usual(network: Network) -> str:
    from robocomp_yaml.deploy.local.obstacles import elsewhere

    return ICEGRID if network.is_distributed or elsewhere(network) else LOCAL
