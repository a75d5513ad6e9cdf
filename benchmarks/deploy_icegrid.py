"""Deployments with IceGrid: 50 small processes brought up by IceGrid alone, by the engine `icegrid` and by `local`.

    python benchmarks/deploy_icegrid.py [RUNS]

IceGrid alone is a Python program that starts a registry and a node (plain TCP), adds an application of 50 plain servers
and starts them all through the Admin API: no order, no readiness, no configuration. All begin with nothing running, and
the runs of the three take turns. Then one process is killed again and again, until its next run exists: under IceGrid
alone as an `always` server.
"""

from __future__ import annotations

import os
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from deploy import COUNT, back_after_kill, children, document, rcyaml, seconds

CRASHES = 20
PROXY = "IceGrid/Registry:tcp -h 127.0.0.1 -p {}"


class Alone:
    """A registry and a node of IceGrid's own, in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        with socket.create_server(("127.0.0.1", 0)) as probe:
            self.port = probe.getsockname()[1]
        self.daemons: list[subprocess.Popen[bytes]] = []

    def up(self, activation: str = "manual") -> None:
        """As a program of its own would do it, but for the start of Python."""
        for name in ("registry", "node"):
            (self.folder / name).mkdir(parents=True)
        own = "tcp -h 127.0.0.1"
        self._start("icegridregistry", {
            "IceGrid.Registry.Client.Endpoints": f"{own} -p {self.port}", "IceGrid.Registry.Server.Endpoints": own,
            "IceGrid.Registry.Internal.Endpoints": own, "IceGrid.Registry.LMDB.Path": f"{self.folder}/registry",
            "IceGrid.Registry.AdminPermissionsVerifier": "IceGrid/NullPermissionsVerifier",
        })  # fmt: skip
        while not self._answers():  # a node that finds no registry looks for it again only after 10 s
            time.sleep(0.005)
        self._start("icegridnode", {
            "Ice.Default.Locator": f"IceGrid/Locator:{own} -p {self.port}", "IceGrid.Node.Name": "here",
            "IceGrid.Node.Endpoints": own, "IceGrid.Node.Data": f"{self.folder}/node",
            "IceGrid.Node.AllowRunningServersAsRoot": "1",
        })  # fmt: skip
        script = [sys.executable, __file__, "alone", str(self.port), activation]
        subprocess.run(script, check=True)

    def _answers(self) -> bool:
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def _start(self, program: str, settings: dict[str, str]) -> None:
        words = [f"--{key}={value}" for key, value in settings.items()]
        log = (self.folder / f"{program}.log").open("wb")
        self.daemons.append(subprocess.Popen([program, *words], stdout=log, stderr=log))

    def down(self) -> None:
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()
        self.daemons = []
        shutil.rmtree(self.folder)


def deploy_alone(port: int, activation: str) -> None:
    """Adds the application and starts all its servers."""
    import Ice
    import IceGrid

    nothing = IceGrid.DistributionDescriptor("", [])
    quiet = IceGrid.PropertySetDescriptor([], [IceGrid.PropertyDescriptor("Ice.Admin.Enabled", "0")])
    servers = [
        IceGrid.ServerDescriptor(
            adapters=[], propertySet=quiet, dbEnvs=[], logs=[], description="", id=f"p{number}", exe="/bin/sh",
            iceVersion="", pwd="/", options=["-c", "exec sleep 1000", "sh"], envs=[], activation=activation,
            activationTimeout="", deactivationTimeout="", applicationDistrib=False, distrib=nothing,
            allocatable=False, user="root" if os.getuid() == 0 else "",
        )
        for number in range(COUNT)
    ]  # fmt: skip
    node = IceGrid.NodeDescriptor(
        variables={}, serverInstances=[], servers=servers, loadFactor="", description="", propertySets={}
    )
    application = IceGrid.ApplicationDescriptor(
        name="Many", variables={}, replicaGroups=[], serverTemplates={}, serviceTemplates={}, nodes={"here": node},
        distrib=nothing, description="", propertySets={},
    )  # fmt: skip
    with Ice.initialize() as communicator:
        admin = _admin(communicator, port)
        while "here" not in admin.getAllNodeNames():
            time.sleep(0.005)
        admin.addApplication(application)
        if activation == "manual":
            for future in [admin.startServerAsync(one.id) for one in servers]:
                future.result()
        while not all(str(admin.getServerState(one.id)) == "Active" for one in servers):
            time.sleep(0.005)


def _admin(communicator: Any, port: int) -> Any:
    import Ice
    import IceGrid

    registry = IceGrid.RegistryPrx.uncheckedCast(communicator.stringToProxy(PROXY.format(port)))
    while True:
        try:
            return registry.createAdminSession("x", "").getAdmin()
        except Ice.ConnectionRefusedException:
            time.sleep(0.005)


def crashes_alone(alone: Alone) -> list[float]:
    import Ice

    with Ice.initialize() as communicator:
        admin = _admin(communicator, alone.port)

        def crash(name: str) -> None:
            pid = admin.getServerPid(name)
            os.kill(pid, signal.SIGKILL)
            while admin.getServerPid(name) in (0, pid):
                time.sleep(0.002)

        return [seconds(lambda number=number: crash(f"p{number}")) for number in range(CRASHES)]  # type: ignore[misc]


def crashes_of_ours(folder: str) -> list[float]:
    """Until `run` tells of the next run's pid."""

    def crash(status: Path) -> None:
        before = status.read_text()
        os.kill(int(before.split("|")[2]), signal.SIGKILL)
        while not (now := status.read_text()).startswith("running") or now.split("|")[2] == before.split("|")[2]:
            time.sleep(0.002)

    names = [Path(folder, "state/icegrid/status", f"p{number}") for number in range(CRASHES)]
    return [seconds(lambda name=name: crash(name)) for name in names]  # type: ignore[misc]


