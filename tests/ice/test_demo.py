"""`make demo`, from where all is installed: the network answers; without Ice it is said how to come to it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT

pytestmark = pytest.mark.slow


def demo(folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """On a copy, as others may be running the one of the checkout."""
    for name in ("examples", "tools", "robocomp_yaml/languages/python/templates"):
        shutil.copytree(ROOT / name, folder / name)
    return subprocess.run(
        [sys.executable, folder / "examples" / "demo.py"],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
    )


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
