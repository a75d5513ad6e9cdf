"""The script that runs a process for IceGrid, without IceGrid: arguments, environment, restarts, logs, the end."""

from __future__ import annotations

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from processes import Ports, until
from robocomp_yaml import resources
from robocomp_yaml.deploy.icegrid.descriptors import alive_rule
from robocomp_yaml.deploy.icegrid.status import MeasuredUse, RunStatus, of_text
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.network.network import AUTO, FOREVER, Liveness, Process

SCRIPT = Path(resources.folder("templates")) / "icegrid" / "run"
WATCH = SCRIPT.with_name("watch")
ONCE = "1 no 10 100 5 60000"


@dataclass
class Runner:
    """One process `arm`, run as by IceGrid. `last` is its Ice.Config."""

    folder: Path
    environment: dict[str, str] = field(default_factory=dict)
    started: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def start(self, *words: str, rule: str = ONCE, **environment: str) -> subprocess.Popen[bytes]:
        command = ["setpriv", "--pdeathsig", "KILL", "--", "bash", str(SCRIPT), "arm", str(self.folder), *words]
        self.started.append(
            subprocess.Popen(
                [*command, "--Ice.Config=/nowhere"], env={**os.environ, "RCYAML_RESTART": rule, **environment},
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )
        )  # fmt: skip
        return self.started[-1]

    def to_end(self, *words: str, rule: str = ONCE, **environment: str) -> str:
        """The log of a process that has ended for good, without the times."""
        assert self.start(*words, rule=rule, **environment).wait(20) == 0
        until(lambda: "ended by itself" in self.log or "given up" in self.log or "rcyaml: the" in self.log, "the log")
        return self.log

    @property
    def log(self) -> str:
        path = self.folder / "logs" / "arm.log"
        lines = path.read_text().splitlines() if path.exists() else []
        return "\n".join(line[len("2026-11-21T10:02:03.123Z ") :] for line in lines)

    def said_pid(self) -> int:
        """The number that the program prints, in any line of the log."""
        found = until(lambda: re.search(r"^it is (\d+)\.$", self.log, re.MULTILINE), lambda: self.log)
        return int(found[1])

    @property
    def told(self) -> tuple[str, str, int]:
        """Its state, how its last run ended, and the number of restarts."""
        last = self.status
        assert last
        return last.state, last.last_exit, last.restarts

    @property
    def status(self) -> RunStatus | None:
        path = self.folder / "state" / "icegrid" / "status" / "arm"
        return of_text(path.read_text()) if path.exists() else None


@pytest.fixture
def runner(tmp_path: Path) -> Iterator[Runner]:
    runner = Runner(tmp_path / "a folder")
    yield runner
    for process in runner.started:
        process.kill()
        process.wait()
    for pid in procfs.marked(str(runner.folder)):  # what its process started, if the test failed
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def show(*words: str) -> list[str]:
    return ["=sh", "=-c", '=printf "%s|" "$@"; echo', "=sh", *(f"={word}" for word in words)]


def test_each_run_begins_in_the_log_before_what_it_prints(tmp_path: Path) -> None:
    """Also on a busy machine: a line of an earlier run would make nothing ready."""
    runners = [Runner(tmp_path / str(number)) for number in range(16)]
    ends = [runner.start(*show("hi"), rule="1 always 1 1 20 600000") for runner in runners]
    assert [end.wait(60) for end in ends] == [0] * len(runners)
    for runner in runners:
        until(lambda runner=runner: "rcyaml: given up" in runner.log, "the log")
        lines = [re.sub(r"\d+", "N", line) for line in runner.log.splitlines() if not line.startswith("rcyaml: ended")]
        assert lines[:-1] == ["rcyaml: started, pid N", "hi|"] * 21


def test_a_deleted_log_begins_anew(runner: Runner) -> None:
    runner.start("=sh", "=-c", "=while echo a line; do sleep 0.05; done")
    until(lambda: "a line" in runner.log, "it prints")
    shutil.rmtree(runner.folder / "logs")
    until(lambda: runner.log.count("a line") >= 3, "further lines")
    assert "started" not in runner.log


def test_arguments_are_passed_unchanged(runner: Runner) -> None:
    words = ["", "two words", "$HOME", "${x}", "'\"\\", "*", "--Ice.Config=mine", "é"]
    assert "|".join(words) + "|" in runner.to_end(*show(*words))


