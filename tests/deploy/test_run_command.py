"""The command `rcyaml run`: one process in the foreground, and what it needs beside it."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from processes import PATIENCE, kill_left, until
from robocomp_yaml.deploy.local import procfs
from small_networks import Place

Rcyaml = Callable[..., Result]
RCYAML = [sys.executable, "-m", "robocomp_yaml"]

ROBOT = """\
deployment: Robot
components:
  base:
    program: sh
    args: [-c, "echo base turns; exec sleep 600"]
    ready: {log: turns}
  arm:
    program: sh
    args: [-c, "echo arm moves; exec sleep 600"]
    after: [base]
    ready: {log: moves}
  hand:
    program: sh
    args: [-c, SCRIPT, hand]
    after: [arm]
    env: {GRIP: strong}
"""
WAITS = "trap 'echo tidy; exit 0' INT TERM; echo hand is open; while :; do sleep 0.1; done"


class Started:
    """`rcyaml run` as a process of its own, with its output."""

    def __init__(self, root: Path, *words: str) -> None:
        self.root, self.output = root, root / "output"
        with self.output.open("wb") as file:
            self.process = subprocess.Popen(
                [*RCYAML, "run", *words], cwd=root, stdin=subprocess.DEVNULL, stdout=file, stderr=file
            )

    @property
    def said(self) -> str:
        return self.output.read_text()

    def wait_for(self, text: str) -> None:
        until(lambda: text in self.said or self.process.poll() is not None, lambda: self.said)
        assert text in self.said

    def end(self, number: int) -> int:
        self.process.send_signal(number)
        return self.process.wait(PATIENCE)


Run = Callable[..., Started]


@pytest.fixture
def robot(place: Place) -> Iterator[Callable[[str], Path]]:
    """A deployment whose last process runs this line of shell."""
    yield lambda script: write_tree(place.root, {"robot.ddsl.yaml": ROBOT.replace("SCRIPT", f'"{script}"')})
    for folder in (place.root / ".rcyaml" / "run").glob("Robot.*"):
        kill_left(str(folder))


@pytest.fixture
def run(place: Place) -> Iterator[Run]:
    started: list[Started] = []

    def start(*words: str) -> Started:
        started.append(Started(place.root, *words))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.process.kill()
            one.process.wait()


def left(root: Path) -> list[int]:
    """What runs of the runs of a deployment."""
    return [pid for folder in (root / ".rcyaml" / "run").glob("*") for pid in procfs.marked(str(folder))]


def nothing_is_left(root: Path) -> None:
    """The keeper of a supervisor ends a moment after it."""
    until(lambda: not left(root), lambda: str([procfs.command_line(pid) for pid in left(root)]), 5)


@pytest.mark.parametrize(
    ("script", "code", "said"),
    [
        ("exit 0", 0, ""),
        ("exit 3", 3, "hand: ended with exit code 3\n"),
        ("kill -SEGV $$", 139, "hand: ended by SIGSEGV\n"),
        ("sleep 600 & exit 0", 0, ""),  # what it leaves is killed
    ],
)
def test_the_exit_code_is_passed_on(robot: Callable[[str], Path], run: Run, script: str, code: int, said: str) -> None:
    root = robot(script)
    one = run("hand")
    assert one.process.wait(PATIENCE) == code
    assert one.said.removeprefix("hand: sh, as in robot.ddsl.yaml\n") == said
    assert not list((root / ".rcyaml" / "run").glob("Robot*"))
    nothing_is_left(root)


def test_it_runs_as_its_entry_says(robot: Callable[[str], Path], run: Run) -> None:
    robot("echo $GRIP; pwd; for a; do echo =$a=; done")
    one = run("hand", "--", "-x", "two words")
    assert one.process.wait(PATIENCE) == 0
    assert one.said.splitlines()[1:] == ["strong", str(one.root), "=-x=", "=two words="]


def test_what_it_needs_runs_beside_it(robot: Callable[[str], Path], run: Run) -> None:
    root = robot(WAITS)
    one = run("hand", "--with-needed")
    one.wait_for("hand is open")
    assert len(left(root)) >= 5  # three programs, the supervisor and its keeper
    assert one.end(signal.SIGINT) == 130
    assert one.said.splitlines()[1:] == [
        "base: ready",
        "arm: ready",
        "hand is open",
        "tidy",
        "arm: stopped",
        "base: stopped",
    ]
    nothing_is_left(root)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGKILL, -9)])
def test_whatever_ends_it_nothing_is_left(
    robot: Callable[[str], Path], run: Run, number: int, code: int
) -> None:  # fmt: skip
    root = robot(WAITS)
    one = run("hand", "--with-needed")
    one.wait_for("hand is open")
    assert one.end(number) == code
    nothing_is_left(root)


def test_a_process_that_ends_takes_the_others_with_it(robot: Callable[[str], Path], run: Run) -> None:
    root = robot("kill -KILL $$")
    one = run("hand", "--with-needed")
    assert one.process.wait(PATIENCE) == 137
    assert "arm: ready\nhand: " not in one.said and one.said.endswith("hand: ended by SIGKILL\n")
    nothing_is_left(root)


def test_an_interruption_while_others_start(robot: Callable[[str], Path], run: Run) -> None:
    root = robot(WAITS)
    write_tree(root, {"robot.ddsl.yaml": (root / "robot.ddsl.yaml").read_text().replace("log: moves", "log: never")})
    one = run("hand", "--with-needed")
    one.wait_for("base: ready")
    assert one.end(signal.SIGINT) == 130
    assert "hand is open" not in one.said
    nothing_is_left(root)


def test_one_that_does_not_become_ready(robot: Callable[[str], Path], run: Run) -> None:
    root = robot(WAITS)
    text = (root / "robot.ddsl.yaml").read_text().replace("echo arm moves; exec sleep 600", "echo no arm; exit 4")
    write_tree(root, {"robot.ddsl.yaml": text.replace("ready: {log: moves}", 'restart: "no"')})
    one = run("hand", "--with-needed")
    assert one.process.wait(PATIENCE) == 1
    assert "error[RC7004]: 'arm' ended before it was ready: exit code 4" in one.said and "arm | no arm" in one.said
    assert "hand is open" not in one.said
    nothing_is_left(root)
    again = run("hand", "--with-needed")  # the lines of the first run are not those of the second
    assert again.process.wait(PATIENCE) == 1
    assert again.said.count("arm | no arm") == again.said.count("arm | rcyaml: started") == 1


def test_one_that_is_given_up_ends_the_run(robot: Callable[[str], Path], run: Run) -> None:
    root = robot(WAITS)
    text = (root / "robot.ddsl.yaml").read_text()
    text = text.replace("echo arm moves; exec sleep 600", "echo arm moves; sleep 2; echo no more; exit 5")
    write_tree(root, {"robot.ddsl.yaml": text.replace("ready: {log: moves}", 'ready: {log: moves}\n    restart: "no"')})
    one = run("hand", "--with-needed")
    assert one.process.wait(PATIENCE) == 1
    assert "hand is open" in one.said and "tidy" in one.said
    assert "error[RC7009]: 'arm'" in one.said and "arm | no more" in one.said and "─ robot.ddsl.yaml:" in one.said
    nothing_is_left(root)


def test_what_runs_already_is_used_and_stays(robot: Callable[[str], Path], run: Run, rcyaml: Rcyaml) -> None:
    root = robot(WAITS)
    assert rcyaml("deploy", "up", "robot.ddsl.yaml", "base").exit_code == 0
    one = run("hand", "--with-needed")
    one.wait_for("hand is open")
    assert "base: ready" not in one.said and "arm: ready" in one.said
    assert one.end(signal.SIGINT) == 130
    nothing_is_left(root)
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").stdout == "base  stopped\n"


def test_the_same_entry_runs_once(robot: Callable[[str], Path], run: Run, rcyaml: Rcyaml) -> None:
    robot(WAITS)
    one = run("hand")
    one.wait_for("hand is open")
    twice = rcyaml("run", "hand")
    pid = next(pid for pid in left(one.root) if "sh" in procfs.command_line(pid))
    assert twice.exit_code == 2 and f"'hand' runs already, by `rcyaml run` (pid {pid})" in twice.stderr
    assert one.end(signal.SIGINT) == 130
    rcyaml("deploy", "up", "robot.ddsl.yaml", "base")
    deployed = rcyaml("run", "base")
    assert deployed.exit_code == 2 and "'base' runs already, by `rcyaml deploy up`" in deployed.stderr
    assert "`rcyaml deploy down robot.ddsl.yaml base` stops it" in deployed.stderr
    rcyaml("deploy", "down", "robot.ddsl.yaml")


def at_terminal(root: Path, *words: str) -> tuple[int, int]:
    """The pid of `rcyaml run` with a terminal of its own, and the other end of that."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(root)
        os.execv(sys.executable, [*RCYAML, "run", *words])
    return pid, terminal


