"""Files that are none: pipes and devices are told of, and never waited for."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from robocomp_yaml.source.text import read_bytes

Run = Callable[..., Result]


@pytest.mark.parametrize("command", ["check", "compile", "migrate", "check Speech.idsl.yaml", "migrate Mouth.idsl"])
def test_a_pipe_among_the_documents_is_not_waited_for(command: str, rcyaml: Run, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "Speech.idsl.yaml")
    os.mkfifo(tmp_path / "Mouth.idsl")
    words = command.split()
    result = rcyaml(*words, *(["."] if words == ["migrate"] else []))
    assert (result.exit_code, result.output.splitlines()[0]) == (
        1, "error[RC0001]: cannot read this file: it is not a regular file",
    )  # fmt: skip


@pytest.mark.parametrize("command", ["check", "compile", "migrate"])
def test_a_device_is_not_read(command: str, rcyaml: Run, tmp_path: Path) -> None:
    (tmp_path / "z.idsl.yaml").symlink_to("/dev/zero")
    (tmp_path / "z.idsl").symlink_to("/dev/zero")
    for path in ("/dev/zero", "z.idsl.yaml", "z.idsl"):
        assert rcyaml(command, path).exit_code == 1


def test_a_file_that_says_it_is_empty_is_read_up_to_the_limit() -> None:
    path = "/proc/self/maps"
    if not os.path.exists(path):
        pytest.skip("this system has no /proc")
    raw, said = read_bytes(path, 100)
    assert raw is None and said[0].code == "RC0004"