def test_its_environment_is_set_without_that_of_the_script(runner: Runner) -> None:
    entries = {"RCYAML_ENTRY_0": "ONE=a b\\0044c=\\\\n", "RCYAML_ENTRY_11": "EMPTY="}
    log = runner.to_end("e0", "e11", "sTWO=SECRET", "=env", SECRET="s3cr t", RCYAML_CONFIG="x", **entries)
    assert "\nONE=a b$c=\\n\n" in log and "\nEMPTY=\n" in log and "\nTWO=s3cr t\n" in log
    assert "RCYAML_CONFIG" not in log and "RCYAML_RESTART" not in log and "RCYAML_ENTRY" not in log


@pytest.mark.parametrize(
    ("words", "environment", "is_set"),
    [
        ((), {}, None),
        ((), {"LC_ALL": "C.UTF-8"}, "C.UTF-8"),
        ((), {"LC_ALL": "C", "RCYAML_LANGUAGE": "none"}, None),
        ((), {"LC_ALL": "C", "RCYAML_LANGUAGE": "C.UTF-8"}, "C.UTF-8"),
        (("e0",), {"RCYAML_ENTRY_0": "LC_ALL=POSIX"}, "POSIX"),
        (("sLC_ALL=OTHER",), {"OTHER": "POSIX"}, "POSIX"),
        (("sLC_ALL=LC_ALL",), {"LC_ALL": "C", "RCYAML_LANGUAGE": "C.UTF-8"}, "C.UTF-8"),
    ],
)
def test_its_locale_is_from_its_document_or_the_node(
    runner: Runner, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], environment: dict[str, str],
    is_set: str | None,
) -> None:  # fmt: skip
    monkeypatch.delenv("LC_ALL", raising=False)
    lines = runner.to_end(*words, "=env", **environment).splitlines()
    assert [line for line in lines if line.startswith(("LC_ALL=", "RCYAML_LANGUAGE="))] == (
        [] if is_set is None else [f"LC_ALL={is_set}"]
    )


@pytest.mark.parametrize(
    ("raw", "meant"),
    [(b"a $b\\n\n", b"a $b\\n"), (b"a\r\n", b"a"), (b"a\r", b"a\r"), (b"", b""), (b"\xff\n\n", b"\xff\n")],
)
def test_a_variable_from_a_file(runner: Runner, tmp_path: Path, raw: bytes, meant: bytes) -> None:
    (tmp_path / "my token").write_bytes(raw)
    words = ("=python3", "=-c", "=import os; print(ascii(os.fsencode(os.environ['TOKEN'])))")
    log = runner.to_end("rTOKEN=~/my token", *words, HOME=str(tmp_path))
    assert f"\n{meant!a}\n" in log


@pytest.mark.parametrize("raw", [None, b"a\0b", b"a" * 140_000])
def test_an_unreadable_file_is_reported(runner: Runner, tmp_path: Path, raw: bytes | None) -> None:
    if raw:
        (tmp_path / "token").write_bytes(raw)
    runner.start(f"rTOKEN={tmp_path}/token", "=echo", "=here I am").wait(20)
    until(lambda: "TOKEN is the text of" in runner.log, "the log")
    assert "here I am" not in runner.log
    state, how, _ = runner.told
    assert state == "given up" and "TOKEN is the text of" in how


def test_a_locale_that_the_node_lacks_is_reported(runner: Runner) -> None:
    log = runner.to_end("sTWO=LC_ALL", "=echo", "=here I am", LC_ALL="C", RCYAML_LANGUAGE="none")
    assert "the variable LC_ALL was not set" in log and "here I am" not in log


def test_a_missing_variable_is_reported_and_nothing_starts(runner: Runner) -> None:
    log = runner.to_end("sTWO=NO_SUCH_SECRET", "=echo", "=here I am")
    assert "the variable NO_SUCH_SECRET was not set" in log and "here I am" not in log
    assert runner.told == ("given up", "the variable NO_SUCH_SECRET is not set", 0)


