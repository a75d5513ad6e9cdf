"""Faults of a deployment: the rows of the table of faults in docs/deploying.md."""

from __future__ import annotations

import ast
import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

import robocomp_yaml.deploy
from processes import Ports, killed_on_failure, until
from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import json_data, operations
from robocomp_yaml.deploy.carry_out import SKIPPED
from robocomp_yaml.deploy.engine import GIVEN_UP, RUNNING, DeployFailed
from robocomp_yaml.deploy.local import channel, procfs, record
from robocomp_yaml.network.draft import MANAGER, PUBLISH
from robocomp_yaml.network.network import (
    ICESTORM,
    NEVER,
    Endpoint,
    EnvironmentVariable,
    Process,
    Readiness,
    RestartRule,
)
from small_networks import Place, config_of, is_alive, listener, shell, sleeper

FAILS = "echo about to fail; exit 3"
ONCE = RestartRule(policy=NEVER)
DEEP = "(setsid sh -c 'sleep 600 & sleep 600' &) ; sleep 600 & wait"


def codes(result: operations.Result) -> list[str]:
    return [found.code for found in result.diagnostics]


# A process fails while the network comes up.


def test_after_a_failure_started_processes_stop_and_the_log_is_shown(place: Place) -> None:
    result = place.up(sleeper("a"), shell("b", FAILS, "a", restart=ONCE), sleeper("c", "b"))
    assert codes(result) == ["RC7004"]
    assert result.diagnostics[0].message == "'b' ended before it was ready: exit code 3"
    assert "b | about to fail" in result.diagnostics[0].more.splitlines()
    assert place.order(SKIPPED) == ["c"]
    assert set(place.pids().values()) == {0}


def test_rollback(place: Place) -> None:
    def network(value: str, last: Process) -> tuple[Process, ...]:
        return (sleeper("a"), shell("b", 'cat "$0"; exec sleep 600', "a", config=config_of("b", f"x={value}\n")), last)

    place.up(*network("1", sleeper("gone")))
    before = place.pids()
    result = place.up(*network("2", shell("c", FAILS, "b", restart=ONCE)), on_failure=operations.ROLL_BACK)
    assert codes(result) == ["RC7004"]
    after = place.pids()
    assert after["a"] == before["a"] and after["b"] not in (0, before["b"])
    assert place.log("b")[-1] == "x=1"
    assert is_alive(after["gone"])
    assert "c" not in after
    assert place.up(*network("1", sleeper("gone"))).plan.is_empty


def test_keep_lets_independent_processes_go_on(place: Place) -> None:
    result = place.up(
        shell("a", FAILS, restart=ONCE), sleeper("b", "a"), sleeper("c"), replace(sleeper("d", "a"), optional=("a",)),
        on_failure=operations.KEEP_GOING,
    )  # fmt: skip
    assert codes(result) == ["RC7004"] and result.outcome.skipped == ["b"]
    assert {name for name, pid in place.pids().items() if pid} == {"c", "d"}


def test_a_process_that_is_never_ready(place: Place, free_port: Ports) -> None:
    result = place.up(sleeper("a", ready=Readiness(port=free_port(), within=0.3)))
    assert codes(result) == ["RC7003"]
    assert "nothing listens on port" in result.diagnostics[0].message


@pytest.mark.parametrize(
    ("condition", "why"),
    [
        ({"port": 1}, "nothing listens on port 1"),
        ({"command": ("test", "-e", "/no/laser")}, "`test -e /no/laser` did not succeed"),
        ({"log": "turns$"}, "no line of its log matches 'turns$'"),
        ({"pings": ("laser:tcp -h 127.0.0.1 -p 1",)}, "no answer from laser"),
    ],
)
def test_status_says_what_a_process_lacks_to_be_ready(place: Place, condition: dict[str, Any], why: str) -> None:
    never = sleeper("a", ready=Readiness(within=0.3, **condition))
    place.up(never, on_failure=operations.KEEP_GOING)
    found = place.status(never)["a"]
    assert json_data.state_in_words(found) == f"running, not ready: {why}"
    assert not found.is_as_desired


