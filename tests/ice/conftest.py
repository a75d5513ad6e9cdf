"""What the tests over real Ice share: free ports, processes that always end, an IceStorm, a client's communicator.

Language-neutral: the tests of the Python and of the C++ target use the same fixtures.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from components import Build, Built
from components import build as build_components
from cpp_programs import programs  # noqa: F401 (the fixture)
from processes import Ports, Running, Start, Storm, answers, until
from robocomp_workers import NO_QT
from scenario import INTERFACES, cdsl


@pytest.fixture
def start() -> Iterator[Start]:
    """`start(command, cwd=…, env={…})`: a process that is killed at the end of the test, if it still runs."""
    started: list[Running] = []

    def start_process(
        command: Sequence[str | Path], cwd: Path | None = None, env: Mapping[str, str] | None = None
    ) -> Running:
        process = subprocess.Popen(
            [str(word) for word in command],
            cwd=cwd,
            env={**os.environ, "PYTHONUNBUFFERED": "1", **(env or {})},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        started.append(Running(process))
        return started[-1]

    yield start_process
    for running in started:
        running.end()


@pytest.fixture(scope="session")
def free_port() -> Ports:
    """`free_port()`: a TCP port that nobody uses."""
    return Ports()


@pytest.fixture(scope="session")
def ice() -> Iterator[Any]:
    """A client's communicator; the test is skipped where Python has no Ice."""
    Ice = pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    data.properties.setProperty("Ice.Override.ConnectTimeout", "2000")
    data.properties.setProperty("Ice.Default.InvocationTimeout", "10000")
    communicator = Ice.initialize(data)
    yield communicator
    communicator.destroy()


@pytest.fixture(scope="session")
def icestorm(ice: Any, free_port: Ports, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Storm]:
    """A real IceStorm in icebox, one for the session (of each xdist worker)."""
    if shutil.which("icebox") is None:
        pytest.skip("icebox is not installed (Debian: zeroc-icebox, libzeroc-icestorm3.7)")
    folder = tmp_path_factory.mktemp("icestorm")
    storm = Storm.new(folder, free_port(), free_port())
    process = subprocess.Popen(storm.command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    running = Running(process)
    until(lambda: answers(ice, storm.manager), lambda: f"IceStorm:\n{running.output}")
    yield storm
    process.terminate()
    try:
        process.wait(5)
    except subprocess.TimeoutExpired:
        running.end()


@pytest.fixture
def build(tmp_path: Path) -> Build:
    """`build({path: YAML})`: the components among these documents, compiled, by name."""

    def build_in_folder(documents: Mapping[str, str]) -> dict[str, Built]:
        return build_components(documents, tmp_path)

    return build_in_folder


@pytest.fixture(scope="session")
def slices(ice: Any, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Makes this process know the interfaces of `scenario` and CommonBehavior: `import RoboCompArm` works then."""
    import Ice

    folder = tmp_path_factory.mktemp("slices")
    built = build_components({**INTERFACES, "any.cdsl.yaml": cdsl("Any", implements=["Arm"])}, folder)["Any"].root
    files = [str(built / "slice" / "Arm.ice"), str(built / "generated" / "slice" / "CommonBehavior.ice")]
    Ice.loadSlice("", ["--all", f"-I{built / 'slice'}", *files])


@pytest.fixture
def behavior(ice: Any, slices: None) -> Callable[[int], Any]:
    """`behavior(port)`: the CommonBehavior of the component that serves it there."""
    import RoboCompCommonBehavior

    def proxy(port: int) -> Any:
        found = ice.stringToProxy(f"commonbehavior:tcp -h 127.0.0.1 -p {port}")
        return RoboCompCommonBehavior.CommonBehaviorPrx.uncheckedCast(found)

    return proxy


@pytest.fixture(params=["pyside6", "no-qt"])
def robocomps_qt(request: pytest.FixtureRequest, tmp_path: Path) -> Mapping[str, str]:
    """The environment of a process: with PySide6, or with one that cannot be imported."""
    if request.param == "pyside6":
        if importlib.util.find_spec("PySide6") is None:
            pytest.skip("PySide6 is not installed (PySide6-Essentials<6.11)")
        return {"QT_QPA_PLATFORM": "offscreen"}
    (tmp_path / "hidden" / "PySide6").mkdir(parents=True)
    (tmp_path / "hidden" / "PySide6" / "__init__.py").write_text(NO_QT)
    return {"PYTHONPATH": str(tmp_path / "hidden")}


_TALKING = ("test_call", "test_topic_commands")
"""Modules whose commands know interfaces by themselves: another test of this process may have loaded the same Slice."""


@pytest.fixture
def rcyaml(request: pytest.FixtureRequest, rcyaml: Callable[..., Any]) -> Callable[..., Any]:
    """Runs `rcyaml ARGS` in tmp_path, for modules that talk to components in a process of its own."""
    if request.module.__name__.rpartition(".")[2] not in _TALKING:
        return rcyaml

    def run(*args: str, stdin: str | None = None) -> Any:
        command = [sys.executable, "-m", "robocomp_yaml", *args]
        done = subprocess.run(command, input=stdin or "", capture_output=True, text=True, check=False)
        return SimpleNamespace(
            exit_code=done.returncode, stdout=done.stdout, stderr=done.stderr, output=done.stdout + done.stderr
        )

    return run