def test_a_configuration_is_written_unchanged_for_its_owner_only(runner: Runner) -> None:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    from robocomp_yaml.deploy.icegrid.descriptors import encoded

    text = "a = $HOME ${x} \\n \\044 %s 'q' \"d\"\n\n  # é\n"
    path = runner.folder / "config" / "arm"
    runner.to_end(f"c{path}", "=true", RCYAML_CONFIG=encoded(text))
    assert path.read_text() == text
    assert path.stat().st_mode & 0o077 == 0


def test_a_process_that_fails_repeatedly_is_given_up(runner: Runner) -> None:
    log = runner.to_end("=sh", "=-c", "=exit 3", rule="1 on-failure 10 20 2 60000")
    assert log.count("rcyaml: started") == 3
    assert "exit code 3; restarting in 10 ms" in log and "exit code 3; restarting in 20 ms" in log
    assert "given up: it ended 3 times within 60 s, the last time with exit code 3" in log
    assert runner.told == ("given up", "exit code 3", 2)


@pytest.mark.parametrize(
    ("policy", "code", "state"),
    [("on-failure", 0, "ended"), ("no", 0, "ended"), ("no", 1, "given up"), ("always", 0, "given up")],
)
def test_policies(runner: Runner, policy: str, code: int, state: str) -> None:
    runner.to_end("=sh", "=-c", f"=exit {code}", rule=f"1 {policy} 10 20 1 60000")
    assert runner.told == (state, f"exit code {code}", 1 if policy == "always" else 0)


def test_a_newer_rule_applies(runner: Runner) -> None:
    rules = runner.folder / "state" / "icegrid" / "rules"
    rules.mkdir(parents=True)
    (rules / "arm").write_text("2 no 10 20 1 60000\n")
    runner.to_end("=sh", "=-c", "=exit 3", rule="1 always 10 20 5 60000")
    assert runner.told == ("given up", "exit code 3", 0)


def test_a_missing_program_ends_like_a_failing_one(runner: Runner) -> None:
    assert "no-such-program" in runner.to_end("=no-such-program")
    assert runner.told[:2] == ("given up", "exit code 127")


def test_sigterm_ends_the_whole_process_group(runner: Runner) -> None:
    process = runner.start("=sh", "=-c", "=sleep 600 & echo it is $!.; wait")
    until(lambda: "started, pid" in runner.log, lambda: runner.log)
    child = runner.said_pid()
    process.terminate()
    assert process.wait(20) == 0
    until(lambda: not _is_alive(child), "the child's child ends")
    assert runner.told[0] == "stopped"


def test_a_process_that_ignores_sigterm_is_killed(runner: Runner) -> None:
    process = runner.start(
        "=sh", "=-c", "=trap '' TERM; echo deaf; while :; do sleep 0.1; done", RCYAML_STOP_WITHIN="0.3"
    )
    until(lambda: "deaf" in runner.log, lambda: runner.log)
    process.terminate()
    assert process.wait(20) == 0
    assert runner.told[:2] == ("stopped", "SIGKILL")


def test_a_killed_script_ends_its_program(runner: Runner) -> None:
    process = runner.start("=sh", "=-c", "=echo it is $$.; exec sleep 600")
    pid = runner.said_pid()
    process.kill()
    process.wait()
    until(lambda: not _is_alive(pid), "the program ends")


def test_after_a_kill_of_the_log_keeper_the_log_goes_on(runner: Runner) -> None:
    count = "i=0; while [ $i -lt 60 ]; do i=$((i+1)); echo line $i; sleep 0.02; done; exit 3"
    process = runner.start("=sh", "=-c", f"={count}")
    for line in ("line 5", "line 20"):
        until(lambda line=line: line in runner.log.splitlines(), lambda: runner.log)  # type: ignore[misc]
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        (keeper,) = [pid for pid in children if str(SCRIPT) in Path("/proc", pid, "cmdline").read_text()]
        os.kill(int(keeper), signal.SIGKILL)
    assert process.wait(20) == 0
    until(lambda: "ended by itself" in runner.log, lambda: runner.log)
    lines = [line for line in runner.log.splitlines() if line.startswith("line")]
    assert len(lines) >= 58 and lines[-1] == "line 60", "at most the line that was just being written is lost"
    assert runner.told == ("given up", "exit code 3", 0)