def test_one_that_ends_after_it_was_ready_and_is_not_ready_again(place: Place, tmp_path: Path) -> None:
    once = f"test -e {tmp_path}/once && exec sleep 600; touch {tmp_path}/once; echo up; exit 1"
    result = place.up(shell("a", once, ready=Readiness(within=1, log="^up$")))
    (found,) = result.diagnostics
    assert found.code == "RC7003" and "it ended in the meantime: exit code 1, after 1 restart" in found.message


def test_a_running_process_that_is_not_ready_is_reported_by_each_up(place: Place, free_port: Ports) -> None:
    never = sleeper("a", ready=Readiness(port=free_port(), within=0.3))
    place.up(never, sleeper("b"), on_failure=operations.KEEP_GOING)
    pids = place.pids()
    result = place.up(never, sleeper("b"))
    assert result.plan.is_empty and codes(result) == ["RC7003"]
    assert place.pids() == pids and pids["a"]
    result = place.up(never, sleeper("b", env=(EnvironmentVariable("X", "1"),)))
    assert codes(result) == ["RC7003"] and result.outcome.began == ["b"]
    assert place.observe()["b"].state == RUNNING


@pytest.mark.parametrize("is_served", [True, False])
def test_a_port_that_another_program_uses(place: Place, free_port: Ports, is_served: bool) -> None:
    """It serves there, or is ready when it listens there: the other program must not make it ready."""
    port = free_port()
    with socket.create_server(("127.0.0.1", port)):
        endpoints = (Endpoint("Laser", "laser", port, f"tcp -p {port}"),) if is_served else ()
        served = listener("a", port, endpoints=endpoints)
        result = place.up(sleeper("b"), served)
    assert codes(result) == ["RC7001"]
    assert f"(pid {os.getpid()})" in result.diagnostics[0].message
    assert place.pids() == {}  # nothing at all was started
    assert not place.up(sleeper("b"), served).diagnostics
    changed = replace(served, env=(EnvironmentVariable("X", "1"),))
    assert not place.up(sleeper("b"), changed).diagnostics  # its own port is not in its own way


@pytest.mark.parametrize(
    ("ports", "keys"), [((0, 1), "port: PORT, publish: PORT"), ((0,), "port: PORT"), ((1,), "publish: PORT")]
)
def test_the_keys_of_all_used_ports_of_an_icestorm_are_named(
    place: Place, free_port: Ports, ports: tuple[int, ...], keys: str
) -> None:
    own = free_port(), free_port()
    served = tuple(
        Endpoint(name, "", port, f"tcp -p {port}") for name, port in zip((MANAGER, PUBLISH), own, strict=True)
    )
    with contextlib.ExitStack() as others:
        for number in ports:
            others.enter_context(socket.create_server(("127.0.0.1", own[number])))
        (told,) = place.up(replace(sleeper("storm"), kind=ICESTORM, endpoints=served)).diagnostics
    assert told.code == "RC7001" and told.hint.endswith(f"give 'storm' other ports: `icestorm: {{{keys}}}`")


def test_ports_that_another_deployment_uses(place: Place, free_port: Ports, tmp_path: Path) -> None:
    ports = free_port(), free_port()
    script = (
        "import socket\nfor port in {}: globals()[f's{{port}}'] = socket.create_server(('127.0.0.1', port))\n"
        "print('up', flush=True); input()"
    )
    mark = f"{tmp_path}/.rcyaml/deployments/Other:arm"
    using = subprocess.Popen(
        [sys.executable, "-c", script.format(ports)], env={**os.environ, procfs.MARK: mark},
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    with killed_on_failure(using) as other:
        assert other.stdin and other.stdout and other.stdout.readline() == b"up\n"
        served = tuple(Endpoint(f"Laser{port}", "laser", port, f"tcp -p {port}") for port in ports)
        (told,) = place.up(sleeper("a", endpoints=served)).diagnostics  # one for both ports
        other.stdin.close()
    assert told.code == "RC7001" and "'arm' of the deployment Other in " in told.message
    assert told.hint.startswith("take that deployment down (`rcyaml deploy down ")


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (("no-such-program",), "PATH contains no program 'no-such-program'"),
        (("/no/such/file",), "the file '/no/such/file' is missing"),
        (("/etc/passwd",), "'/etc/passwd' is not executable"),
    ],
)
def test_a_program_that_cannot_be_run(place: Place, command: tuple[str, ...], reason: str) -> None:
    result = place.up(sleeper("b"), replace(sleeper("a"), command=command))
    assert [found.message for found in result.diagnostics] == [f"'a' cannot be started: {reason}"]
    assert place.pids() == {}


