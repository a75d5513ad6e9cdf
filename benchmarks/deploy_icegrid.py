"""Deployments with IceGrid: 50 small processes are started by IceGrid alone, by the engine `icegrid` and by `local`.

    python benchmarks/deploy_icegrid.py [RUNS]

IceGrid alone is a Python program that starts a registry and a node (plain TCP), adds an application of 50 plain servers
and starts all of them through the Admin API: without order, readiness and configuration. Nothing runs at the beginning,
and the runs of the three alternate. Then processes are killed, and the time until their next run is measured; with
IceGrid alone they are `always` servers.

The processes are `sleep`, and then, if g++ and Ice for C++ are installed, small Ice servers, which are components for
rcyaml. A client pings them, whoever starts them: the time is that until all have answered. `up` itself ends later, when
each of them has run for half a second.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deploy import COUNT, back_after_kill, children, document, rcyaml, seconds
from run import RCYAML, working_folder

CRASHES = 20
PROXY = "IceGrid/Registry:tcp -h 127.0.0.1 -p {}"
SERVER = Path(__file__).with_name("ice_server.cpp")
FIRST_PORT = 21000
COMPONENTS = {
    "answer.idsl.yaml": "module: Bench\ninterfaces:\n  Answer: {methods: {ask: }}\n",
    "answerer.cdsl.yaml": "component: Answerer\nlanguage: cpp\nimports: [answer]\nimplements: [Answer]\n",
    "many.ddsl.yaml": (
        "deployment: Many\ncomponents:\n"
        f"  p{{i}}: {{component: ., instances: {COUNT}, executable: server, port: {FIRST_PORT}}}\n"
    ),
}


@dataclass(frozen=True)
class Load:
    """The same processes twice: as a document of rcyaml, and as commands for IceGrid alone, with the proxies that
    answer when the processes are ready."""

    document: Path
    commands: list[list[str]]
    proxies: list[str]


def sleepers(folder: Path) -> Load:
    folder.mkdir()
    command = ["/bin/sh", "-c", "exec sleep 1000", "sh"]
    return Load(document(folder / "many.ddsl.yaml", COUNT, COUNT), [command] * COUNT, [])


def servers(folder: Path) -> Load | None:
    """The Ice servers; None if they cannot be built."""
    folder.mkdir()
    options = ["-O2", "-std=c++11", "-DICE_CPP11_MAPPING", "-lIce++11", "-pthread"]
    command = ["g++", str(SERVER), "-o", str(folder / "server"), *options]
    if shutil.which("g++") is None or subprocess.run(command, capture_output=True, check=False).returncode:
        return None
    for name, text in COMPONENTS.items():
        (folder / name).write_text(text, encoding="utf-8")
    commands, proxies = [], []
    for number in range(COUNT):
        at = {"Answer": FIRST_PORT + number, "CommonBehavior": FIRST_PORT + COUNT + number}
        lines = [f"{name}.Endpoints=tcp -h 127.0.0.1 -p {port}\n" for name, port in at.items()]
        (folder / f"config{number}").write_text("".join(lines), encoding="utf-8")
        commands.append([str(folder / "server"), str(folder / f"config{number}")])
        proxies.append(f"answer:tcp -h 127.0.0.1 -p {at['Answer']}")
    return Load(folder / "many.ddsl.yaml", commands, proxies)


class Alone:
    """A registry and a node of IceGrid without rcyaml, in a folder."""

    def __init__(self, folder: Path, load: Load) -> None:
        self.folder = folder
        self.load = load
        with socket.create_server(("127.0.0.1", 0)) as probe:
            self.port = probe.getsockname()[1]
        self.daemons: list[subprocess.Popen[bytes]] = []

    def up(self, activation: str = "manual") -> None:
        """Starts the application in a separate Python process."""
        for name in ("registry", "node"):
            (self.folder / name).mkdir(parents=True)
        own = "tcp -h 127.0.0.1"
        self._start("icegridregistry", {
            "IceGrid.Registry.Client.Endpoints": f"{own} -p {self.port}", "IceGrid.Registry.Server.Endpoints": own,
            "IceGrid.Registry.Internal.Endpoints": own, "IceGrid.Registry.LMDB.Path": f"{self.folder}/registry",
            "IceGrid.Registry.AdminPermissionsVerifier": "IceGrid/NullPermissionsVerifier",
        })  # fmt: skip
        while not _is_open(self.port):  # a node that cannot reach the registry tries again only after 10 s
            time.sleep(0.005)
        self._start("icegridnode", {
            "Ice.Default.Locator": f"IceGrid/Locator:{own} -p {self.port}", "IceGrid.Node.Name": "here",
            "IceGrid.Node.Endpoints": own, "IceGrid.Node.Data": f"{self.folder}/node",
            "IceGrid.Node.AllowRunningServersAsRoot": "1",
        })  # fmt: skip
        script = [sys.executable, __file__, "alone", str(self.port), activation]
        given = json.dumps([self.load.commands, self.load.proxies])
        subprocess.run(script, input=given, text=True, check=True)

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
    """Adds the application, starts all its servers, and waits until their proxies answer."""
    import Ice
    import IceGrid

    commands, proxies = json.load(sys.stdin)
    nothing = IceGrid.DistributionDescriptor("", [])
    quiet = IceGrid.PropertySetDescriptor([], [IceGrid.PropertyDescriptor("Ice.Admin.Enabled", "0")])
    servers = [
        IceGrid.ServerDescriptor(
            adapters=[], propertySet=quiet, dbEnvs=[], logs=[], description="", id=f"p{number}", exe=command[0],
            iceVersion="", pwd="/", options=command[1:], envs=[], activation=activation,
            activationTimeout="", deactivationTimeout="", applicationDistrib=False, distrib=nothing,
            allocatable=False, user="root" if os.getuid() == 0 else "",
        )
        for number, command in enumerate(commands)
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
        _wait_for(communicator, proxies)


def _wait_for(communicator: Any, proxies: Iterable[str]) -> None:
    """Waits with as little work as possible, which would slow down what is measured: Ice is asked when the port is
    open."""
    for text in proxies:
        port = int(text.rpartition(" ")[2])
        while not _is_open(port):
            time.sleep(0.005)
        while not _pings(communicator.stringToProxy(text)):
            time.sleep(0.005)


def _is_open(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def _pings(proxy: Any) -> bool:
    import Ice

    try:
        proxy.ice_ping()
    except Ice.ConnectionRefusedException:
        return False
    return True


def _admin(communicator: Any, port: int) -> Any:
    import Ice
    import IceGrid

    registry = IceGrid.RegistryPrx.uncheckedCast(communicator.stringToProxy(PROXY.format(port)))
    while True:
        try:
            return registry.createAdminSession("x", "").getAdmin()
        except Ice.ConnectionRefusedException:
            time.sleep(0.005)


def up_until_all_answer(load: Load, words: Sequence[str]) -> tuple[float, float]:
    """The seconds of an `up`, until everything answers and until its end."""
    import Ice

    began = time.perf_counter()
    with Ice.initialize() as communicator, subprocess.Popen(
        [*RCYAML, "deploy", "up", *words], stdout=subprocess.DEVNULL
    ) as process:  # fmt: skip
        _wait_for(communicator, load.proxies)
        answered = time.perf_counter() - began if load.proxies else 0
    if process.returncode:
        sys.exit("`up` failed")
    ended = time.perf_counter() - began
    return answered or ended, ended


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
    """The seconds from each crash until `run` writes the pid of the next run."""

    def crash(status: Path) -> None:
        before = status.read_text()
        os.kill(int(before.split("|")[2]), signal.SIGKILL)
        while not (now := status.read_text()).startswith("running") or now.split("|")[2] == before.split("|")[2]:
            time.sleep(0.002)

    names = [Path(folder, "state/icegrid/status", f"p{number}") for number in range(CRASHES)]
    return [seconds(lambda name=name: crash(name)) for name in names]  # type: ignore[misc]


def tell(what: str, samples: dict[str, list[float]], goal: str) -> None:
    """Prints the medians, with their ratios to IceGrid alone."""
    floor = statistics.median(samples["IceGrid alone"])
    shown = "  ".join(
        f"{name} {(median := statistics.median(of)):.2f} s ({min(of):.2f}–{max(of):.2f}, ×{median / floor:.2f})"
        for name, of in samples.items()
    )
    print(f"{what}: {shown}; goal: {goal}")


def main(runs: int) -> None:
    with working_folder() as name:
        root = Path(name).resolve()
        ups, _, again, crashes = measured(sleepers(root / "sleepers"), runs)
        tell(f"up, {COUNT} times sleep from nothing", ups, "IceGrid alone + 0.5 s")
        print(f"up, nothing to do: icegrid {statistics.median(again):.2f} s; goal: 1 s")
        tell(f"a crash until the next run, {CRASHES} times", crashes, "0.6 s")
        if load := servers(root / "servers"):
            ups, ends, again, _ = measured(load, runs)
            tell(f"up, {COUNT} servers of Ice until all answer", ups, "local ×0.9, icegrid ×1.25")
            tell(f"up, {COUNT} servers of Ice until its end", ends, "-")
            print(f"up, nothing to do: icegrid {statistics.median(again):.2f} s; goal: 1 s")
        else:
            print("Ice servers cannot be built: g++ or Ice for C++ is missing (Debian: libzeroc-ice-dev)")


def measured(
    load: Load, runs: int
) -> tuple[dict[str, list[float]], dict[str, list[float]], list[float], dict[str, list[float]]]:
    """The seconds of each `up` until everything answers and until its end, of each `up` with nothing to do, and from
    each crash to the next run."""
    ups: dict[str, list[float]] = {"IceGrid alone": [], "icegrid": [], "local": []}
    ends: dict[str, list[float]] = {"IceGrid alone": [], "icegrid": [], "local": []}
    crashes: dict[str, list[float]] = {}
    again: list[float] = []
    root = load.document.parent
    folder = str(root / ".rcyaml/deployments/Many")
    for run in range(runs):
        is_last = run == runs - 1
        with _alone(root / "alone", load) as alone:
            ups["IceGrid alone"].append(seconds(alone.up))
            ends["IceGrid alone"].append(ups["IceGrid alone"][-1])
        for engine in ("icegrid", "local"):
            shutil.rmtree(root / ".rcyaml", ignore_errors=True)
            words = ("--engine", engine, str(load.document))
            try:
                answered, ended = up_until_all_answer(load, words)
                ups[engine].append(answered)
                ends[engine].append(ended)
                if engine == "icegrid":
                    again.append(seconds(lambda words=words: rcyaml("deploy", "up", *words)))  # type: ignore[misc]
                if is_last and engine == "icegrid":
                    crashes[engine] = crashes_of_ours(folder)
                elif is_last:
                    running = children(folder)
                    crashes[engine] = [back_after_kill(folder, f"p{n}", running[f"p{n}"]) for n in range(CRASHES)]
            finally:
                rcyaml("deploy", "down", *words)
    with _alone(root / "alone", load) as alone:
        alone.up("always")
        return ups, ends, again, {"IceGrid alone": crashes_alone(alone), **crashes}


@contextmanager
def _alone(folder: Path, load: Load) -> Iterator[Alone]:
    alone = Alone(folder, load)
    try:
        yield alone
    finally:
        alone.down()


if __name__ == "__main__":
    if sys.argv[1:2] == ["alone"]:
        deploy_alone(int(sys.argv[2]), sys.argv[3])
    else:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