def test_logs_have_a_limit(runner: Runner) -> None:
    runner.to_end("=sh", "=-c", "=for i in 1 2 3 4 5 6 7 8 9; do echo 0123456789 $i; done", RCYAML_LOG_LIMIT="100")
    logs = runner.folder / "logs"
    assert (logs / "arm.log.1").exists()
    assert all((logs / name).stat().st_size < 250 for name in ("arm.log", "arm.log.1"))
    assert "0123456789 9" in (logs / "arm.log").read_text() + (logs / "arm.log.1").read_text()


def test_a_full_disk(runner: Runner, small_disk: Path, tmp_path: Path) -> None:
    """Lines are lost, which is reported when there is space again. The process goes on."""
    runner.folder = small_disk / "folder"
    (small_disk / "ballast").write_bytes(bytes(150_000))
    talk = "i=0; while [ $i -lt 4000 ]; do echo $i a line that takes room on the disk, as lines do; i=$((i+1)); done"
    wait = f"touch '{tmp_path}/full'; while [ ! -e '{tmp_path}/go' ]; do sleep 0.02; done"
    process = runner.start("=sh", "=-c", f"={talk}; {wait}; echo there is room; exit 3")
    until((tmp_path / "full").exists, "it goes on though nothing can be written")
    (small_disk / "ballast").unlink()
    (tmp_path / "go").touch()
    assert process.wait(20) == 0
    until(lambda: "ended by itself" in runner.log, lambda: runner.log[-300:])
    lines = runner.log.splitlines()
    whole = [line for line in lines if line.endswith("as lines do")]
    (lost,) = [line for line in lines if line.endswith("they could not be written")]
    assert len(whole) + int(lost.split()[1]) == 4000
    assert lines.index("there is room") > lines.index(lost)


def test_nothing_of_icegrid_stays_open(runner: Runner) -> None:
    """Otherwise IceGrid would wait for the end of all descendants of a process."""
    ours, theirs = os.pipe()
    os.set_inheritable(theirs, True)
    command = [
        "bash",
        str(SCRIPT),
        "arm",
        str(runner.folder),
        "=sh",
        "=-c",
        "=setsid sleep 600 & exit 0",
        "--Ice.Config=x",
    ]
    process = subprocess.Popen(command, env={**os.environ, "RCYAML_RESTART": ONCE}, pass_fds=[theirs])
    os.close(theirs)
    assert process.wait(20) == 0
    assert os.read(ours, 1) == b""
    os.close(ours)
    for name in filter(str.isdigit, os.listdir("/proc")):
        if _has(name, f"RCYAML_PROCESS={runner.folder}:arm"):
            os.kill(int(name), signal.SIGKILL)


def _has(pid: str, variable: str) -> bool:
    try:
        return variable.encode() in Path("/proc", pid, "environ").read_bytes().split(b"\0")
    except OSError:
        return False


def _is_alive(pid: int) -> bool:
    try:
        return "\nState:\tZ" not in Path("/proc", str(pid), "status").read_text()
    except OSError:
        return False


# Whether the process is alive

SERVER = """\
import os, sys
import Ice
Ice.loadSlice("", ["--all", sys.argv[2]])
import RcYaml

class Facet(RcYaml.Introspection):
    def report(self, names, current):
        return {}

    def getHeartbeat(self, current):
        return RcYaml.Heartbeat(int(open("age").read()) if os.path.exists("age") else 0, 100)

with Ice.initialize() as ice:
    adapter = ice.createObjectAdapterWithEndpoints("C", f"tcp -h 127.0.0.1 -p {sys.argv[1]}")
    adapter.add(type("C", (Ice.Object,), {})(), ice.stringToIdentity("commonbehavior"))
    if sys.argv[3] == "facet":
        adapter.addFacet(Facet(), ice.stringToIdentity("commonbehavior"), "rcyaml")
    adapter.activate()
    print(f"it is {os.getpid()}.", flush=True)
    ice.waitForShutdown()
"""
AGAIN = "1 on-failure 10 100 5 60000"


