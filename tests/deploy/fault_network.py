"""A network of components on three hosts, or on this machine alone, and a client of its own that calls each of them all the time.

The client uses Ice alone. It sees which run of each component answers: so what is lost, started again or runs twice
does not depend on what rcyaml says.
"""

from __future__ import annotations

import itertools
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from processes import until
from robocomp_yaml.deploy.local import procfs
from three_hosts import NAMES, Deployment, Hosts, three_hosts

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Count.idsl.yaml": """\
module: RoboCompCount
types:
  Turn: {struct: {run: string, number: long, heard: long, peer: string}}
interfaces:
  Count: {methods: {next: {returns: Turn}, who: {idempotent: true, returns: string}}}
topics:
  Tick: {methods: {now: {in: {number: long}}}}
""",
    "base/base.cdsl.yaml": "component: Base\nlanguage: python\nimports: [Count]\nimplements: [Count]\n"
    "publishes: [Tick]\nperiod: 250 ms\n",
    "user/user.cdsl.yaml": "component: User\nlanguage: python\nimports: [Count]\nimplements: [Count]\n"
    "requires: [{Peer: {interface: Count, timeout: 1 s}}]\nsubscribes: [Tick]\nperiod: 250 ms\n",
}
# What a component does is told by files CONTROL.WHAT, once each but `broken`.
WORKER = """\
import os
import threading
import time

import Ice
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompCount

CONTROL = os.environ["CONTROL"]


def is_told(what):
    try:
        os.unlink(f"{CONTROL}.{what}")
    except FileNotFoundError:
        return False
    return True


class SpecificWorker(GenericWorker):
    def initialize(self):
        if os.path.exists(f"{CONTROL}.broken"):
            raise RuntimeError("no motor")
        self.run, self.lock = f"{os.getpid()}-{time.time_ns()}", threading.Lock()
        self.number = self.heard = 0

    def compute(self):
        if is_told("exit"):
            os._exit(0)
        if is_told("stuck"):
            threading.Event().wait()
        self.turn()

    def Count_next(self):
        with self.lock:
            self.number += 1
            return RoboCompCount.Turn(run=self.run, number=self.number, heard=self.heard, peer=self.peer())

    def Count_who(self):
        return self.run

"""
BASE = WORKER + """\
    def turn(self):
        self.tick_proxy.now(self.number)

    def peer(self):
        return ""
"""  # fmt: skip
USER = WORKER + """\
    def turn(self):
        pass

    def peer(self):
        try:
            return self.peer_proxy.who()
        except Ice.Exception as error:
            return f"none: {type(error).__name__}"

    def Tick_now(self, number):
        self.heard += 1
"""  # fmt: skip
HEAD = """\
deployment: Talk
hosts: {{onboard: {{address: {onboard}}}, head: {{address: {head}}}, arm: {{address: {arm}}}}}
services: {{storm: {{icestorm: {{host: onboard}}}}}}
alive: {{every: 2 s, within: 3 s, misses: 2, worker: 8 s}}
components:
"""
HERE = """\
deployment: Talk
services: {{storm: {{icestorm: }}}}
alive: {{every: 2 s, within: 3 s, misses: 2, worker: 8 s}}
components:
"""
CLIENT = """\
import json
import sys
import time

import Ice

Ice.loadSlice("", ["--all", sys.argv[1]])
import RoboCompCount

properties = Ice.createProperties()
properties.setProperty("Ice.Default.InvocationTimeout", "4000")
properties.setProperty("Ice.Override.ConnectTimeout", "2000")
properties.setProperty("Ice.RetryIntervals", "-1")
data = Ice.InitializationData()
data.properties = properties
with Ice.initialize(data) as ice:
    proxies = {name: RoboCompCount.CountPrx.uncheckedCast(ice.stringToProxy(proxy))
               for name, proxy in json.loads(sys.argv[2]).items()}
    pending = {}
    while True:
        for name, proxy in proxies.items():
            if name not in pending:
                pending[name] = time.time(), proxy.nextAsync()
        for name, (begin, call) in list(pending.items()):
            if call.done():
                del pending[name]
                try:
                    turn = call.result()
                    answer = [turn.run, turn.number, turn.heard, turn.peer]
                except Ice.Exception as error:
                    answer = type(error).__name__
                print(json.dumps([begin, name, answer]))
        sys.stdout.flush()
        time.sleep(0.1)
