"""Long runs show progress on a terminal only."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

from robocomp_yaml.commands._options import MANY


@pytest.fixture
def many(tmp_path: Path) -> Path:
    for number in range(MANY + 20):
        (tmp_path / f"M{number}.idsl.yaml").write_text(f"module: RoboCompM{number}\n", encoding="utf-8")
    return tmp_path


def test_a_bar_on_a_terminal(many: Path) -> None:
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "robocomp_yaml", "check", "."]
    environment = {**os.environ, "TERM": "xterm"}
    process = subprocess.Popen(command, cwd=many, stdout=subprocess.PIPE, stderr=theirs, env=environment)
    os.close(theirs)
    out, _ = process.communicate(timeout=60)
    shown = os.read(ours, 1 << 16).decode()
    os.close(ours)
    assert "reading" in shown and "%" in shown
    assert out.decode() == f"{MANY + 20} documents: nothing wrong\n"


def test_no_bar_elsewhere(many: Path) -> None:
    command = [sys.executable, "-m", "robocomp_yaml", "check", "."]
    assert subprocess.run(command, cwd=many, capture_output=True, timeout=60).stderr == b""
