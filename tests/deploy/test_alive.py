"""A process that does not answer is noticed, shown and restarted, without anyone asking; one in a debugger is not."""

from __future__ import annotations

import os
import signal
import socket
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from msgspec.structs import replace

from processes import Ports, hanging, until
from robocomp_yaml.deploy.engine import RUNNING, WAITING
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.network.network import AUTO, FOREVER, Endpoint, Liveness, Process, Readiness, RestartRule
from small_networks import Place

pytest.importorskip("Ice", reason="Ice's Python module is not installed")

SLICE = Path(__file__).resolve().parents[2] / "templates" / "slice" / "RcYaml.ice"
SERVER = """\
import os, sys, time
import Ice
Ice.loadSlice("", ["--all", sys.argv[2]])
import RcYaml

class Facet(RcYaml.Introspection):
    def report(self, names, current):
        state = RcYaml.Entry("c", {"state": "running"}, {})
        return {"state": [state]}

    def getHeartbeat(self, current):
        return RcYaml.Heartbeat(int(open("age").read()) if os.path.exists("age") else 0, 100)

with Ice.initialize() as ice:
    adapter = ice.createObjectAdapterWithEndpoints("C", f"tcp -h 127.0.0.1 -p {sys.argv[1]}")
    identity = ice.stringToIdentity("commonbehavior")
    adapter.add(type("C", (Ice.Object,), {})(), identity)
    if sys.argv[3] == "facet":
        adapter.addFacet(Facet(), identity, "rcyaml")
    adapter.activate()
    print("serves", flush=True)
    ice.waitForShutdown()
"""
EVERY = 0.3


class Served:
    """A process that serves Ice, and may have a heartbeat."""

    def __init__(self, place: Place, port: int, facet: str = "facet") -> None:
        self.place, self.port = place, port
        self.proxy = f"commonbehavior:tcp -h 127.0.0.1 -p {port}"
        (place.root / "server.py").write_text(SERVER)
        command = (sys.executable, str(place.root / "server.py"), str(port), str(SLICE), facet)
        self.process = Process(
            "c", "localhost", command, str(place.root),
            ready=Readiness(pings=(self.proxy,), within=20), introspection=self.proxy,
            endpoints=(Endpoint("C", "commonbehavior", port, f"tcp -h 127.0.0.1 -p {port}"),),
        )  # fmt: skip

    def up(self, restart: str = "on-failure", **alive: object) -> int:
        """Starts it; returns its pid."""
        liveness = Liveness(self.proxy, **{"every": EVERY, "within": 0.5, **alive})  # type: ignore[arg-type]
        self.process = replace(self.process, alive=liveness, restart=RestartRule(restart))
        assert self.place.up(self.process).diagnostics == []
        time.sleep(1)  # it has answered once
        return self.place.pids()["c"]

    @property
    def why(self) -> str:
        return self.place.observe()["c"].not_alive

    def is_back(self, pid: int) -> bool:
        now = self.place.observe()["c"]
        return now.state == RUNNING and now.pid not in (0, pid) and not now.not_alive

    def say(self, age: float) -> None:
        (self.place.root / "new").write_text(str(int(age * 1000)))
        (self.place.root / "new").rename(self.place.root / "age")

    def log(self) -> str:
        return "\n".join(self.place.log("c"))


@pytest.fixture
def served(place: Place, free_port: Ports) -> Iterator[Served]:
    yield Served(place, free_port())
    place.down()


def test_a_halted_process_is_restarted(served: Served) -> None:
    pid = served.up()
    time.sleep(3 * EVERY)
    assert served.place.pids()["c"] == pid
    os.kill(pid, signal.SIGSTOP)
    until(lambda: served.is_back(pid), lambda: f"a restart:\n{served.log()}")
    now = served.place.observe()["c"]
    assert now.restarts == 1 and now.last_exit == "not alive: it does not answer"
    assert "rcyaml: not alive: it does not answer" in served.log()
    assert not os.path.exists(f"/proc/{pid}")


def test_it_is_noticed_in_time(served: Served) -> None:
    """With the defaults, at most 12 s."""
    pid = served.up(every=5.0, within=2.0, restarts=False)
    os.kill(pid, signal.SIGSTOP)
    began = time.monotonic()
    until(lambda: served.why, "a notice", 30)
    assert time.monotonic() - began <= 12.5
    os.kill(pid, signal.SIGCONT)


