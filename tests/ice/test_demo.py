"""`make demo`, from where all is installed: the network answers; without Ice it is said how to come to it."""

from __future__ import annotations

import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from conftest import ROOT, write_tree
from processes import killed_on_failure, until

pytestmark = pytest.mark.slow


HAS_PAGE = all(importlib.util.find_spec(name) for name in ("rcyaml_manager", "starlette", "uvicorn"))


def demo_started(folder: Path, **variables: str) -> subprocess.Popen[str]:
    """On a copy, as others may be running the one of the checkout. No display is that of this machine."""
    for name in ("examples", "tools", "robocomp_yaml/languages/python/templates"):
        shutil.copytree(ROOT / name, folder / name)
    own = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.Popen(
        [sys.executable, folder / "examples" / "demo.py"], env={**own, **variables}, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


@contextmanager
def _ended(running: subprocess.Popen[str]) -> Iterator[subprocess.Popen[str]]:
    """A demo that is interrupted where its test fails: it then stops its network."""
    with killed_on_failure(running):
        try:
            yield running
        except BaseException:
            os.killpg(running.pid, signal.SIGINT)
            running.communicate(timeout=60)
            raise


def demo(folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    with _ended(demo_started(folder, **variables)) as running:
        output, errors = running.communicate(timeout=300)
    return subprocess.CompletedProcess([], running.returncode, output, errors)


def test_the_network_responds(tmp_path: Path) -> None:
    done = demo(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert not done.stderr and "warning" not in done.stdout.lower() and "\x1b" not in done.stdout
    parts = (
        "10 documents: nothing wrong\n", "ShellyHead: 3 processes as desired\n", "$ python3 say.py 'speech:tcp -h 127.0.0.1",
        "Speech.say('I am up and running') returns True\n", "speech   ready", "says 'running' with the mouth", "stopped\n",
    )  # fmt: skip
    places = [done.stdout.find(part) for part in parts]
    assert -1 not in places and places == sorted(places), done.stdout
    pictures = {path.name for path in (tmp_path / ".demo").iterdir()} & {"manager.png", "network.svg"}
    can_show = HAS_PAGE and shutil.which("chromium") is not None
    assert pictures == {"manager.png" if can_show else "network.svg"}, done.stdout
    assert not list((tmp_path / ".demo").rglob("Singleton*"))


@pytest.mark.skipif(not HAS_PAGE, reason="the page is not built: pip install ./web")
def test_where_there_is_a_display_the_manager_stays_until_ctrl_c(tmp_path: Path) -> None:
    """The browser is a script that writes what it is to open."""
    write_tree(tmp_path, {"browser": f'#!/bin/sh\necho "$1" > {tmp_path}/opened\n'})
    (tmp_path / "browser").chmod(0o755)
    variables = {"DISPLAY": ":99", "BROWSER": f"{tmp_path}/browser"}
    with _ended(demo_started(tmp_path, **variables)) as running:
        until(lambda: (tmp_path / "opened").exists(), "the browser", 120)
        assert (tmp_path / "opened").read_text().startswith("http://127.0.0.1:")
        time.sleep(1)
        assert running.poll() is None
        os.killpg(running.pid, signal.SIGINT)  # as a terminal does
        output, _ = running.communicate(timeout=60)
    assert running.returncode == 0, output
    assert "motors  stopped" in output and "Traceback" not in output


@pytest.mark.skipif(not HAS_PAGE, reason="the page is not built: pip install ./web")
@pytest.mark.parametrize("script", ["exit 1", "sleep 60", "printf '{\\0' >&4; sleep 9", None])
def test_without_a_browser_that_works_it_is_a_drawing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str | None, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.syspath_prepend(ROOT / "examples")
    import manager_picture
    from session import Session

    monkeypatch.setattr(manager_picture, "PATIENCE", 2)
    monkeypatch.setattr(manager_picture, "BROWSERS", ("its-browser",))
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    write_tree(tmp_path, {"robot.ddsl.yaml": "deployment: Robot\ncomponents: {base: {program: sleep}}\n"})
    if script is not None:
        (tmp_path / "its-browser").write_text(f"#!/bin/sh\n{script}\n")
        (tmp_path / "its-browser").chmod(0o755)
    manager_picture.show(Session(tmp_path), "robot.ddsl.yaml")
    assert "<svg" in (tmp_path / "network.svg").read_text()
    assert not (tmp_path / "manager.png").exists()
    said = capfd.readouterr().out
    assert ("there is none here" if script is None else "takes no picture") in said


def test_without_ice(tmp_path: Path) -> None:
    """All but the running network is shown."""
    done = demo(tmp_path, RCYAML_PYTHON="/no/such/python")
    assert done.returncode == 1
    assert "10 documents: nothing wrong\n" in done.stdout and "deploy up" not in done.stdout
    assert done.stderr.startswith("make: RCYAML_PYTHON names /no/such/python, which does not exist")


def test_a_call_of_nobody_is_reported(tmp_path: Path) -> None:
    """What one who follows the README by hand may do too early."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")

    def called(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "examples/say.py", *words], cwd=tmp_path, capture_output=True, text=True)

    assert "usage: say.py" in called().stderr
    early = called("speech:tcp -h 127.0.0.1 -p 9", "Hello")
    assert (early.returncode, early.stdout) == (1, "") and "talkinghead is not compiled" in early.stderr
    for command in ("migrate", "compile"):
        subprocess.run(
            [sys.executable, "-m", "robocomp_yaml", "-q", command, "examples/talkinghead"], cwd=tmp_path, check=True
        )
    nobody = called("speech:tcp -h 127.0.0.1 -p 9", "Hello")
    assert nobody.returncode == 1
    assert nobody.stderr == "say.py: no server answers at 'speech:tcp -h 127.0.0.1 -p 9': Connection refused\n"
