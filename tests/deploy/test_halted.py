"""What supervises a network is halted (SIGSTOP): it goes on by itself, or with the next command. The processes of the
network are the same ones afterwards, as their pids say."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from conftest import write_tree
from processes import kill_left, killed_on_failure, until
from robocomp_yaml import resources
from robocomp_yaml.deploy.local import procfs
from seen import NEEDS_ICEGRID, all_ends, programs
from small_networks import Place, is_alive, sleeper
from test_roles import Rcyaml

DOCUMENT = """\
deployment: Robot
components:
  base: {program: sleep, args: ["600"], role: server}
  arm: {program: sleep, args: ["600"], role: server, after: [base]}
"""


def halt(*pids: int) -> None:
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)


def goes_on(pid: int) -> bool:
    found = procfs.entry(pid)
    return found is not None and not found.is_halted


def restarted(place: Place, name: str) -> None:
    """Kills a process, and waits until it runs again, once."""
    (pid,) = until(lambda: programs(place.folder, name), "it runs")
    os.kill(pid, signal.SIGKILL)
    until(
        lambda: len(found := programs(place.folder, name)) == 1 and found != [pid],
        lambda: f"{programs(place.folder, name)}",
    )


def test_the_supervisor_goes_on(place: Place) -> None:
    place.up(sleeper("a"))
    _, supervisor = place.keeper_and_supervisor()
    halt(supervisor)
    restarted(place, "a")
    assert goes_on(supervisor)


def test_supervisor_and_keeper_go_on_with_the_next_command(place: Place, rcyaml: Rcyaml) -> None:
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT})
    document = f"{place.root}/robot.ddsl.yaml"
    assert rcyaml("deploy", "up", document).exit_code == 0
    until(lambda: programs(place.folder, "base"), "it runs")
    before = programs(place.folder, "base")
    for command in ("status", "up", "plan"):
        halt(*place.keeper_and_supervisor())
        said = rcyaml("deploy", command, document)
        assert said.exit_code == 0 and "warning[RC7007]: what supervises this deployment was halted" in said.stderr
        assert all(map(goes_on, place.keeper_and_supervisor()))
        assert "RC7007" not in rcyaml("deploy", command, document).stderr
    assert programs(place.folder, "base") == before
    restarted(place, "base")
    halt(*place.keeper_and_supervisor())
    assert rcyaml("deploy", "down", document).exit_code == 0
    assert not programs(place.folder, "base")


def test_a_killed_supervisor_is_reported_until_the_next_up_or_down(place: Place, rcyaml: Rcyaml) -> None:
    """Its processes ended with it: nobody wanted that."""
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT})
    document = f"{place.root}/robot.ddsl.yaml"
    for then in ("up", "down"):
        assert rcyaml("deploy", "up", document).exit_code == 0
        for pid in place.keeper_and_supervisor():
            os.kill(pid, signal.SIGKILL)
        until(lambda: not programs(place.folder, "base"), "all end")
        for _ in range(2):
            said = rcyaml("deploy", "status", document)
            assert (
                said.exit_code == 1 and "warning[RC7007]: the supervisor of this deployment was killed" in said.stderr
            )
            assert rcyaml("deploy", "plan", document).exit_code == 0
        assert rcyaml("deploy", then, document).exit_code == 0
        said = rcyaml("deploy", "status", document)
        assert said.exit_code == 0 and "RC7007" not in said.stderr
        assert rcyaml("deploy", "down", document).exit_code == 0


def test_a_program_that_nobody_asks_is_told(place: Place) -> None:
    place.up(sleeper("a"))
    (pid,) = programs(place.folder, "a")
    halt(pid)
    until(lambda: not goes_on(pid), "it is halted")
    found = place.status(sleeper("a"))["a"]
    assert found.is_down and found.running and found.running.not_alive == "it is halted"
    os.kill(pid, signal.SIGCONT)
    assert place.status(sleeper("a"))["a"].is_ready and programs(place.folder, "a") == [pid]


def test_plan_and_up_name_what_is_halted(place: Place, rcyaml: Rcyaml) -> None:
    ready = 'role: server, ready: {command: ["true"], within: 1 s}}'
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT.replace("role: server}", ready)})
    assert rcyaml("deploy", "up").exit_code == 0
    (pid,) = until(lambda: programs(place.folder, "base"), "it runs")
    halt(pid)
    until(lambda: not goes_on(pid), "it is halted")
    for command in ("plan", "up"):
        said = rcyaml("deploy", command)
        assert said.exit_code == 1 and "error[RC7042]: 'base' runs and is not alive: it is halted" in said.stderr
        assert "`rcyaml deploy restart robot.ddsl.yaml base` starts it again" in said.stderr
    assert rcyaml("deploy", "restart", "robot.ddsl.yaml", "base").exit_code == 0
    assert rcyaml("deploy", "plan").exit_code == 0
    assert programs(place.folder, "base") != [pid] and rcyaml("deploy", "down").exit_code == 0


@pytest.fixture
def grid(place: Place, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The path of the document of a network that IceGrid runs on this machine."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    monkeypatch.setenv("XDG_STATE_HOME", f"{place.root}/own")
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT})
    document = f"{place.root}/robot.ddsl.yaml"
    try:
        assert rcyaml("deploy", "up", document, "--engine", "icegrid").exit_code == 0
        yield document
    finally:
        kill_left(place.folder)


def those(place: Place, is_chosen: Callable[[list[str], int], bool]) -> list[int]:
    return [pid for pid in procfs.marked(place.folder) if is_chosen(procfs.command(pid), pid)]


def is_run(name: str) -> Callable[[list[str], int], bool]:
    return lambda words, pid: words[1:2] != [] and words[1].endswith("/run") and words[2] == name


def is_script(script: str) -> Callable[[list[str], int], bool]:
    return lambda words, pid: any(word.endswith(f"/nodes/localhost/{script}") for word in words[:2])


def is_program(name: str) -> Callable[[list[str], int], bool]:
    return lambda words, pid: words[0] == name


@pytest.mark.slow
@NEEDS_ICEGRID
@pytest.mark.parametrize(
    "chosen",
    [
        is_run("base"), is_script("watch"), is_script("guard"), is_program("icegridnode"),
        is_program("icegridregistry"), lambda words, pid: "robocomp_yaml.deploy.icegrid.keeper" in words,
    ],
    ids=["run", "watch", "guard", "node", "registry", "keeper"],
)  # fmt: skip
def test_what_supervises_with_icegrid_goes_on(
    place: Place, grid: str, chosen: Callable[[list[str], int], bool]
) -> None:
    """Also all processes of a script: `run` has one more, which writes the log, and the guard one for `watch`."""
    before = programs(place.folder, "base"), programs(place.folder, "arm")
    halted = those(place, chosen)
    assert halted
    halt(*halted)
    until(lambda: all(map(goes_on, halted)), lambda: str([procfs.command_line(pid) for pid in halted]), 15)
    assert (programs(place.folder, "base"), programs(place.folder, "arm")) == before
    restarted(place, "base")


@pytest.mark.slow
@NEEDS_ICEGRID
def test_the_guard_of_the_registry_goes_on_with_the_next_command(place: Place, rcyaml: Rcyaml, grid: str) -> None:
    before = programs(place.folder, "base"), programs(place.folder, "arm")
    for command in ("status", "up"):
        guard = int(Path(place.folder, "state/icegrid/registry/pid").read_text())
        (registry,) = those(place, is_program("icegridregistry"))
        halt(guard, registry)
        said = rcyaml("deploy", command, grid)
        assert said.exit_code == 0 and "warning[RC7007]" in said.stderr, said.output
        assert goes_on(guard) and goes_on(registry)
    (node_guard,) = [pid for pid in those(place, is_script("guard")) if "--watch" not in procfs.command(pid)]
    (helper,) = [pid for pid in those(place, is_script("guard")) if "--watch" in procfs.command(pid)]
    for pid in (helper, node_guard, *those(place, is_script("watch"))):
        os.kill(pid, signal.SIGKILL)
    halt(*(halted := those(place, is_run("base"))))
    assert "RC7007" in rcyaml("deploy", "status", grid).stderr and all(map(goes_on, halted)), "nobody else does it"
    (registry,) = those(place, is_program("icegridregistry"))
    halt(guard)
    os.kill(registry, signal.SIGKILL)
    assert rcyaml("deploy", "status", grid).exit_code == 0
    assert not is_alive(registry) and (programs(place.folder, "base"), programs(place.folder, "arm")) == before


@pytest.mark.slow
@NEEDS_ICEGRID
def test_what_keeps_watch_is_started_again(place: Place, grid: str) -> None:
    for _ in range(2):
        (helper,) = [pid for pid in those(place, is_script("guard")) if "--watch" in procfs.command(pid)]
        os.kill(helper, signal.SIGKILL)

        def is_back(killed: int = helper) -> bool:
            found = [pid for pid in those(place, is_script("guard")) if "--watch" in procfs.command(pid)]
            return len(found) == 1 and found != [killed] and len(those(place, is_script("watch"))) == 1

        until(is_back, "another one")
    halted = [*those(place, is_program("icegridnode")), *those(place, is_run("base"))]
    halt(*halted)
    until(lambda: all(map(goes_on, halted)), "all go on", 15)


@pytest.mark.slow
@NEEDS_ICEGRID
def test_a_killed_guard_of_a_node_has_a_successor(place: Place, rcyaml: Rcyaml, grid: str) -> None:
    """Which is no parent of the node, and guards it all the same."""
    before = programs(place.folder, "base"), programs(place.folder, "arm")
    node = Path(place.folder, "state/icegrid/nodes/localhost")

    def guard() -> int:
        return int((node / "pid").read_text())

    for _ in range(2):
        killed = guard()
        os.kill(killed, signal.SIGKILL)
        until(lambda killed=killed: guard() != killed and len(those(place, is_script("watch"))) == 1, "a successor")
    assert (programs(place.folder, "base"), programs(place.folder, "arm")) == before
    (program,) = those(place, is_program("icegridnode"))
    os.kill(program, signal.SIGKILL)
    until(lambda: not is_alive(program) and len(those(place, is_program("icegridnode"))) == 1, "a node")
    until(lambda: rcyaml("deploy", "status", grid).exit_code == 0, "its processes")
    assert not {*programs(place.folder, "base")} & {*before[0]}
    os.kill(guard(), signal.SIGKILL)
    assert rcyaml("deploy", "down", grid).exit_code == 0
    all_ends(place.folder)


@pytest.mark.slow
@NEEDS_ICEGRID
def test_a_killed_guard_of_the_registry_has_a_successor(place: Place, rcyaml: Rcyaml, grid: str) -> None:
    registry = Path(place.folder, "state/icegrid/registry")

    def guard() -> int:
        return int((registry / "pid").read_text())

    for _ in range(2):
        killed = guard()
        os.kill(killed, signal.SIGKILL)
        until(lambda killed=killed: guard() != killed, "a successor")
    (program,) = those(place, is_program("icegridregistry"))
    os.kill(program, signal.SIGKILL)
    until(lambda: not is_alive(program) and len(those(place, is_program("icegridregistry"))) == 1, "a registry")
    assert rcyaml("deploy", "status", grid).exit_code == 0
    os.kill(guard(), signal.SIGKILL)
    assert rcyaml("deploy", "down", grid).exit_code == 0
    all_ends(place.folder)


def test_a_successor_leaves_it_to_a_guard_that_was_started_before_it_could(tmp_path: Path) -> None:
    """As when a node is started by hand whose guard and program were killed."""
    script = tmp_path / "guard"
    script.write_text(resources.text("templates/icegrid/guard"))

    def start(*words: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(["bash", script, *words, tmp_path, "sleep", "600"], start_new_session=True)

    def told(file: str) -> int | None:
        path = tmp_path / file
        return int(path.read_text() or 0) or None if path.exists() else None

    with ExitStack() as stack:
        stack.callback(lambda: [os.kill(pid, signal.SIGKILL) for pid in [told("program")] if pid])
        first = stack.enter_context(killed_on_failure(start()))
        program = until(lambda: told("program"), "a program")
        first.kill()
        first.wait()
        successor = stack.enter_context(killed_on_failure(start("--watch", "killed")))
        until(lambda: told("pid") == successor.pid, "a successor")
        halt(successor.pid)
        os.kill(program, signal.SIGKILL)
        second = stack.enter_context(killed_on_failure(start()))
        until(lambda: told("pid") == second.pid and told("program") not in (None, program), "another program")
        successor.send_signal(signal.SIGCONT)
        assert successor.wait(timeout=20) == 0
        assert told("pid") == second.pid and is_alive(told("program"))
        second.terminate()
        assert second.wait(timeout=20) == 0 and not (tmp_path / "pid").exists()


@pytest.mark.slow
@NEEDS_ICEGRID
def test_a_program_that_nobody_asks_is_told_with_icegrid(place: Place, rcyaml: Rcyaml, grid: str) -> None:
    (pid,) = programs(place.folder, "base")
    halt(pid)
    until(lambda: "not alive: it is halted" in rcyaml("deploy", "status", grid).stdout, "a notice", 15)
    os.kill(pid, signal.SIGCONT)
    until(lambda: rcyaml("deploy", "status", grid).exit_code == 0, "no notice", 15)
    assert programs(place.folder, "base") == [pid]