def test_a_file_that_is_not_a_valid_program(place: Place) -> None:
    program = place.root / "program"
    program.write_bytes(b"\x7fELF, but not really")
    program.chmod(0o755)
    result = place.up(replace(sleeper("a"), command=(str(program),)))
    reason = f"'{program}' is not a program for this kind of machine"
    assert [found.message for found in result.diagnostics] == [f"'a' cannot be started: {reason}"]


# A process ends while the network runs.


def test_a_crashed_process_is_restarted(place: Place) -> None:
    place.up(sleeper("a"), sleeper("b", "a"))
    before = place.pids()
    os.kill(before["a"], signal.SIGKILL)
    until(lambda: place.pids()["a"] not in (0, before["a"]), "a is back")
    running = place.observe()["a"]
    assert (running.restarts, running.last_exit) == (1, "SIGKILL")
    assert place.pids()["b"] == before["b"]
    assert "rcyaml: ended by itself: SIGKILL; restarting in 0.1 s" in place.log("a")


def test_a_crash_loop_is_given_up(place: Place) -> None:
    short = RestartRule(delay=0.01, longest=0.02, tries=3)
    result = place.up(shell("a", FAILS, restart=short))
    assert codes(result) == ["RC7004"]
    assert result.diagnostics[0].message == "'a' ended before it was ready: exit code 3, after 3 restarts"
    assert place.log("a").count("about to fail") == 4
    assert place.log("a")[-1] == "rcyaml: given up: it ended 4 times within 60 s, the last time with exit code 3"


def test_a_process_that_was_given_up_starts_with_the_next_up(place: Place) -> None:
    flag = place.root / "broken"
    flag.touch()
    flaky = shell("a", f"[ -e {flag} ] && exit 1; exec sleep 600", restart=ONCE)
    place.up(flaky, sleeper("b"), on_failure=operations.KEEP_GOING)
    place.wait_for_state("a", GIVEN_UP)
    flag.unlink()
    result = place.up(flaky, sleeper("b"))
    assert result.plan.steps["a"].reason == "it was given up: exit code 1"
    assert place.observe()["a"].state == RUNNING


def test_a_program_that_is_removed_between_two_runs(place: Place) -> None:
    program = place.root / "program"
    program.symlink_to("/bin/sleep")
    place.up(replace(sleeper("a", restart=RestartRule(delay=0.01, tries=2)), command=(str(program), "600")))
    program.unlink()
    os.kill(place.pids()["a"], signal.SIGKILL)
    assert place.wait_for_state("a", GIVEN_UP).last_exit == f"the file '{program}' is missing"


def test_a_process_that_ignores_sigterm_is_killed(place: Place) -> None:
    place.up(shell("a", "trap '' TERM; while :; do sleep 0.05; done"))
    pid = place.pids()["a"]

    async def stop(engine: operations.Engine) -> None:
        await engine.stop("a", 0.2)

    place.run(stop)
    assert not is_alive(pid)
    assert "rcyaml: did not end within 0.2 s: killed" in place.log("a")


# No orphans, whoever is killed.


def family(place: Place) -> set[int]:
    """All running processes of the deployment, including orphans outside its sessions."""
    return {pid for pid in procfs.marked(place.folder) if is_alive(pid)}


def deep_family(place: Place, count: int) -> set[int]:
    until(lambda: len(family(place)) >= count, lambda: f"{count} processes, of which there are {family(place)}")
    return family(place)


def test_descendants_end_with_their_process(place: Place) -> None:
    place.up(shell("a", DEEP, restart=ONCE), sleeper("b"))
    deep_family(place, 2 + 1 + 5)
    b = place.pids()["b"]
    os.kill(place.pids()["a"], signal.SIGKILL)
    until(lambda: family(place) <= {b, *place.keeper_and_supervisor()}, lambda: f"{family(place)}")


def test_down_ends_descendants_in_other_sessions(place: Place) -> None:
    place.up(shell("a", DEEP))
    deep_family(place, 2 + 5)
    place.down()
    place.wait_gone()


