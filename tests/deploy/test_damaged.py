"""The files of a running network are damaged or deleted: no command hangs or ends with a traceback, and nothing runs
twice or stays after `down`."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import kill_left, until
from robocomp_yaml.deploy import registered
from seen import NEEDS_ICEGRID, all_ends, programs
from small_networks import Place
from test_roles import Rcyaml

DOCUMENT = """\
deployment: Robot
components:
  base: {{program: sleep, args: ["600"], role: server{more}}}
  arm: {{program: sleep, args: ["600"], role: server, after: [base]}}
"""
JUNK = (b"\xff\xfe{[", b"", b'{"a": 1}', b"[1, 2]", b'{"base": {"process": 5}}')
KEPT = (".pem", "/run", "/guard", "/watch", "/lock", "/settings")  # what others run or hold


@pytest.fixture(
    params=[
        "local",
        pytest.param(
            "icegrid",
            marks=[
                pytest.mark.slow,
                NEEDS_ICEGRID,
            ],
        ),
    ]
)
def robot(
    request: pytest.FixtureRequest, place: Place, rcyaml: Rcyaml, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[tuple[str, ...]]:
    """The document of a running network, and the options for its engine."""
    if request.param == "icegrid":
        pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    write_tree(tmp_path, {"robot.ddsl.yaml": DOCUMENT.format(more="")})
    words = (f"{tmp_path}/robot.ddsl.yaml", "--engine", request.param)
    try:
        assert rcyaml("deploy", "up", *words).exit_code == 0
        yield words
    finally:
        kill_left(place.folder)


def files(place: Place) -> list[Path]:
    found = [path for top in (f"{place.folder}/state", registered.root()) for path in Path(top).rglob("*")]
    return [path for path in found if path.is_file() and "/data/" not in str(path) and not str(path).endswith(KEPT)]


def test_each_file(place: Place, rcyaml: Rcyaml, robot: tuple[str, ...]) -> None:
    """`rcyaml` raises what would be a traceback."""
    before = programs(place.folder, "base"), programs(place.folder, "arm")
    found = files(place)
    assert len(found) > 2
    for path in found:
        text = path.read_bytes()
        for junk in JUNK:
            path.write_bytes(junk)
            assert rcyaml("deploy", "plan", *robot).exit_code in (0, 1)
            if path.parent.exists():
                path.write_bytes(text)
    for path in files(place):
        path.write_bytes(JUNK[0])
    assert rcyaml("deploy", "status", *robot).exit_code in (0, 1)
    assert (programs(place.folder, "base"), programs(place.folder, "arm")) == before
    assert rcyaml("deploy", "down", *robot).exit_code == 0
    all_ends(place.folder)


def test_an_up_of_one_process_without_its_folder(place: Place, rcyaml: Rcyaml, robot: tuple[str, ...]) -> None:
    """What ran beside it starts again, too: it ends, as its configuration is gone."""
    shutil.rmtree(place.folder)
    assert rcyaml("deploy", "up", *robot, "base").exit_code == 0
    until(lambda: [len(programs(place.folder, name)) for name in ("base", "arm")] == [1, 1], "each runs once")
    assert rcyaml("deploy", "status", *robot).exit_code == 0
    assert rcyaml("deploy", "down", *robot).exit_code == 0
    all_ends(place.folder)


def test_an_up_without_its_folder(place: Place, rcyaml: Rcyaml, robot: tuple[str, ...]) -> None:
    """A changed process starts, each one once."""
    shutil.rmtree(place.folder)
    write_tree(place.root, {"robot.ddsl.yaml": DOCUMENT.format(more=", env: {A: '1'}")})
    assert rcyaml("deploy", "up", *robot).exit_code == 0
    until(lambda: [len(programs(place.folder, name)) for name in ("base", "arm")] == [1, 1], "each runs once")
    (base,) = programs(place.folder, "base")
    assert b"A=1" in Path(f"/proc/{base}/environ").read_bytes().split(b"\0")
    assert os.path.exists(f"{place.folder}/logs/base.log")
    assert rcyaml("deploy", "down", *robot).exit_code == 0
    all_ends(place.folder)