"""


@dataclass(frozen=True)
class Turn:
    """An answer to the client. `begin` is when it asked, `failed` how many calls before had no answer."""

    begin: float
    run: str
    number: int
    heard: int
    peer: str
    failed: int


@dataclass
class Polled:
    """What the client has seen of each component."""

    process: subprocess.Popen[str]
    turns: dict[str, list[Turn]] = field(default_factory=dict)
    failed: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as lines:
            for line in lines:
                if line.endswith("\n"):  # it is cut off when the client is killed
                    begin, name, answer = json.loads(line)
                    if isinstance(answer, str):
                        self.failed[name] = self.failed.get(name, 0) + 1
                    else:
                        self.turns.setdefault(name, []).append(Turn(begin, *answer, self.failed.pop(name, 0)))

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        self._reader.join()

    def runs(self) -> dict[str, str]:
        return {name: turns[-1].run for name, turns in self.turns.items()}


def check(name: str, turns: list[Turn]) -> None:
    """No run of a component answers after another one did, and each call counted once."""
    order = [turn.run for turn in turns]
    changes = [run for at, run in enumerate(order) if not at or order[at - 1] != run]
    assert len(changes) == len(set(changes)), f"two runs of {name} answered in turn: {changes}"
    for before, after in itertools.pairwise(turns):
        if before.run == after.run:
            assert 1 <= after.number - before.number <= 1 + after.failed, f"{name}: {before}, then {after}"


@dataclass
class FaultNetwork:
    """The running network, with its client. `runs` are those that answered last when a fault began."""

    talk: Deployment
    polled: Polled
    hosts: dict[str, str]
    entries: dict[str, str]
    head: str = HEAD
    runs: dict[str, str] = field(default_factory=dict)

    @property
    def root(self) -> Path:
        return self.talk.root

    def on(self, host: str) -> list[str]:
        return [name for name, own in self.hosts.items() if own == host]

    @property
    def is_local(self) -> bool:
        return self.head == HERE

    def one_of_each_host(self) -> list[str]:
        return [self.on(host)[-1] for host in NAMES]

    def pid(self, name: str) -> int:
        return self.talk.pids()[name] if self.is_local else int(self.told(name)[2])

    def told(self, name: str) -> list[str]:
        """What the process's own host says."""
        return (self.talk.state / "status" / name).read_text().split("|")

    def kill(self, *names: str, number: int = signal.SIGKILL) -> None:
        for name in names:
            os.kill(self.pid(name), number)

    def tell(self, name: str, what: str) -> None:
        self.control(name, what).touch()

    def control(self, name: str, what: str) -> Path:
        return self.root / "control" / f"{name}.{what}"

    def marked_on(self, host: str) -> list[int]:
        """The processes of the deployment on a host."""
        own = f"net:[{os.stat(f'/run/netns/{self.talk.hosts.prefix}{host}').st_ino}]"
        return [pid for pid in procfs.marked(self.talk.folder) if _net_of(pid) == own]

    def write(self, **more: str) -> None:
        """Writes the document, with more keys for some entries."""
        lines = [f"  {name}: {{{text}{more.get(name, '')}}}\n" for name, text in self.entries.items()]
        document = self.head.format(**self.talk.hosts.addresses) + "".join(lines)
        (self.root / "talk.ddsl.yaml").write_text(document)

    def begin(self) -> None:
        self.settled()
        self.runs = self.polled.runs()

    def settled(self, changed: Iterable[str] | None = None, *, has_document: bool = True) -> None:
        """Waits until each component answers, calls its peer and hears its topic. Of the network as it was when the
        fault began, exactly these have been started again, and each process runs once."""
        again = set(changed or ())
        begin, heard = time.time(), {name: turns[-1].heard for name, turns in self.polled.turns.items()}

        def missing() -> list[str]:
            found = []
            for name in self.entries:
                last = self.polled.turns.get(name, [None])[-1]
                if last is None or last.begin < begin:
                    found.append(f"{name} does not answer")
                elif changed is not None and name in again and last.run == self.runs[name]:
                    found.append(f"{name} was not started again")
                elif last.peer.startswith("none"):
                    found.append(f"{name} has no peer: {last.peer}")
                elif name.startswith("user") and last.heard == heard.get(name, 0):
                    found.append(f"{name} hears nothing")
            return found

        until(lambda: not missing(), lambda: f"{missing()}\n{self.talk.deploy('status', code=None)}", 150)
        if changed is not None:
            now = self.polled.runs()
            assert {name for name, run in now.items() if run != self.runs[name]} == again
        if has_document:
            self.ready()
        for name, turns in self.polled.turns.items():
            check(name, turns)
        copies = {name: self.talk.copies(name) for name in (*self.entries, "storm")}
        assert set(copies.values()) == {1}, copies

    def ready(self) -> None:
        """Waits until `status` says that all is as desired."""

        def is_ready() -> bool:
            return all(one["ready"] for one in self.talk.status().values())

        until(is_ready, lambda: self.talk.deploy("status", code=None), 150)


