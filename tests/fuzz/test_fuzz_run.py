"""`make fuzz` itself: which files it runs, what it takes for a find; and that all other runs are not random."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import settings

import run
from conftest import FUZZING, ROOT


@pytest.mark.skipif(FUZZING, reason="this is the random run")
def test_a_run_of_the_tests_is_not_random() -> None:
    assert settings.default is not None and settings.default.derandomize and settings.default.database is None


def test_every_random_test_is_run() -> None:
    found = {path.name for path in run.harnesses([])}
    assert {"test_fuzz_documents.py", "test_verdicts.py", "test_verdicts_cpp.py", "test_migrated_configs.py"} <= found
    assert [path.name for path in run.harnesses(["migrated_conf"])] == ["test_migrated_configs.py"]


def test_a_find_is_told_with_the_way_to_see_it_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(run, "FOUND", tmp_path)
    made = run.Run([], time.monotonic())
    name = Path("tests/fuzz/test_x.py")
    made.tell(name, 1, "2 passed in 1.00s", 0)
    made.tell(
        name,
        2,
        "E  it is so\nFAILED tests/fuzz/test_x.py::test_y - AssertionError: it\n1 failed, 1 passed in 1.0s\n",
        1,
    )
    made.tell(name, 3, "FAILED tests/fuzz/test_x.py::test_y - AssertionError: it again\n", 1)
    made.tell(name, 4, "Interrupted", 2)
    made.tell(name, 5, "Segmentation fault", -11)
    assert list(made.finds) == ["tests/fuzz/test_x.py::test_y", "tests/fuzz/test_x.py"]
    command, log = made.finds["tests/fuzz/test_x.py::test_y"]
    assert "--hypothesis-seed=2" in command and "it is so" in log.read_text()
    assert capsys.readouterr().out.count("found:") == 2


def test_no_file_of_that_name() -> None:
    done = subprocess.run(
        [sys.executable, "tests/fuzz/run.py", "nothing-like-it"], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 2 and "no test file" in done.stderr