def read_until(terminal: int, text: str) -> str:
    said = b""
    end = time.monotonic() + PATIENCE
    while text.encode() not in said and time.monotonic() < end:
        try:
            said += os.read(terminal, 1024)
        except OSError:
            break
    assert text in said.decode(), said
    return said.decode()


def test_ctrl_c_at_a_terminal_reaches_it_once(robot: Callable[[str], Path]) -> None:
    counts = "n=0; trap 'n=$((n+1)); echo interrupted $n' INT; echo ready $(tty); i=0; while [ $i -lt 12 ]; do sleep 0.1; i=$((i+1)); done; exit 0"
    pid, terminal = at_terminal(robot(counts), "hand")
    assert "ready /dev/pts/" in read_until(terminal, "ready ")
    os.write(terminal, b"\x03")
    said = read_until(terminal, "interrupted 1")
    with suppress(OSError):
        while more := os.read(terminal, 1024):
            said += more.decode()
    assert "interrupted 2" not in said
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 130


def test_a_second_ctrl_c_kills_one_that_does_not_end(robot: Callable[[str], Path]) -> None:
    root = robot("trap 'echo later' INT TERM; echo up; while :; do sleep 0.1; done")
    pid, terminal = at_terminal(root, "hand", "--with-needed")
    read_until(terminal, "up\r")
    os.write(terminal, b"\x03")
    read_until(terminal, "later")
    time.sleep(0.5)
    began = time.monotonic()
    os.write(terminal, b"\x03")
    with suppress(OSError):
        while os.read(terminal, 1024):
            pass
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 130
    assert time.monotonic() - began < 5
    nothing_is_left(root)