def _net_of(pid: int) -> str:
    try:
        return os.readlink(f"/proc/{pid}/ns/net")
    except OSError:
        return ""


@contextmanager
def fault_network(root: Path, number: int, *, is_local: bool = False) -> Iterator[FaultNetwork]:
    """The network with so many components, all ready. Skips the test without three hosts, unless it `is_local`."""
    pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with nullcontext(Hosts(dict.fromkeys(NAMES, "127.0.0.1"))) if is_local else three_hosts() as hosts:
        if not is_local:
            pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
            hosts.need_a_network("so no three hosts")
        talk = Deployment(hosts, root, {"XDG_STATE_HOME": f"{root}/own"})
        (root / "control").mkdir()
        entries, where = {}, dict[str, str]()
        for place in range(number):
            kind, pair = ("base", "user")[place % 2], place // 2
            name, host = f"{kind}{pair}", NAMES[(pair + place % 2) % 3]
            more = "" if is_local else f", host: {host}"
            more += f", connect: {{Peer: base{pair}}}" if kind == "user" else ""
            entries[name] = (
                f"component: {kind}, ready: 100 s, topics: {{Tick: tick{pair}}}{more}, "
                f"env: {{CONTROL: {root}/control/{name}}}"
            )
            where[name] = host
        network = FaultNetwork(talk, None, where, entries, HERE if is_local else HEAD)  # type: ignore[arg-type]  # later
        write_tree(root, DOCUMENTS)
        network.write()
        try:
            talk.rcyaml("compile")
            write_tree(root, {"base/src/specificworker.py": BASE, "user/src/specificworker.py": USER})
            if not is_local:
                talk.deploy("up", code=1)
                for host in NAMES[1:]:
                    talk.start_node(host)
            talk.deploy("up")
            client = [sys.executable, "-c", CLIENT, f"{root}/slice/Count.ice", _addresses(talk)]
            network.polled = Polled(hosts.begin("onboard", client))
            try:
                yield network
            finally:
                network.polled.end()
        finally:
            talk.clean_up()


def _addresses(talk: Deployment) -> str:
    found = {}
    for name, one in talk.status().items():
        for end in one["endpoints"]:
            if end["identity"] == "count":
                found[name] = f"count:tcp -h {end['host']} -p {end['port']}"
    return json.dumps(found)


Fault = Callable[[FaultNetwork], Any]