def tell(what: str, samples: dict[str, list[float]], goal: str) -> None:
    """The medians side by side, with their ratios to IceGrid alone."""
    floor = statistics.median(samples["IceGrid alone"])
    shown = "  ".join(
        f"{name} {(median := statistics.median(of)):.2f} s ({min(of):.2f}–{max(of):.2f}, ×{median / floor:.2f})"
        for name, of in samples.items()
    )
    print(f"{what}: {shown}; goal: {goal}")


def main(runs: int) -> None:
    ups: dict[str, list[float]] = {"IceGrid alone": [], "icegrid": [], "local": []}
    again: list[float] = []
    crashes: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as name:
        root = Path(name).resolve()
        many = document(root / "many.ddsl.yaml", COUNT, COUNT)
        folder = str(root / ".rcyaml/deployments/Many")
        for run in range(runs):
            is_last = run == runs - 1
            _one_run(ups["IceGrid alone"], root / "alone", lambda alone: None)
            for engine in ("icegrid", "local"):
                shutil.rmtree(root / ".rcyaml", ignore_errors=True)
                words = ("deploy", "{}", "--engine", engine, str(many))
                try:
                    ups[engine].append(seconds(lambda words=words: rcyaml(words[0], "up", *words[2:])))  # type: ignore[misc]
                    if engine == "icegrid":
                        again.append(seconds(lambda words=words: rcyaml(words[0], "up", *words[2:])))  # type: ignore[misc]
                    if is_last and engine == "icegrid":
                        crashes[engine] = crashes_of_ours(folder)
                    elif is_last:
                        running = children(folder)
                        crashes[engine] = [
                            back_after_kill(folder, f"p{n}", running[f"p{n}"]) for n in range(CRASHES)
                        ]  # fmt: skip
                finally:
                    rcyaml(words[0], "down", *words[2:])
        _one_run([], root / "alone", lambda alone: crashes.update({"IceGrid alone": crashes_alone(alone)}), "always")
    tell(f"up, {COUNT} processes from nothing", ups, "IceGrid alone + 0.5 s")
    print(f"up, nothing to do: icegrid {statistics.median(again):.2f} s; goal: 1 s")
    order = {engine: crashes[engine] for engine in ("IceGrid alone", "icegrid", "local")}
    tell(f"a crash until the next run, {CRASHES} times", order, "0.6 s")


def _one_run(
    samples: list[float], folder: Path, then: Callable[[Alone], None], activation: str = "manual"
) -> None:
    alone = Alone(folder)
    try:
        samples.append(seconds(lambda: alone.up(activation)))
        then(alone)
    finally:
        alone.down()


if __name__ == "__main__":
    if sys.argv[1:2] == ["alone"]:
        deploy_alone(int(sys.argv[2]), sys.argv[3])
    else:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
