"""Wheels of plug-ins: built by the backend that their pyproject.toml names, and installed."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "examples" / "plugins"
Run = Callable[..., "subprocess.CompletedProcess[str]"]


def build(project: Path, into: Path) -> Path:
    """The wheel of a project, made by the backend that its pyproject.toml names."""
    before = {*into.glob("*.whl")}
    call(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(into), str(project))
    (wheel,) = {*into.glob("*.whl")} - before
    return wheel


def install(wheel: Path, site: Path) -> None:
    options = ("--quiet", "--disable-pip-version-check", "--no-index", "--no-deps", "--upgrade", "--target", str(site))
    call(sys.executable, "-m", "pip", "install", *options, str(wheel))


def call(*command: str) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