def test_the_supervisor_is_killed(place: Place) -> None:
    network = (shell("a", DEEP), sleeper("b", "a"))
    place.up(*network)
    deep_family(place, 2 + 6)
    os.kill(place.keeper_and_supervisor()[1], signal.SIGKILL)
    place.wait_gone()
    result = place.up(*network)
    assert not result.diagnostics and place.observe()["b"].state == RUNNING


def test_the_keeper_is_killed(place: Place) -> None:
    """The supervisor and its processes go on."""
    place.up(shell("a", DEEP))
    before = place.pids()
    os.kill(place.keeper_and_supervisor()[0], signal.SIGKILL)
    assert place.pids() == before
    place.down()
    place.wait_gone()


def test_supervisor_and_keeper_are_killed(place: Place) -> None:
    network = (shell("a", DEEP), sleeper("b"))
    place.up(*network)
    deep_family(place, 2 + 6)
    children = place.pids()
    for pid in place.keeper_and_supervisor():
        os.kill(pid, signal.SIGKILL)
    until(lambda: not any(map(is_alive, children.values())), "the children die with it")
    assert place.observe() == {}  # this looks, finds what is left of `a`, and ends it
    place.wait_gone()
    assert not place.up(*network).diagnostics


def test_the_folder_is_deleted_while_it_runs(place: Place) -> None:
    """The supervisor cannot be reached any more: the next `up` kills its processes and starts them again, each once."""
    place.up(sleeper("a"))
    old = family(place)
    shutil.rmtree(place.folder)
    assert not place.up(sleeper("a")).diagnostics
    until(lambda: not any(map(is_alive, old)), "the old ones are gone")
    assert len(family(place)) == 3


def test_a_signal_to_the_supervisor_ends_all_processes(place: Place) -> None:
    place.up(shell("a", DEEP), sleeper("b"))
    os.kill(place.keeper_and_supervisor()[0], signal.SIGTERM)
    place.wait_gone()
    assert place.observe() == {}


# Secrets, logs, clocks.


