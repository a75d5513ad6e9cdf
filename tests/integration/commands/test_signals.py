"""Exit codes: 130 after Ctrl-C, 143 after SIGTERM, 141 if the reader closes the pipe; no traceback, and no incomplete file."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import read_tree, write_tree
from terminals import COMMAND, environment, on_terminal

# Stops at an audit event of Python whose arguments contain a text, prints a line, and waits.
STOPPER = """
import os, sys, time
event, text = os.environ["STOP_AT"].split(" ", 1)
def hook(name, args):
    if name == event and text in str(args):
        os.write(3, b"here")
        time.sleep(60)
sys.addaudithook(hook)
"""
PLACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n",
    "speech/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech]\nparameters: speech.pdsl.yaml\n",
    "speech/speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 3}}\n",
    "speech/values.config.yaml": "component: speech.cdsl.yaml\nparameters: {volume: 4}\n",
    "old/Mouth.idsl": "module RoboCompMouth { interface Mouth { void close(); }; };\n",
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {tool: {program: /bin/true}}\n",
}


def stopped(folder: Path, at: str, number: int, *args: str) -> tuple[int, bytes]:
    """The exit code and the output of a run that gets a signal at an audit event."""
    (folder.parent / "hooks").mkdir(exist_ok=True)
    (folder.parent / "hooks/sitecustomize.py").write_text(STOPPER, encoding="utf-8")
    environ = environment(STOP_AT=at)
    environ["PYTHONPATH"] = f"{folder.parent / 'hooks'}:{environ['PYTHONPATH']}"
    here, there = os.pipe()
    command = ["bash", "-c", f'exec 3>&{there} {there}>&-; exec "$@"', "bash", *COMMAND, *args]
    process = subprocess.Popen(
        command, cwd=folder, env=environ, pass_fds=[there], stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    os.close(there)
    try:
        assert os.read(here, 4) == b"here", process.communicate(timeout=30)
        process.send_signal(number)
        output, _ = process.communicate(timeout=30)
        return process.returncode, output
    finally:
        os.close(here)
        if process.poll() is None:
            process.kill()


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return write_tree(tmp_path / "place", PLACE)


MOMENTS = [
    ("import click", ("--help",)),
    ("import robocomp_yaml.cli", ("check",)),
    ("import robocomp_yaml.pipeline", ("check",)),
    ("import msgspec", ("compile",)),
    ("open Speech.idsl.yaml", ("check",)),
    ("open Speech.idsl.yaml", ("compile",)),
    ("open CommonBehavior.ice", ("compile",)),
    ("open Mouth.idsl", ("migrate", "old")),
    ("open speech.pdsl.yaml", ("config", "show", "speech/values.config.yaml")),
    ("open robot.ddsl.yaml", ("graph",)),
    ("open robot.ddsl.yaml", ("deploy", "plan")),
    ("open robot.ddsl.yaml", ("deploy", "status", "--format", "json")),
    ("open idsl.schema.json", ("schema", "idsl")),
    ("open diagnostics/machines.md", ("explain",)),
]


@pytest.mark.parametrize(("at", "args"), MOMENTS, ids=[f"{at} {args[0]}" for at, args in MOMENTS])
def test_ctrl_c_at_any_moment(at: str, args: tuple[str, ...], place: Path) -> None:
    before = read_tree(place)
    code, output = stopped(place, at, signal.SIGINT, *args)
    assert (code, output.strip()) == (130, b"")
    assert read_tree(place) == before


@pytest.mark.parametrize(("at", "args"), [MOMENTS[1], MOMENTS[5], MOMENTS[10]])
def test_sigterm_at_any_moment(at: str, args: tuple[str, ...], place: Path) -> None:
    code, output = stopped(place, at, signal.SIGTERM, *args)
    assert (code, b"Traceback" in output) == (143, False)


WRITING = [
    ("os.rename values.config.yaml", ("config", "set", "speech/values.config.yaml", "volume", "5")),
    ("os.link new.config.yaml", ("config", "new", "speech/new.config.yaml")),
    ("os.link Mouth.idsl.yaml", ("new", "interface", "Mouth")),
    ("os.link robot.ddsl.yaml", ("new", "deployment", "Robot")),
    ("os.rename picture.svg", ("graph", "--as", "svg", "-o", "picture.svg")),
    ("os.rename ledger.json", ("migrate", "old", "--dry-run", "--report", "ledger.json")),
    ("os.rename specificworker.py", ("compile",)),
    ("os.rename Mouth.idsl.yaml", ("migrate", "old")),
]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(("at", "args"), WRITING, ids=[" ".join(args) for _, args in WRITING])
def test_no_incomplete_file_is_left(at: str, args: tuple[str, ...], number: int, place: Path) -> None:
    (place / "deployments").mkdir()
    before = read_tree(place)
    code, output = stopped(place, at, number, *args)
    assert code == 128 + number and b"Traceback" not in output
    assert read_tree(place) == before


def test_ctrl_c_ends_a_question(tmp_path: Path) -> None:
    failing = 'deployment: Robot\ncomponents: {hand: {program: sh, args: [-c, "exit 3"], restart: "no"}}\n'
    write_tree(tmp_path, {"robot.ddsl.yaml": failing})

    def act(process: subprocess.Popen[bytes], terminal: int, seen: bytes) -> None:
        if seen.endswith(b"[stop]: "):
            process.send_signal(signal.SIGINT)

    code, output = on_terminal(tmp_path, "deploy", "up", act=act)
    assert code == 130 and "`rcyaml deploy down robot.ddsl.yaml` stops them" in output and "Traceback" not in output
    subprocess.run([*COMMAND, "deploy", "down"], cwd=tmp_path, env=environment(), check=True)


def test_an_ignored_signal_stays_ignored(place: Path) -> None:
    script = f"trap '' INT; {sys.executable} -m robocomp_yaml check & p=$!; kill -INT $p; wait $p"
    done = subprocess.run(["bash", "-c", script], cwd=place, env=environment(), capture_output=True, timeout=60)
    assert done.returncode == 0 and b"documents" in done.stdout


@pytest.mark.parametrize(
    "args", ["explain", "explain --format json", "schema ddsl", "config export speech/values.config.yaml"]
)
def test_the_reader_may_close_the_pipe(args: str, place: Path) -> None:
    rcyaml = f"{sys.executable} -m robocomp_yaml {args}"
    done = subprocess.run(
        ["bash", "-c", f"{rcyaml} | true; echo ${{PIPESTATUS[0]}}"], cwd=place, env=environment(), capture_output=True
    )
    assert done.stderr == b"" and done.stdout.split()[-1] == b"141"
