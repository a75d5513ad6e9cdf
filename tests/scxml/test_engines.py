"""Random machines: both interpreters do the same, and what another implementation does."""

from __future__ import annotations

import contextlib
import io
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import engines
from cpp_traces import in_cpp  # noqa: F401 - the fixture
from engines import Trace
from random_machines import Maker, odd_machines, read


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("g++"), reason="g++ is not installed")
def test_both_languages_do_the_same(tmp_path: Path, in_cpp: Callable[[], dict[str, Trace]]) -> None:
    machines = odd_machines(tmp_path)
    in_python = engines.run_python(machines, tmp_path / "python")
    assert in_python == {name: trace for name, trace in in_cpp().items() if name in machines}
    assert in_python["runaway"] == Trace(["a"], ["out "])
    assert sum(len(trace.logged) for trace in in_python.values()) > 300


def test_plain_machines_do_what_python_statemachine_makes_of_them(tmp_path: Path) -> None:
    """Those without parallel states and histories: there it orders entries as SCXML does, and runs content once."""
    processor = pytest.importorskip("statemachine.io.scxml.processor", reason="python-statemachine is not installed")
    texts = {f"m{seed}": Maker(seed, plain=True).text() for seed in range(100)}
    traces = engines.run_python({name: read(text, tmp_path / name) for name, text in texts.items()}, tmp_path)
    for name, text in texts.items():
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            other = processor.SCXMLProcessor()
            other.parse_scxml(name, text)
            other.start()
        theirs = [re.sub(r"^(\w+): '(.*)'$", r"\1 \2", line) for line in printed.getvalue().splitlines()]
        assert traces[name].logged == theirs, text
    assert sum(len(trace.logged) for trace in traces.values()) > 1000