def test_a_secret_is_not_visible_anywhere(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    secret = "correct-horse-battery"
    monkeypatch.setenv("ROBOT_TOKEN", secret)
    token = EnvironmentVariable("TOKEN", source="ROBOT_TOKEN")
    said = shell("a", 'printf "%s" "$TOKEN" | wc -c; exec sleep 600', env=(token,))
    place.up(said)
    until(lambda: str(len(secret)) in [line.strip() for line in place.log("a")], "it has got it")
    files = [path for path in Path(place.folder).rglob("*") if path.is_file()]
    assert files and not [path for path in files if secret.encode() in path.read_bytes()]
    assert secret not in subprocess.run(["ps", "-ef"], capture_output=True, text=True, check=True).stdout
    assert secret not in repr(place.observe()) + repr(place.events)


def test_a_variable_that_is_not_set(place: Place) -> None:
    result = place.up(sleeper("a", env=(EnvironmentVariable("TOKEN", source="RCYAML_TEST_NOT_SET"),)))
    assert codes(result) == ["RC7006"] and place.pids() == {}


def test_a_secret_that_changes_is_not_shown(place: Place) -> None:
    def network(value: str) -> Process:
        return sleeper("a", config=config_of("a", f"mail.password={value}\nx=1\n"))

    place.up(network("hunter2"))
    result = place.up(network("hunter3"))
    assert result.plan.steps["a"].reason == "config mail.password: *** → ***"


def test_a_deleted_log_begins_anew(place: Place) -> None:
    place.up(shell("a", "while echo a line; do sleep 0.05; done"))
    until(lambda: place.log("a", 1) == ["a line"], "it prints")
    shutil.rmtree(f"{place.folder}/logs")
    until(lambda: place.log("a") == ["a line"] * 3, "further lines")


def test_a_log_of_limited_size(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RCYAML_LOG_LIMIT", "20000")
    count = 2000
    place.up(shell("a", f"i=0; while [ $i -lt {count} ]; do echo line $i; i=$((i+1)); done; exec sleep 600"))
    until(lambda: place.log("a", 1)[-1] == f"line {count - 1}", "the last line")
    logs = Path(place.folder, "logs")
    assert sorted(path.name for path in logs.iterdir()) == ["a.log", "a.log.1"]
    assert all(path.stat().st_size <= 20000 for path in logs.iterdir())
    last = place.log("a", 500)
    assert last == [f"line {number}" for number in range(count - len(last), count)] and len(last) == 500


def fill(disk: Path) -> None:
    """Leaves no room, until the file `ballast` is removed."""
    with contextlib.suppress(OSError), open(disk / "ballast", "wb") as file:
        while True:
            file.write(bytes(4096))
            file.flush()


def test_a_full_disk(place: Place, small_disk: Path, tmp_path: Path) -> None:
    """Lines are lost, which is reported when there is space again. The process goes on."""
    place.root = small_disk
    talk = f"while [ ! -e {tmp_path}/go ]; do echo a line that takes room on the disk, as lines do; sleep 0.01; done"
    place.up(shell("a", f"{talk}; echo there is room; exec sleep 600"))
    fill(small_disk)
    until(lambda: place.observe()["a"].lost_lines > 0, "it goes on though nothing can be written")
    assert place.observe()["a"].restarts == 0
    (small_disk / "ballast").unlink()
    (tmp_path / "go").touch()
    until(lambda: "there is room" in place.log("a"), "what it says then")
    assert place.observe()["a"].lost_lines == 0
    assert any(line.startswith("rcyaml: ") and line.endswith("they could not be written") for line in place.log("a"))


def test_only_logs_use_the_time_of_day() -> None:
    """Clocks are set while robots run: waits and measurements use a monotonic clock."""
    folder = Path(robocomp_yaml.deploy.__file__).parent
    asking = ("time.time", "time.time_ns", "time.gmtime", "datetime.now")
    users = {
        path.name
        for path in folder.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute) and ast.unparse(node) in asking
    }
    # `status` for what another host tells of its own clock, `authority` for when certificates end, `sending` for the
    # name of a folder.
    assert users == {"log_file.py", "status.py", "authority.py", "sending.py"}


def test_the_supervisor_is_small(place: Place) -> None:
    place.up(*(sleeper(f"p{number}") for number in range(10)))
    used = procfs.memory(place.keeper_and_supervisor())
    assert used < 40 << 20, f"{used >> 20} MiB"


def test_two_deployments(place: Place) -> None:
    with own_folder.locked(place.folder) as first, own_folder.locked(place.folder, patience=0.05) as second:
        assert first and not second


def test_nonsense_on_the_control_socket_is_ignored(place: Place) -> None:
    place.up(sleeper("a"))
    before = place.pids()
    for text in (b"\n", b"{}\n", b"GET / HTTP/1.1\r\n\r\n", b'{"id": 1, "do": "nothing"}\n', b"[]\n"):
        connection = channel.connect(f"{place.folder}/state", 5.0)
        assert connection
        with connection:
            connection.setblocking(True)
            connection.sendall(text)
    assert place.pids() == before


def test_on_a_full_disk_no_supervisor_starts(place: Place, small_disk: Path) -> None:
    place.root = small_disk
    assert not place.up(sleeper("a")).diagnostics
    place.down()
    fill(small_disk)
    with pytest.raises(DeployFailed) as failed:
        place.up(sleeper("a"))
    assert failed.value.diagnostic.code == "RC7005" and "no space left" in failed.value.diagnostic.message
    assert not record.was_killed(place.folder) and not procfs.marked(place.folder)
    (small_disk / "ballast").unlink()
    assert not place.up(sleeper("a")).diagnostics and place.order("ready") == ["a"]


def test_a_full_disk_changes_nothing(place: Place, small_disk: Path) -> None:
    """The new configurations are written before the first process stops."""
    place.root = small_disk

    def network(text: str) -> tuple[Process, ...]:
        return tuple(
            shell(name, 'cat "$0"; exec sleep 600', *after, config=config_of(name, text))
            for name, after in (("a", ()), ("b", ("a",)))
        )

    place.up(*network("x=1\n"))
    before = place.pids()
    fill(small_disk)
    with pytest.raises(DeployFailed) as failed:
        place.up(*network("x=2\n" * 2000))
    assert failed.value.diagnostic.code == "RC7005" and "no space left" in failed.value.diagnostic.message
    assert place.pids() == before and place.events == []
    assert not Path(place.folder, "state", "next").exists()
    (small_disk / "ballast").unlink()
    assert not place.up(*network("x=2\n" * 2000)).diagnostics
    assert place.log("b")[-1] == "x=2" and place.order("ready") == ["a", "b"]