@dataclass
class Asked:
    """A server of Ice that `watch` asks whether it is alive."""

    runner: Runner
    port: int

    def start(self, facet: str = "facet", rule: str = AGAIN, **alive: Any) -> int:
        """Starts it; returns its pid."""
        pytest.importorskip("Ice", reason="Ice's Python module is not installed")
        slice_ = str(SCRIPT.parents[1] / "slice" / "RcYaml.ice")
        words = (f"={sys.executable}", "=-c", f"={SERVER}", f"={self.port}", f"={slice_}", f"={facet}")
        is_asked = alive.pop("is_asked", True)
        asked = self.rule(**alive) if is_asked else ""
        self.runner.start(*words, rule=rule, RCYAML_ALIVE=asked, RCYAML_PORTS=str(self.port))
        watch = ["perl", str(WATCH), str(self.runner.folder), str(os.getpid())]
        self.runner.started.append(subprocess.Popen(watch))
        pid = self.runner.said_pid()
        time.sleep(1)  # it has answered once
        return pid

    def rule(self, **alive: Any) -> str:
        proxy = f"commonbehavior:tcp -h 127.0.0.1 -p {self.port}"
        return alive_rule(
            Process("arm", "here", (), "", alive=Liveness(proxy, **{"every": 0.3, "within": 0.5, **alive}))
        )

    @property
    def status(self) -> RunStatus:
        found = of_text((self.runner.folder / "state" / "icegrid" / "status" / "arm").read_text())
        assert found
        return found


