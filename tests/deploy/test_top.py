"""`rcyaml top`: on a terminal, where keys sort and scroll, and elsewhere, where samples are printed one by one."""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import signal
import struct
import subprocess
import termios
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

from conftest import write_tree
from processes import until
from small_networks import Place
from terminals import COMMAND, environment

Rcyaml = Callable[..., Result]
ROBOT = """\
deployment: Robot
components:
  spin: {program: sh, args: [-c, "while :; do :; done"]}
  idle: {program: sleep, args: ["600"]}
  off: {program: sleep, args: ["600"], enabled: false}
"""
_COLORS = re.compile(r"\x1b\[[0-9;]*m")


@pytest.fixture
def robot(place: Place, tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "own"))
    write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT})
    up = rcyaml("deploy", "up", "robot.ddsl.yaml")
    assert up.exit_code == 0, up.output
    return tmp_path


def sampled(rcyaml: Rcyaml, *words: str) -> list[dict[str, Any]]:
    done = rcyaml("top", "--format", "json", "--every", "200ms", *words)
    assert done.exit_code == 0, done.output
    return [json.loads(line) for line in done.stdout.splitlines()]


def by_name(sample: dict[str, Any]) -> dict[str, Any]:
    return {one["name"]: one for one in sample["processes"]}


class Terminal:
    """`rcyaml top` on a terminal."""

    def __init__(self, folder: Path, *words: str, columns: int = 120, lines: int = 20) -> None:
        self.ours, self._theirs = pty.openpty()
        self.before = termios.tcgetattr(self._theirs)
        self.resize(columns, lines)
        self.process = subprocess.Popen(
            [*COMMAND, "top", "--every", "200ms", *words], cwd=folder, env=environment(), start_new_session=True,
            stdin=self._theirs, stdout=self._theirs, stderr=self._theirs,
        )  # fmt: skip
        self.seen = ""
        os.set_blocking(self.ours, False)

    def resize(self, columns: int, lines: int) -> None:
        fcntl.ioctl(self._theirs, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))

    def type(self, text: str) -> None:
        os.write(self.ours, text.encode())

    def read(self) -> str:
        try:
            while data := os.read(self.ours, 1 << 16):
                self.seen += data.decode()
        except OSError:
            pass
        return self.seen

    def frame(self) -> list[str]:
        """The lines of the last whole screen."""
        whole = [part for part in self.read().split("\x1b[H")[1:] if part.endswith("\x1b[J")]
        return (
            _COLORS.sub("", whole[-1]).replace("\x1b[K", "").removesuffix("\x1b[J").replace("\r", "").split("\n")
            if whole
            else []
        )

    def until(self, holds: Callable[[list[str]], object]) -> list[str]:
        until(lambda: (frame := self.frame()) and holds(frame), lambda: "\n".join(self.frame()) or self.seen)
        return self.frame()

    def names(self) -> list[str]:
        return [line.split()[0] for line in self.frame()[2:-1] if line]

    def ended(self) -> int:
        """The exit code. The terminal must be as it was before."""
        code = self.process.wait(20)
        assert self.read().rstrip().endswith("\x1b[?25h\x1b[?1049l"), self.seen[-300:]
        assert termios.tcgetattr(self._theirs) == self.before
        assert "Traceback" not in self.seen
        return code

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.ours)
        os.close(self._theirs)


@pytest.fixture
def terminal(robot: Path) -> Iterator[Callable[..., Terminal]]:
    made: list[Terminal] = []

    def start(*words: str, **size: int) -> Terminal:
        made.append(Terminal(robot, *words, **size))
        return made[-1]

    yield start
    for one in made:
        one.close()


def test_foreign_programs_show_what_the_system_knows(robot: Path, rcyaml: Rcyaml) -> None:
    first, second = sampled(rcyaml, "--count", "2")
    assert first["time"] < second["time"] and first["deployment"] == "Robot" and not first["problem"]
    found = by_name(second)
    assert list(found) == ["spin", "idle"]
    assert found["spin"]["cpu"] > 0.1 > found["idle"]["cpu"] >= 0 and found["idle"]["memory"] > 100_000
    assert found["idle"]["worker"] is found["idle"]["topics"] is found["idle"]["calls"] is None


