"""Start of the nodes of all hosts: local ones and those over SSH in parallel, while those started by hand reconnect."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robocomp_yaml.deploy.icegrid import daemons, start_up
from robocomp_yaml.deploy.icegrid.daemons import NodeStart
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles, Registry
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, NetworkHost

HOSTS = [NetworkHost("onboard", "localhost"), NetworkHost("head", "10.0.0.3"), NetworkHost("arm", "10.0.0.4")]
NETWORK = Network("Robot", "/robot.ddsl.yaml", "/robot")


class Grid:
    """A registry. `joins` are the hosts whose nodes connect after two requests. Unless `hears`, started nodes do not
    connect."""

    def __init__(self, *joins: str, hears: bool = True) -> None:
        self.nodes: set[str] = set()
        self.hears = hears
        self.asked = dict.fromkeys(joins, 0)

    def has_node(self, name: str) -> bool:
        if name in self.asked:
            self.asked[name] += 1
        return name in self.nodes or self.asked.get(name, 0) > 2


@pytest.fixture
def files(tmp_path: Path) -> GridFiles:
    made = GridFiles(str(tmp_path))
    Path(made.root).mkdir(parents=True)
    made.keep_registry(Registry("10.0.0.2", 4061))
    return made


Ensure = Callable[..., tuple[list[bool], dict[str, Diagnostic]]]


@pytest.fixture
def ensure(files: GridFiles, monkeypatch: pytest.MonkeyPatch) -> Ensure:
    """Ensures the nodes, with the results of starts by host. Returns whether each wait succeeded, and the diagnostics
    by host."""
    waited: list[bool] = []

    def until(condition: Callable[[], bool], within: float) -> bool:
        waited.append(any(condition() for _ in range(5)))
        return waited[-1]

    def run(grid: Grid, **starts: NodeStart) -> tuple[list[bool], dict[str, Diagnostic]]:
        def start(host: NetworkHost, script: str) -> NodeStart:
            if grid.hears and not starts[host.name].reason:
                grid.nodes.add(host.name)
            return starts[host.name]

        monkeypatch.setattr(start_up, "_start", start)
        monkeypatch.setattr(start_up, "until", until)
        monkeypatch.setattr(daemons, "write_script", lambda files, host, hosts, registry: f"/{host.name}.sh")
        any_grid: Any = grid
        any_grid.files = files
        for host in HOSTS:  # no node has lost its folder
            folder = Path(files.root, "nodes", host.name)
            folder.mkdir(parents=True, exist_ok=True)
            Path(folder, "run").touch()
        return waited, start_up.ensure_nodes(any_grid, files, NETWORK, HOSTS)

    return run


FAILS = NodeStart("ssh: no answer")


def test_only_nodes_that_were_started_by_hand_are_waited_for(files: GridFiles, ensure: Ensure) -> None:
    files.keep_nodes({"head": False})
    waited, faults = ensure(Grid("head"), onboard=NodeStart(), head=FAILS, arm=NodeStart())
    assert all(waited) and not faults
    assert files.nodes() == {"onboard": True, "head": False, "arm": True}


def test_a_node_that_ran_before_is_not_ended_by_rcyaml(files: GridFiles, ensure: Ensure) -> None:
    files.keep_nodes({"onboard": True})
    ensure(Grid(), onboard=NodeStart(was_running=True), head=NodeStart(was_running=True), arm=NodeStart())
    assert files.nodes() == {"onboard": True, "head": False, "arm": True}


def test_all_failures_are_reported(files: GridFiles, ensure: Ensure) -> None:
    _, told = ensure(Grid(), onboard=NodeStart(), head=FAILS, arm=NodeStart("ssh: permission denied"))
    assert list(told) == ["head", "arm"] and "'arm'" in told["arm"].message
    assert told["arm"].hint == "start it by hand, then try again: ssh 10.0.0.4 bash -s < /arm.sh"


def test_a_node_that_does_not_reach_the_registry(files: GridFiles, ensure: Ensure) -> None:
    _, faults = ensure(Grid(hears=False), onboard=FAILS, head=NodeStart(), arm=FAILS)
    told = faults["head"]
    assert "does not reach the registry at 10.0.0.2:4061" in told.message and "firewall" in told.hint