@pytest.fixture
def asked(runner: Runner, free_port: Ports, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Asked:
    monkeypatch.chdir(tmp_path)
    return Asked(runner, free_port())


def test_a_halted_process_is_restarted(asked: Asked) -> None:
    pid = asked.start()
    assert asked.status.pid == pid and not asked.status.not_alive
    os.kill(pid, signal.SIGSTOP)
    until(lambda: asked.status.restarts == 1 and asked.status.state == "running", lambda: asked.runner.log)
    assert asked.status.last_exit == "not alive: it does not answer"
    again = "rcyaml: ended by itself: not alive: it does not answer; restarting in 10 ms"
    until(lambda: again in asked.runner.log, lambda: asked.runner.log)
    time.sleep(2)
    assert asked.status.restarts == 1, "the new one answers"


def test_it_is_only_told(asked: Asked) -> None:
    pid = asked.start(restarts=False)
    os.kill(pid, signal.SIGSTOP)
    until(lambda: asked.status.not_alive == "it does not answer", lambda: asked.runner.log)
    since = asked.status.since
    os.kill(pid, signal.SIGCONT)
    until(lambda: not asked.status.not_alive, lambda: asked.runner.log)
    assert (asked.status.pid, asked.status.since) == (pid, since)
    until(lambda: "rcyaml: alive again" in asked.runner.log, lambda: asked.runner.log)


@pytest.mark.parametrize(
    ("worker", "age", "is_noticed"),
    [(AUTO, 9000, False), (AUTO, 11000, True), (60.0, 50000, False), (3.0, 4000, True), (FOREVER, 10**9, False)],
)
def test_a_worker_without_heartbeat(asked: Asked, tmp_path: Path, worker: float, age: int, is_noticed: bool) -> None:
    asked.start(worker=worker, restarts=False)
    (tmp_path / "age").write_text(str(age))
    if is_noticed:
        why = f"its worker has shown no life for {age // 1000} s"
        until(lambda: asked.status.not_alive == why, lambda: asked.runner.log)
    else:
        time.sleep(1.5)
        assert not asked.status.not_alive


def test_a_deadlocked_worker_is_restarted(asked: Asked, tmp_path: Path) -> None:
    asked.start()
    (tmp_path / "age").write_text("30000")
    until(lambda: asked.status.restarts >= 1, lambda: asked.runner.log)
    (tmp_path / "age").unlink()
    until(lambda: "its worker has shown no life" in asked.runner.log, lambda: asked.runner.log)


def test_a_program_without_the_facet_is_pinged(asked: Asked) -> None:
    pid = asked.start("none")
    time.sleep(1)
    assert asked.status.pid == pid and not asked.status.not_alive
    os.kill(pid, signal.SIGSTOP)
    until(lambda: asked.status.restarts == 1, lambda: asked.runner.log)


def test_it_is_not_ended_if_nobody_would_start_it(asked: Asked) -> None:
    pid = asked.start(rule=ONCE)
    os.kill(pid, signal.SIGSTOP)
    until(lambda: asked.status.not_alive, lambda: asked.runner.log)
    time.sleep(1)
    assert asked.status.pid == pid and os.path.exists(f"/proc/{pid}")


def test_a_newer_rule_applies_at_once(asked: Asked) -> None:
    pid = asked.start(restarts=False)
    os.kill(pid, signal.SIGSTOP)
    until(lambda: asked.status.not_alive, lambda: asked.runner.log)
    rules = asked.runner.folder / "state" / "icegrid" / "rules"
    rules.mkdir(parents=True)
    (rules / "arm").write_text(f"2{AGAIN[1:]}\n\n")
    until(lambda: asked.status.not_alive == "it is halted", "that it is not asked any more")
    os.kill(pid, signal.SIGCONT)
    until(lambda: not asked.status.not_alive, "life")
    time.sleep(1)
    assert not asked.status.not_alive and asked.status.pid == pid


def test_a_newer_rule_switches_it_on(asked: Asked) -> None:
    pid = asked.start(is_asked=False)
    rules = asked.runner.folder / "state" / "icegrid" / "rules"
    rules.mkdir(parents=True)
    (rules / "arm").write_text(f"2{AGAIN[1:]}\n{asked.rule()}\n")
    time.sleep(6)  # it has answered once
    os.kill(pid, signal.SIGSTOP)
    until(lambda: asked.status.restarts == 1, lambda: asked.runner.log)


def test_a_restart_waits_for_its_port(asked: Asked) -> None:
    with socket.socket() as thief:
        thief.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        pid = asked.start(rule="1 on-failure 500 1000 5 60000")
        os.kill(pid, signal.SIGKILL)
        until(lambda: not os.path.exists(f"/proc/{pid}"), "its end")
        thief.bind(("127.0.0.1", asked.port))
        thief.listen()
        until(lambda: f"port {asked.port} is used by another program" in asked.runner.log, lambda: asked.runner.log)
        assert asked.status.state == "waiting" and asked.status.restarts == 0
    until(lambda: asked.status.restarts == 1 and asked.status.state == "running", lambda: asked.runner.log)


def test_nothing_of_it_is_left(asked: Asked) -> None:
    """Also if the script itself is killed."""
    asked.start(every=0.2)
    runner = asked.runner.started[0]

    def scripts() -> list[int]:
        commands = {pid: procfs.command(pid) for pid in procfs.pids()}
        return [pid for pid, words in commands.items() if {str(SCRIPT), str(asked.runner.folder)} <= set(words)]

    assert len(scripts()) > 1
    runner.kill()
    until(lambda: not scripts(), lambda: str([procfs.command(pid) for pid in scripts()]))


def test_what_a_process_uses_is_measured_on_request(runner: Runner) -> None:
    burner = "import os, sys; big = b'x' * (40 << 20); os.fork(); print('it is', os.getpid())\nwhile True: pass"
    runner.start(f"={sys.executable}", "=-uc", f"={burner}")
    until(lambda: (last := runner.status) and last.state == "running" and "it is" in runner.log, "it runs")
    assert runner.status and runner.status.use is None
    pid = runner.status.pid

    def measured() -> MeasuredUse:
        before = runner.status and runner.status.use
        runner.started[0].send_signal(signal.SIGCONT)
        until(lambda: runner.status and runner.status.use and runner.status.use != before, "it is measured")
        assert runner.status and runner.status.use
        return runner.status.use

    first = measured()
    family = procfs.descendants({pid}, procfs.table())
    assert len(family) == 2 and first.pid == pid
    assert 0.8 * procfs.memory(family) < first.memory < 1.2 * procfs.memory(family) and first.memory > 80 << 20
    until(lambda: measured().cpu > first.cpu + 0.1, "it uses the CPU")
    alive = procfs.table()
    assert abs(measured().cpu - sum(alive[one].cpu for one in family)) < 2
    os.kill(pid, signal.SIGKILL)
    assert runner.started[0].wait(20) == 0
    assert runner.told[:2] == ("given up", "SIGKILL")


def test_measuring_does_not_change_how_a_process_ends(runner: Runner) -> None:
    """The signal interrupts the wait for the process."""
    script = runner.start("=bash", "=-c", "=sleep 0.5; exit 7")
    until(lambda: runner.status and runner.status.state == "running", "it runs")
    while script.poll() is None:
        script.send_signal(signal.SIGCONT)
        time.sleep(0.002)
    assert runner.told == ("given up", "exit code 7", 0)