def test_one_table(robot: Path, rcyaml: Rcyaml) -> None:
    done = rcyaml("top", "--once", "--sort", "cpu", "--reverse", "--every", "300ms")
    head, titles, *rows = done.stdout.splitlines()
    assert done.exit_code == 0 and head.startswith("Robot (local)") and "2 of 2 processes running" in head
    assert titles.split()[:2] == ["PROCESS", "STATE"] and [row.split()[0] for row in rows] == ["idle", "spin"]
    tables = rcyaml("top", "--count", "3", "--every", "100ms", "idle").stdout
    assert tables.count("PROCESS") == 3 and "spin" not in tables and "\x1b" not in tables


def test_by_its_name_from_anywhere(
    robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    for words in ([], ["Robot"], ["--deployment", "Robot"], ["Robot", "idle"], ["--deployment", "Robot", "idle"]):
        (sample,) = sampled(rcyaml, "--count", "1", *words)
        assert list(by_name(sample)) == (["idle"] if "idle" in words else ["spin", "idle"])
    for words in ([], ["--deployment", "Robot"]):  # so do the commands that talk to its components
        done = rcyaml("call", "idle.Arm.move", *words)
        assert done.exit_code == 2 and "idle serves no interface 'Arm'" in done.output
        assert rcyaml("topic", "echo", "Lit", *words).exit_code == 2
        done = rcyaml("param", "list", "idel", *words)
        assert done.exit_code == 2 and "robot.ddsl.yaml has no component 'idel'" in done.output
    monkeypatch.chdir(robot)
    assert "idle serves no" in rcyaml("call", "idle.Arm.move", "--deployment", "Robot").output
    assert "there is no document 'Robto', and no" in rcyaml("call", "idle.Arm.move", "--deployment", "Robto").output
    monkeypatch.chdir(tmp_path / "elsewhere")
    os.unlink(robot / "robot.ddsl.yaml")
    done = rcyaml("call", "idle.Arm.move")
    assert done.exit_code == 1 and "robot.ddsl.yaml" in done.output and "error[RC0" in done.output, done.output
    assert list(by_name(sampled(rcyaml, "--once", "Robot")[0])) == ["spin", "idle"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--deployment", "Robto"], "no document 'Robto', and no running deployment"),
        (["idel"], "Robot has no process or group 'idel'; did you mean 'idle'?"),
        (["--sort", "speed"], "'speed' is not one of"), (["--every", "2"], "'2' is not a duration"),
        (["--count", "0"], "0 is not in the range"),
    ],
)  # fmt: skip
def test_wrong_usage(robot: Path, rcyaml: Rcyaml, words: list[str], said: str) -> None:
    done = rcyaml("top", "--count", "1", *words)
    assert done.exit_code == 2 and said in done.output, done.output


def test_nothing_here_and_nothing_runs(tmp_path: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "none"))
    done = rcyaml("top")
    assert done.exit_code == 2 and "this folder has no deployment document, and no deployment runs" in done.output


