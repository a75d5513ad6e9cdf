"""The table of engines, and which one a deployment has. An engine is imported when it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml.registry import import_member

if TYPE_CHECKING:
    from collections.abc import Callable

    from robocomp_yaml.deploy.engine import Engine
    from robocomp_yaml.deploy.registered import RegisteredDeployment
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


def engine_of(known: RegisteredDeployment, network: Network, chosen: str | None) -> str:
    """The name of the engine of a deployment that was started before: while it runs, the one with which it runs. Raises
    Refused if another one is chosen: it would run twice."""
    from robocomp_yaml.deploy.differences import shown_path
    from robocomp_yaml.deploy.listing import runs
    from robocomp_yaml.deploy.local.obstacles import elsewhere
    from robocomp_yaml.diag.errors import Refused
    from robocomp_yaml.diag.terminal import typed

    name = chosen or (ICEGRID if known.engine == LOCAL and elsewhere(network) else known.engine)
    if name == known.engine or not runs(known):
        return name
    if chosen:
        down = typed("rcyaml", "deploy", "down", shown_path(network.path))
        raise Refused(f"{known.name} runs with the engine {known.engine}: leave out `--engine`, or run `{down}` first")
    return known.engine
