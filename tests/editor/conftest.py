"""The real yaml-language-server, installed once for this user and started once for the session, on a workspace of ours.

Tests ask `editor`; where node or npm is absent they are skipped.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from editor.robot import write_robot
from editor.workbench import Workbench
from editor.yaml_language_server import LanguageServer

HERE = Path(__file__).resolve().parent
PACKAGES = ("package.json", "package-lock.json")


def _server() -> Path:
    """The script of the pinned server, installed into the user's cache folder if it is not there yet."""
    pinned = hashlib.sha256(b"".join((HERE / name).read_bytes() for name in PACKAGES)).hexdigest()[:12]
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rcyaml" / "editor-tests"
    script = cache / pinned / "node_modules" / "yaml-language-server" / "bin" / "yaml-language-server"
    if not script.is_file():
        _install(cache / pinned)
    return script


def _install(folder: Path) -> None:
    """Installs beside, then renames: of several test processes one wins, and none sees half an installation."""
    part = folder.with_name(f"{folder.name}.{os.getpid()}")
    part.mkdir(parents=True)
    for name in PACKAGES:
        shutil.copy(HERE / name, part)
    done = subprocess.run(
        ["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=part, capture_output=True, text=True
    )
    if done.returncode == 0 and not folder.exists():
        part.rename(folder)
    shutil.rmtree(part, ignore_errors=True)
    if not folder.exists():
        pytest.skip(f"npm cannot install yaml-language-server: {done.stderr.strip().splitlines()[-1:]}")


@pytest.fixture(scope="session")
def schema_server() -> list[str]:
    """The command of yaml-language-server."""
    for program in ("node", "npm"):
        if shutil.which(program) is None:
            pytest.skip(f"the editor tests need {program} (Debian: apt install nodejs npm)")
    return ["node", str(_server()), "--stdio"]


def _opened(command: list[str], folder: Path) -> Iterator[Workbench]:
    server = LanguageServer(command)
    try:
        yield Workbench(server, folder)
    finally:
        server.stop()


@pytest.fixture(scope="session")
def editor(schema_server: list[str], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    """An editor in an empty workspace."""
    yield from _opened(schema_server, tmp_path_factory.mktemp("workspace"))


@pytest.fixture(scope="session")
def compiled(schema_server: list[str], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    """An editor in a workspace with documents that are compiled."""
    folder = tmp_path_factory.mktemp("robot")
    write_robot(folder)
    yield from _opened(schema_server, folder)