def test_a_process_dies_another_appears_and_all_end(robot: Path, rcyaml: Rcyaml, place: Place) -> None:
    command = [*COMMAND, "top", "--format", "json", "--every", "200ms", "robot.ddsl.yaml"]
    top = subprocess.Popen(command, cwd=robot, env=environment(), stdout=subprocess.PIPE, text=True)
    assert top.stdout is not None

    def next_with(holds: Callable[[dict[str, Any]], object]) -> dict[str, Any]:
        assert top.stdout is not None
        for line in top.stdout:
            if holds(found := by_name(json.loads(line))):
                return found
        raise AssertionError("it has ended")

    try:
        first = next_with(lambda found: found["idle"]["pid"])
        os.kill(first["idle"]["pid"], signal.SIGKILL)
        again = next_with(lambda found: found["idle"]["pid"] not in (None, first["idle"]["pid"]))
        assert again["idle"]["restarts"] == 1 and again["idle"]["cpu"] is None and again["spin"]["cpu"] is not None
        (robot / "robot.ddsl.yaml").write_text(ROBOT + "  new: {program: sleep, args: ['600']}\n")
        assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
        assert next_with(lambda found: "new" in found and found["new"]["cpu"] is not None)
        _, supervisor = place.keeper_and_supervisor()
        os.kill(supervisor, signal.SIGKILL)
        next_with(lambda found: found["idle"]["pid"] is None)
        assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
        next_with(lambda found: found["idle"]["pid"])
        assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0
        gone = next_with(lambda found: found["idle"]["state"] == "not started")
        assert gone["idle"]["pid"] is gone["idle"]["memory"] is gone["idle"]["restarts"] is None
    finally:
        top.send_signal(signal.SIGINT)
        code = top.wait(20)
        top.stdout.close()
    assert code == 130


def test_keys(terminal: Callable[..., Terminal]) -> None:
    top = terminal()
    top.until(lambda frame: "sorted by document" in frame[0] and len(frame) > 3)
    assert top.names() == ["spin", "idle"]
    top.type("n")
    top.until(lambda frame: "sorted by name" in frame[0])
    assert top.names() == ["idle", "spin"]
    top.type("cr")
    top.until(lambda frame: "sorted by cpu, reversed" in frame[0])
    top.type("\x1b[B?")  # without a meaning here
    top.type("q")
    assert top.ended() == 0


def test_another_size(terminal: Callable[..., Terminal]) -> None:
    top = terminal("--sort", "name")
    top.until(lambda frame: len(frame) > 3 and "TOPICS" in frame[1])
    top.resize(40, 4)
    top.process.send_signal(signal.SIGWINCH)
    frame = top.until(lambda frame: len(frame) == 4 and "TOPICS" not in frame[1])
    assert max(map(len, frame)) < 40 and top.names() == ["idle"]
    assert frame[-1].startswith("1 to 1 of 2: arrows")
    top.type("\x1b[B")
    top.until(lambda frame: top.names() == ["spin"])
    top.resize(300, 50)
    top.process.send_signal(signal.SIGWINCH)
    top.until(lambda frame: "TOPICS" in frame[1] and top.names() == ["idle", "spin"])
    top.type("q")
    assert top.ended() == 0


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 143)])
def test_whatever_ends_it_the_terminal_is_as_before(
    terminal: Callable[..., Terminal], number: signal.Signals, code: int
) -> None:
    top = terminal()
    top.until(lambda frame: len(frame) > 3)
    top.process.send_signal(number)
    assert top.ended() == code


def test_it_is_stopped_and_goes_on(terminal: Callable[..., Terminal]) -> None:
    top = terminal()
    top.until(lambda frame: len(frame) > 3)
    top.process.send_signal(signal.SIGTSTP)
    until(lambda: top.read().endswith("\x1b[?1049l"), lambda: top.seen)
    assert termios.tcgetattr(top._theirs) == top.before
    seen = len(top.seen)
    top.process.send_signal(signal.SIGCONT)
    until(lambda: "\x1b[?1049h" in top.read()[seen:] and top.seen.endswith("\x1b[J"), lambda: top.seen)
    top.type("q")
    assert top.ended() == 0


def test_a_number_of_samples(terminal: Callable[..., Terminal]) -> None:
    assert terminal("--count", "2").ended() == 0


def test_a_terminal_that_cannot_draw(robot: Path) -> None:
    done = subprocess.run([*COMMAND, "top", "--once"], cwd=robot, env=environment(TERM="dumb"), capture_output=True)
    assert done.returncode == 0 and b"\x1b" not in done.stdout and done.stdout.count(b"PROCESS") == 1
