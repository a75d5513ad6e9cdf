"""A folder for deployments, without leftovers after the test."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from processes import Ports, kill_left
from small_networks import Place


@pytest.fixture
def free_port() -> Ports:
    return Ports()


@pytest.fixture
def place(tmp_path: Path) -> Iterator[Place]:
    """A folder for one deployment. Its processes are killed at the end of the test."""
    place = Place(tmp_path)
    try:
        yield place
    finally:
        kill_left(place.folder)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A folder on a disk of 256 KiB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk)], capture_output=True)
    if done.returncode:
        pytest.skip("only root may mount a small disk")
    yield disk
    subprocess.run(["umount", "-l", str(disk)], check=True)
