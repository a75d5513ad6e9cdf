"""Which tests belong together: the folder of a test is its tier, and its marker. What the tests of a tier may do is
watched, so that `pytest -m unit` stays what it says.

Tests whose module starts processes, or a helper that it imports from, are marked `processes`; where rcyaml starts them,
a module says so itself. Only these tests are tried again where they fail: a busy machine can starve what they started.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import pytest

TESTS = Path(__file__).resolve().parent
OF_PROCESSES = frozenset(("deploy", "docs", "editor", "ice", "lint", "packaging", "plugins", "scxml"))
"""Tiers that are about processes as a whole."""
STARTING = frozenset(("os.fork", "os.forkpty", "os.posix_spawn", "os.system", "subprocess.Popen"))
OF_UNITS = STARTING | {"open", "socket.bind", "socket.connect"}
"""What is not done, as Python's audit events are called."""


def mark(item: pytest.Item) -> None:
    tier = item.path.relative_to(TESTS).parts[0]
    item.add_marker(tier)
    if tier in OF_PROCESSES or (tier != "unit" and isinstance(item, pytest.Function) and _may_start(item.module)):
        item.add_marker("processes")
    is_timed = item.get_closest_marker("processes") is not None and tier != "lint"
    if is_timed and item.config.pluginmanager.has_plugin("rerunfailures"):
        item.add_marker(pytest.mark.flaky(reruns=2, reruns_delay=1))


def is_left_out(path: Path, config: pytest.Config) -> bool:
    """Whether `-m TIER` alone says that nothing of a folder is wanted: then none of it is imported."""
    wanted = TESTS / (config.option.markexpr or ".").strip()
    return wanted.parent == TESTS and wanted.is_dir() and TESTS in path.parents and not _is_way_to(path, wanted)


def _is_way_to(path: Path, wanted: Path) -> bool:
    return path == wanted or wanted in path.parents


def _may_start(module: ModuleType) -> bool:
    """Whether a module of tests has `subprocess`, or takes something from one of tests that has it."""
    if not hasattr(module, "_may_start"):
        named = {
            getattr(value, "__module__", None) or getattr(value, "__name__", "") for value in vars(module).values()
        }
        known = [sys.modules[name] for name in named if isinstance(name, str) and name in sys.modules]
        ours = [one for one in known if TESTS in Path(getattr(one, "__file__", None) or "/").parents]
        module._may_start = any(hasattr(one, "subprocess") for one in (module, *ours))  # type: ignore[attr-defined]
    return bool(module._may_start)


class _Watch:
    """What the test that runs must not do, and what of that it did."""

    forbidden: frozenset[str] = frozenset()
    done: list[str]


def _hook(event: str, args: tuple[object, ...]) -> None:
    if not _Watch.forbidden:
        return
    if event in _Watch.forbidden and not _is_harmless(event, args):
        _Watch.done.append(f"{event}{args!r:.200}")
        raise AssertionError(f"not in a test of this tier: {_Watch.done[-1]}")


def _is_harmless(event: str, args: tuple[object, ...]) -> bool:
    """Files are opened, and whether an address is this machine's is asked with a port that anybody gets (0)."""
    if event == "open":
        return not str(args[0]).startswith("/proc/net/")
    return event == "socket.bind" and isinstance(args[1], tuple) and args[1][1] == 0


@contextmanager
def watched(item: pytest.Item) -> Iterator[None]:
    """Fails a test that does what its tier does not: units start no process and see nothing of the machine's ports,
    and what is not marked `processes` starts none."""
    is_unit = item.get_closest_marker("unit") is not None
    if not is_unit and item.get_closest_marker("processes"):
        yield
        return
    _Watch.done = []
    _Watch.forbidden = OF_UNITS if is_unit else STARTING
    try:
        yield
    finally:
        _Watch.forbidden = frozenset()
    if _Watch.done:
        pytest.fail(f"a test of this tier does not do that: {_Watch.done}")


sys.addaudithook(_hook)
