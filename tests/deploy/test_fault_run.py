"""Networks go through the faults of docs/faults.md, one after the other, and nothing is lost or runs twice: what a client
of its own sees decides. On three hosts, some faults with six components; in the long form, all with thirty."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from fault_network import Fault, FaultNetwork, Turn, check, fault_network
from processes import until
from robocomp_yaml.deploy.local import procfs
from seen import NEEDS_ICEGRID
from three_hosts import NAMES

pytestmark = pytest.mark.slow
NUMBER = int(os.environ.get("RCYAML_FAULT_COMPONENTS") or 6)
IS_LONG = NUMBER >= 30
BINDER = """\
import socket, sys, time
end = time.monotonic() + 20
while time.monotonic() < end:
    try:
        bound = socket.create_server(("", int(sys.argv[1])))
        print("bound", flush=True)
        time.sleep(600)
    except OSError:
        pass
"""


def process_killed(run: FaultNetwork) -> None:
    chosen = run.one_of_each_host()
    run.kill(*chosen)
    run.settled(chosen)


def process_halted(run: FaultNetwork) -> None:
    chosen = run.one_of_each_host()
    run.kill(*chosen, number=signal.SIGSTOP)
    run.settled(chosen)
    assert all("not alive: it does not answer" in run.talk.logs(name) for name in chosen)


def worker_deadlocked(run: FaultNetwork) -> None:
    chosen = run.one_of_each_host()
    for name in chosen:
        run.tell(name, "stuck")
    run.settled(chosen)
    assert all("its worker has shown no life" in run.talk.logs(name) for name in chosen)


def exits_with_0(run: FaultNetwork) -> None:
    chosen = run.one_of_each_host()
    for name in chosen:
        run.tell(name, "exit")
    run.settled(chosen)
    assert all("ended by itself: exit code 0; restarting" in run.talk.logs(name) for name in chosen)


def dies_again_and_again(run: FaultNetwork) -> None:
    """Its user goes on without it, and uses it again."""
    run.tell("base0", "broken")
    run.kill("base0")
    until(lambda: run.talk.status()["base0"]["state"] == "given up", lambda: run.talk.logs("base0"), 150)
    until(lambda: run.polled.turns["user0"][-1].peer.startswith("none"), "its user answers without it")
    assert "given up" in run.talk.deploy("status", code=1)
    run.control("base0", "broken").unlink()
    run.talk.deploy("up")
    run.settled(["base0"])


def peer_absent_at_start(run: FaultNetwork) -> None:
    run.tell("base1", "broken")
    run.kill("base1")
    until(lambda: run.talk.status()["base1"]["state"] == "given up", lambda: run.talk.logs("base1"), 150)
    run.kill("user1")
    until(lambda: "waiting for Peer at" in run.talk.deploy("status", code=None), lambda: run.talk.logs("user1"))
    run.control("base1", "broken").unlink()
    run.talk.deploy("up")
    run.settled(["base1", "user1"])


def runner_killed(run: FaultNetwork) -> None:
    chosen = run.one_of_each_host()
    for name in chosen:
        os.kill(int(run.told(name)[1]), signal.SIGKILL)
    run.settled(chosen)


def supervision_halted(run: FaultNetwork) -> None:
    """On each host all scripts, which `watch` lets go on, except that of the registry; then all daemons, which their
    guards let go on."""
    for programs in (("bash",), ("perl", "icegridnode", "icegridregistry")):
        halted = [pid for host in NAMES for pid in run.marked_on(host) if procfs.command(pid)[0] in programs]
        assert len(halted) > len(NAMES)
        halt(halted)
        if programs == ("bash",):
            assert "RC7007" in run.talk.deploy("status", code=None)
        until(lambda pids=halted: not any(map(is_halted, pids)), lambda: str([*map(procfs.command, halted)]))  # noqa: B023
    run.settled([])
    chosen = run.one_of_each_host()
    run.kill(*chosen)
    run.settled(chosen)


def supervisor_halted(run: FaultNetwork) -> None:
    """Alone; with its keeper, until the next command."""
    chosen = run.one_of_each_host()
    keeper, supervisor = _keeper_and_supervisor(run)
    halt([supervisor])
    run.kill(*chosen)
    run.settled(chosen)
    run.begin()
    halt([keeper, supervisor])
    assert "RC7007" in run.talk.deploy("status")
    run.settled([])


def halt(pids: list[int]) -> None:
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)


def is_halted(pid: int) -> bool:
    found = procfs.entry(pid)
    return found is not None and found.is_halted


def icestorm_killed(run: FaultNetwork) -> None:
    run.kill("storm")
    run.settled([])


def node_killed(run: FaultNetwork) -> None:
    run.talk.kill_daemon("nodes/head", for_good=False)
    run.settled(run.on("head"))


def registry_killed(run: FaultNetwork) -> None:
    run.talk.kill_daemon("registry", for_good=False)
    run.settled([])
    run.talk.kill_daemon("registry", for_good=True)
    chosen = run.on("arm")[:1]
    run.kill(*chosen)
    run.settled(chosen)


def keeper_killed(run: FaultNetwork) -> None:
    keeper = b"robocomp_yaml.deploy.icegrid.keeper"
    for pid in procfs.marked(run.talk.folder):
        with suppress(OSError):
            if keeper in Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0"):
                os.kill(pid, signal.SIGKILL)
    run.settled([])


def link_cut(run: FaultNetwork) -> None:
    run.talk.hosts.link("arm", "down")
    try:
        until(lambda: run.talk.status()[run.on("arm")[0]]["state"] == "lost", "the host does not answer")
        time.sleep(20 if IS_LONG else 5)
    finally:
        run.talk.hosts.link("arm", "up")
    run.settled([])


def host_gone(run: FaultNetwork) -> None:
    """Its power is cut; later its node is started again."""
    run.talk.hosts.link("head", "down")
    for pid in run.marked_on("head"):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    until(lambda: run.talk.status()[run.on("head")[0]]["state"] == "lost", "the host does not answer")
    run.talk.hosts.link("head", "up")
    run.talk.start_node("head")
    run.settled(run.on("head"))


def operator_gone(run: FaultNetwork) -> None:
    """The machine with the registry, the keeper and the IceStorm."""
    for pid in run.marked_on("onboard"):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    time.sleep(3)
    run.talk.deploy("up")
    run.settled(run.on("onboard"))


def port_taken(run: FaultNetwork) -> None:
    name = run.on("arm")[0]
    port = next(end["port"] for end in run.talk.status()[name]["endpoints"] if end["identity"] == "count")
    binder = run.talk.hosts.begin("arm", [sys.executable, "-c", BINDER, str(port)])
    try:
        run.kill(name)
        assert binder.stdout is not None and binder.stdout.readline() == "bound\n"

        def is_told() -> bool:
            """In one line, though the command of the other program has several."""
            lines = run.talk.logs(name).splitlines()
            return any(f"port {port} is used by" in line and line.endswith("until it is free") for line in lines)

        until(is_told, lambda: run.talk.logs(name))
    finally:
        binder.kill()
        binder.communicate()
    run.settled([name])


def up_interrupted(run: FaultNetwork) -> None:
    """By Ctrl-C, and by SIGKILL; the next one completes it."""
    chosen = run.one_of_each_host()
    for number in (signal.SIGINT, signal.SIGKILL):
        run.begin()
        run.write(**dict.fromkeys(chosen, f", restart: {{delay: {100 + number} ms}}, args: [--N={int(number)}]"))
        up = run.talk.begin("up")
        time.sleep(2)
        up.send_signal(number)
        up.communicate()
        run.talk.deploy("up")
        run.settled(chosen)
    run.begin()
    run.write()
    run.talk.deploy("up")
    run.settled(chosen)


def disk_full(run: FaultNetwork) -> None:
    """While nothing can be written, processes go on; `up` changes nothing."""
    if not os.path.ismount(run.root):
        print("only root may mount a small disk")
        return
    run.write(base0=", args: [--N=1]")
    filler = run.root / "filler"
    with filler.open("wb") as file, suppress(OSError):
        while True:
            file.write(b"x" * (1 << 16))
            file.flush()
    until(lambda: shutil.disk_usage(run.root).free < 4096, "it is full")
    said = run.talk.deploy("up", code=1)
    assert "no space left on device" in said, said
    assert "Traceback" not in said
    filler.unlink()
    run.write()
    run.settled([])
    run.talk.deploy("up")
    run.settled([])


def document_removed(run: FaultNetwork) -> None:
    (run.root / "talk.ddsl.yaml").unlink()
    assert run.talk.rcyaml("deploy", "status", "Talk").count(" ready ") == len(run.entries) + 1
    run.write()
    run.settled([])


def folder_removed(run: FaultNetwork) -> None:
    """With the document, too: by its name, the deployment is found, and taken down."""
    (run.root / "talk.ddsl.yaml").unlink()
    shutil.rmtree(run.root / ".rcyaml")
    assert "Talk" in run.talk.rcyaml("deploy", "ls")
    run.settled([], has_document=False)
    run.talk.rcyaml("deploy", "down", "Talk")


def supervisor_killed(run: FaultNetwork) -> None:
    """Everything ends with it, and starts again with the next `up`."""
    _, supervisor = _keeper_and_supervisor(run)
    os.kill(supervisor, signal.SIGKILL)
    until(lambda: not any(run.talk.copies(name) for name in run.entries), "all processes end")
    assert "RC7007" in run.talk.deploy("up")
    run.settled(run.entries)


def keeper_of_supervisor_killed(run: FaultNetwork) -> None:
    keeper, _ = _keeper_and_supervisor(run)
    os.kill(keeper, signal.SIGKILL)
    run.settled([])


def _keeper_and_supervisor(run: FaultNetwork) -> tuple[int, int]:
    keeper = int(Path(run.talk.folder, "state", "supervisor").read_text(encoding="ascii").split()[0])
    (supervisor,) = [one.pid for one in procfs.table().values() if one.parent == keeper]
    return keeper, supervisor


FAULTS: tuple[Fault, ...] = (
    process_killed, process_halted, worker_deadlocked, exits_with_0, dies_again_and_again, peer_absent_at_start,
    runner_killed, supervision_halted, icestorm_killed, node_killed, registry_killed, keeper_killed, link_cut, host_gone, operator_gone,
    port_taken, up_interrupted, disk_full, document_removed, folder_removed,
)  # fmt: skip
LOCAL: tuple[Fault, ...] = (
    process_killed, process_halted, exits_with_0, icestorm_killed, supervisor_killed, supervisor_halted, port_taken, up_interrupted,
    document_removed, keeper_of_supervisor_killed,
)  # fmt: skip
SHORT = (
    process_killed,
    exits_with_0,
    supervision_halted,
    icestorm_killed,
    node_killed,
    registry_killed,
    link_cut,
    document_removed,
)


@pytest.mark.parametrize(
    ("turns", "why"),
    [
        ([("a", 1, 0), ("b", 1, 0), ("a", 2, 0)], "two runs"), ([("a", 1, 0), ("a", 3, 0)], "then"),
        ([("a", 1, 0), ("a", 1, 0)], "then"), ([("a", 1, 0), ("a", 4, 2), ("b", 7, 0)], ""),
    ],
)  # fmt: skip
def test_what_the_client_would_notice(turns: list[tuple[str, int, int]], why: str) -> None:
    seen = [Turn(0.0, run, number, 0, "", failed) for run, number, failed in turns]
    if not why:
        check("base0", seen)
        return
    with pytest.raises(AssertionError, match=why):
        check("base0", seen)


@pytest.fixture
def run_root(tmp_path: Path) -> Path:
    """A folder on a disk of its own if possible, so that it can be filled."""
    if IS_LONG:
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300m", "tmpfs", str(tmp_path)], check=False)
    return tmp_path


def go_through(run: FaultNetwork, faults: tuple[Fault, ...]) -> None:
    for fault in faults:
        run.begin()
        began = time.monotonic()
        print(f"{fault.__name__} …", flush=True)
        fault(run)
        print(f"{fault.__name__}: {time.monotonic() - began:.0f} s", flush=True)


@pytest.mark.skipif(shutil.which("icebox") is None, reason="icebox is not installed (Debian: zeroc-icebox)")
def test_one_machine(tmp_path: Path) -> None:
    with fault_network(tmp_path, 6, is_local=True) as run:
        go_through(run, LOCAL)
        run.talk.deploy("down")
        until(lambda: not any(run.talk.copies(name) for name in run.entries), "nothing is left")


@NEEDS_ICEGRID
def test_three_hosts(run_root: Path) -> None:
    try:
        with fault_network(run_root, NUMBER) as run:
            go_through(run, FAULTS if IS_LONG else SHORT)
            assert len(run.polled.turns) == NUMBER
            assert sorted(set(run.hosts.values())) == sorted(NAMES)
            if not IS_LONG:
                run.talk.deploy("down")
            until(lambda: not any(run.talk.copies(name) for name in run.entries), "nothing is left")
    finally:
        if os.path.ismount(run_root):
            subprocess.run(["umount", "-l", str(run_root)], check=True)