def test_it_is_only_told(served: Served) -> None:
    pid = served.up(restarts=False)
    os.kill(pid, signal.SIGSTOP)
    until(lambda: served.why == "it does not answer", "a notice")
    status = served.place.status(served.process)["c"]
    assert not status.is_ready and status.is_down
    assert served.place.pids()["c"] == pid
    os.kill(pid, signal.SIGCONT)
    until(lambda: not served.why, "life")
    assert "rcyaml: alive again" in served.log() and served.place.status(served.process)["c"].is_ready


def test_it_is_not_ended_if_nobody_would_start_it(served: Served) -> None:
    pid = served.up(restart="no")
    os.kill(pid, signal.SIGSTOP)
    until(lambda: served.why, "a notice")
    time.sleep(3 * EVERY)
    assert served.place.pids()["c"] == pid and os.path.exists(f"/proc/{pid}")


@pytest.mark.parametrize(
    ("worker", "age", "is_noticed"),
    [(AUTO, 9.0, False), (AUTO, 11.0, True), (60.0, 50.0, False), (3.0, 4.0, True), (FOREVER, 1e6, False)],
)
def test_a_worker_without_heartbeat(served: Served, worker: float, age: float, is_noticed: bool) -> None:
    served.up(worker=worker, restarts=False)
    served.say(age)
    if is_noticed:
        until(lambda: served.why == f"its worker has shown no life for {age:.0f} s", "a notice")
        served.say(0)
        until(lambda: not served.why, "life")
    else:
        time.sleep(4 * EVERY)
        assert not served.why


def test_a_deadlocked_worker_is_restarted(served: Served) -> None:
    pid = served.up()
    served.say(30)
    until(lambda: served.place.pids()["c"] not in (0, pid), "a restart")
    served.say(0)
    until(lambda: served.is_back(pid), lambda: f"life:\n{served.log()}")
    assert "its worker has shown no life for 30 s" in served.log()


def test_a_program_without_the_facet_is_pinged(place: Place, free_port: Ports) -> None:
    old = Served(place, free_port(), "none")
    pid = old.up()
    time.sleep(4 * EVERY)
    assert place.pids()["c"] == pid and not old.why
    os.kill(pid, signal.SIGSTOP)
    until(lambda: old.is_back(pid), "a restart")
    place.down()


def test_a_process_in_a_debugger_is_left_alone(served: Served) -> None:
    pid = served.up()
    with hanging(pid):
        until(lambda: procfs.is_traced([pid]), "a tracer")
        time.sleep(2.5)
        assert served.place.pids()["c"] == pid and not served.why
    until(lambda: not procfs.is_traced([pid]), "the end of it")
    time.sleep(4 * EVERY)
    assert served.place.pids()["c"] == pid and not served.why


def test_a_slow_start_is_not_missed(place: Place, free_port: Ports) -> None:
    slow = Served(place, free_port())
    (place.root / "server.py").write_text(f"import time\ntime.sleep(2)\n{SERVER}")
    slow.up(every=0.1, within=0.1)
    assert place.observe()["c"].restarts == 0
    place.down()


def test_a_change_applies_without_a_restart(served: Served) -> None:
    pid = served.up(restarts=False, every=60.0)
    os.kill(pid, signal.SIGSTOP)
    time.sleep(2 * EVERY)
    assert not served.why
    os.kill(pid, signal.SIGCONT)
    assert served.up(restarts=False) == pid
    os.kill(pid, signal.SIGSTOP)
    until(lambda: served.why, "a notice")
    os.kill(pid, signal.SIGCONT)
    until(lambda: not served.why, "life")
    served.say(30)
    until(lambda: served.why, "another notice")
    served.process = replace(served.process, alive=None)
    served.place.up(served.process)
    assert served.place.pids()["c"] == pid and not served.why, "it is not asked any more"


def test_a_restart_waits_for_its_port(served: Served) -> None:
    """More often than it would try."""
    pid = served.up()
    os.kill(pid, signal.SIGSTOP)
    os.kill(pid, signal.SIGKILL)
    with socket.socket() as thief:
        thief.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)

        def is_taken() -> bool:
            try:
                thief.bind(("127.0.0.1", served.port))
            except OSError:
                return False
            thief.listen()
            return True

        until(is_taken, "the port")
        now = served.place.observe()["c"]
        if now.state == RUNNING:  # it was faster
            os.kill(now.pid, signal.SIGKILL)
        until(lambda: f"port {served.port} is used by" in served.log(), lambda: f"waiting:\n{served.log()}")
        time.sleep(1.5)
        assert served.place.observe()["c"].state == WAITING
    until(lambda: served.is_back(pid), lambda: f"a restart:\n{served.log()}")