MANY = """\
deployment: Robot
components:
  cam{i}: {program: "true", instances: 2}
  arm: {program: "true", enabled: false}
groups:
  front: {components: ["cam{i}", arm]}
"""


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["cam{i}"], 2, "'cam{i}' means several processes of robot.ddsl.yaml: cam0, cam1; name one of them"),
        (["front"], 2, "'front' means several processes of robot.ddsl.yaml: cam0, cam1, arm; name one of them"),
        (["camm0"], 2, "no deployment or component has the name 'camm0'; did you mean 'cam0'?"),
        (
            ["cam7", "--deployment", "robot.ddsl.yaml"],
            2,
            "robot.ddsl.yaml has no entry or component 'cam7'; did you mean 'cam1'?",
        ),
        (["cam7", "--deployment", "Robot"], 2, "robot.ddsl.yaml has no entry or component 'cam7'"),
        (["cam0", "--deployment", "Robto"], 2, "and no deployment of this name; did you mean 'Robot'?"),
        (["arm", "--alone"], 2, "unknown component 'arm'"),
        (["arm", "fast"], 2, "'fast' is unexpected: arguments of the program follow `--`"),
        (["robot.ddsl.yaml"], 2, "which of its entries? `rcyaml run robot.ddsl.yaml NAME`"),
        (["robot.ddsl.yaml", "amr"], 2, "did you mean 'arm'?"),
        (["arm", "--alone", "--deployment", "robot.ddsl.yaml"], 2, "--alone and --deployment exclude each other"),
        (
            ["cam", "--deployment", "parts/bad.ddsl.yaml"],
            1,
            "error[RC4008]: 'cam' has instances, but no {i} in its name",
        ),
        (["leg", "--deployment", "far.ddsl.yaml"], 1, "error[RC7008]: 'leg' runs on the host 'far' (192.0.2.9)"),
    ],
)
def test_what_is_refused(tmp_path: Path, rcyaml: Rcyaml, words: list[str], code: int, said: str) -> None:
    far = "deployment: Far\nhosts: {far: 192.0.2.9}\ncomponents: {leg: {program: 'true', host: far}}\n"
    bad = "deployment: Bad\ncomponents: {cam: {program: 'true', instances: 2}}\n"
    write_tree(tmp_path, {"robot.ddsl.yaml": MANY, "far.ddsl.yaml": far, "parts/bad.ddsl.yaml": bad})
    done = rcyaml("run", *words)
    assert (done.exit_code, said in done.stderr) == (code, True), done.stderr


