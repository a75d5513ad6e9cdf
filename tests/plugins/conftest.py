"""Plug-ins, each built into a wheel of its own and installed beside nothing else; and rcyaml, as users call it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from plugins.wheels import ROOT, SAMPLES, Run, build, install


@pytest.fixture(scope="session")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The samples' wheels, by the names of their folders."""
    folder = tmp_path_factory.mktemp("wheels")
    shutil.copytree(SAMPLES, folder / "sources")  # backends leave things beside what they build
    return {one.name: build(one, folder) for one in sorted((folder / "sources").iterdir())}


@pytest.fixture(scope="session")
def samples(wheels: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where all the samples are installed."""
    site = tmp_path_factory.mktemp("site")
    for wheel in wheels.values():
        install(wheel, site)
    return site


@pytest.fixture
def site(samples: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What is installed besides rcyaml, for one test to change."""
    return Path(shutil.copytree(samples, tmp_path_factory.mktemp("own") / "site"))


@pytest.fixture
def rcyaml(site: Path, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Runs `rcyaml ARGS` in tmp_path, or in a folder below it."""

    def run(*args: str, below: str = ".") -> subprocess.CompletedProcess[str]:
        # As an installed plug-in is found, and not from the working folder.
        start = "import sys; sys.path[0] = sys.argv.pop(1); from robocomp_yaml.__main__ import main; main()"
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path_factory.getbasetemp())}
        command = (sys.executable, "-c", start, str(site), *args)
        done = subprocess.run(command, cwd=tmp_path / below, env=environment, capture_output=True, text=True)
        assert "Traceback" not in done.stderr, done.stderr
        return done

    return run
