"""C++ components, built with CMake once per test run: each takes many seconds."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from components import build
from cpp_sources import DOCUMENTS, SOURCES

needs_cpp = pytest.mark.skipif(
    not all(map(shutil.which, ("cmake", "g++", "slice2cpp"))) or not Path("/usr/include/Ice/Ice.h").is_file(),
    reason="CMake, g++ or Ice for C++ is not installed (Debian: cmake g++ libzeroc-ice-dev zeroc-ice-compilers)",
)

needs_qt = pytest.mark.skipif(
    not any(Path("/usr/lib").glob("*/cmake/Qt[56]Widgets")), reason="Qt is not installed (Debian: qt6-base-dev)"
)
# Where there is another one of its kind.
in_all_builds = pytest.mark.skipif(
    "RCYAML_ALL_BUILDS" not in os.environ, reason="builds of half a minute and more: RCYAML_ALL_BUILDS=1 runs them all"
)


@dataclass(frozen=True)
class Program:
    """A built component. Tests share its folder: each uses a config of its own."""

    name: str
    root: Path

    @property
    def path(self) -> Path:
        return self.root / "bin" / self.name

    def command(self, folder: Path, properties: Mapping[str, object]) -> list[str | Path]:
        """Runs it with a config with these properties."""
        config = folder / f"{self.name}.config"
        config.write_text("".join(f"{key} = {value}\n" for key, value in properties.items()))
        return [self.path, config]


Programs = Callable[[str], Program]


HERE = Path(__file__).resolve().parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rcyaml" / "test-objects"
# Fast builds: without optimization, and with objects that other tests have built.
FAST = (
    "-DCMAKE_BUILD_TYPE=Plain", f"-DCMAKE_PROJECT_INCLUDE={HERE / 'kept_objects.cmake'}",
    f"-DKEPT_OBJECTS={';'.join((sys.executable, str(HERE / 'kept_objects.py'), str(CACHE)))}",
)  # fmt: skip


def cmake(root: Path, *options: str) -> None:
    """Configures and builds; a warning is a failure."""
    folder = str(root / "build")
    for command in (
        ["cmake", "-S", str(root), "-B", folder, "-DCMAKE_CXX_FLAGS=-Werror", *options],
        ["cmake", "--build", folder, "-j", str(1 if "PYTEST_XDIST_WORKER" in os.environ else 2)],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"


@contextmanager
def locked(file: Path) -> Iterator[None]:
    """A lock between processes."""
    with file.open("w") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        yield


@pytest.fixture(scope="session")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Programs:
    """`programs("Server")`: built by the first test that needs it, in any of pytest-xdist's processes."""
    sources = {name: {"src/specificworker.cpp": source} for name, source in SOURCES.items()}
    return shared_programs(tmp_path_factory.getbasetemp(), "c++ ñ", DOCUMENTS, sources)  # with a blank and more


def shared_programs(
    base: Path, name: str, documents: Mapping[str, str], sources: Mapping[str, Mapping[str, str]]
) -> Programs:
    """Programs of these documents, with the user's files of each component, in a folder that pytest-xdist's processes
    share."""
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    folder = shared / name
    folder.mkdir(exist_ok=True)
    with locked(shared / f"{name}.documents.lock"):
        if not (folder / "Arm.idsl.yaml").is_file():
            for component in build(documents, folder).values():
                for path, text in sources.get(component.name, {}).items():
                    (component.root / path).write_text(text)

    def program(name: str) -> Program:
        found = Program(name, folder / name.lower())
        with locked(shared / f"{name}.lock"):
            if not found.path.is_file():
                # The server as users build it, with the optimizer's warnings.
                cmake(found.root, *(() if name == "Server" else FAST))
        return found

    return program