def test_an_entry_of_one_of_several_deployments(tmp_path: Path, rcyaml: Rcyaml) -> None:
    one = "deployment: NAME\ncomponents: {same: {program: 'true'}, NAMEs: {program: 'true'}}\n"
    write_tree(tmp_path, {f"{name}.ddsl.yaml": one.replace("NAME", name) for name in ("arm", "leg")})
    assert "leg.ddsl.yaml" in rcyaml("run", "legs", "--dry-run").stdout
    both = rcyaml("run", "same", "--dry-run")
    assert both.exit_code == 2
    assert "choose one by `--deployment arm.ddsl.yaml` or `--deployment leg.ddsl.yaml`" in both.stderr


def test_a_deployment_of_the_workspace_is_named_from_any_folder(
    tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = "deployment: NAME\ncomponents: {same: {program: 'true'}}\n"
    write_tree(tmp_path, {f"d/{name}.ddsl.yaml": one.replace("NAME", name) for name in ("Arm", "Leg")})
    write_tree(tmp_path, {"rcyaml.yaml": "", "components/x/notes": ""})
    monkeypatch.chdir(tmp_path / "components" / "x")
    assert "../../d/Leg.ddsl.yaml" in rcyaml("run", "same", "--deployment", "Leg", "--dry-run").stdout


def test_a_path_to_another_workspace_means_the_deployment_there(
    tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    component = "component: ArmComp\nlanguage: python\n"
    deployment = "deployment: Robot\ncomponents: {left: {component: arm, port: 12345}}\n"
    robot = tmp_path / "my robot"
    write_tree(robot, {"rcyaml.yaml": "", "arm/arm.cdsl.yaml": component, "robot.ddsl.yaml": deployment})
    assert rcyaml("compile", "my robot").exit_code == 0
    write_tree(tmp_path, {"elsewhere/other.ddsl.yaml": "deployment: Other\ncomponents: {arm: {program: 'true'}}\n"})
    monkeypatch.chdir(tmp_path / "elsewhere")
    for path in (str(robot / "arm"), "../my robot/arm", "../my robot/arm/arm.cdsl.yaml"):
        shown = rcyaml("run", path, "--dry-run")
        assert "name     left\nas in    " in shown.stdout and "-p 12345" in shown.stdout, shown.output
    assert "as in    other.ddsl.yaml" in rcyaml("run", "arm", "--dry-run").stdout
    refused = rcyaml("run", "../my robot/robot.ddsl.yaml")
    assert "`rcyaml run '../my robot/robot.ddsl.yaml' NAME`" in refused.stderr


def test_a_broken_deployment_beside_does_not_matter(tmp_path: Path, rcyaml: Rcyaml) -> None:
    whole = "deployment: Arm\ncomponents: {arm: {program: 'true'}}\n"
    write_tree(
        tmp_path, {"arm.ddsl.yaml": whole, "leg.ddsl.yaml": "deployment: Leg\ncomponents: {leg: {program: 3}}\n"}
    )
    assert rcyaml("run", "arm").exit_code == 0
    leg = rcyaml("run", "leg")
    assert leg.exit_code == 1 and "leg.ddsl.yaml:2" in leg.stderr


def test_without_anything_to_run(tmp_path: Path, rcyaml: Rcyaml) -> None:
    assert "rcyaml new component NAME" in rcyaml("run").stderr
    assert "unknown component 'arm'" in rcyaml("run", "arm").stderr
    write_tree(tmp_path, {"arm.ddsl.yaml": "deployment: Arm\ncomponents: {arm: {program: 'true'}}\n"})
    assert "'nowhere/leg' does not exist" in rcyaml("run", "nowhere/leg").stderr
    assert "the entries are arm" in rcyaml("run", "xyzzy").stderr


def test_how_it_ended_as_json(tmp_path: Path, rcyaml: Rcyaml) -> None:
    write_tree(tmp_path, {"arm.ddsl.yaml": "deployment: Arm\ncomponents: {arm: {program: sh, args: [-c, exit 7]}}\n"})
    done = rcyaml("run", "arm", "--format", "json")
    assert json.loads(done.stdout) == {"name": "arm", "code": 7, "diagnostics": []} and done.exit_code == 7
    described = json.loads(rcyaml("run", "arm", "--dry-run", "--format", "json").stdout)
    assert described["command"] == ["sh", "-c", "exit 7"] and described["deployment"] == "arm.ddsl.yaml"
    assert "command  sh -c 'exit 7'\n" in rcyaml("run", "arm", "--dry-run").stdout
