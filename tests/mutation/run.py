"""`make mutants`: whether the fast tests notice when the code means something else.

    python tests/mutation/run.py [--mutants 60] [--seed 1] [WORD …]

Mutants are drawn at random, the same ones for the same seed and code; words select the files whose paths contain one of
them. A mutant is killed if a unit test that runs its line fails. One process loads all of these tests, and forks for each
mutant, which replaces functions in the fork: a mutant costs no more than its tests.
"""

from __future__ import annotations

import argparse
import gc
import importlib
import json
import os
import random
import resource
import signal
import sys
import time
from collections.abc import Callable
from functools import partial
from itertools import islice
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import coverage
import pytest
from _pytest.runner import runtestprotocol

import mutants
from robocomp_yaml.source.digest import digest

ROOT = Path(__file__).resolve().parents[2]
AREAS = (
    "link", "model", "parameters", "network", "legacy/settings", "deploy/plan.py", "deploy/differences.py",
    "deploy/carry_out.py", "deploy/operations.py",
)  # fmt: skip
TESTS = ("tests/unit", "tests/properties/test_any_text.py", "tests/properties/test_random_graphs.py")
KEPT = ROOT / ".mutants" / "seen.json"
LONGEST = 8
"""Seconds of CPU, beside those that the tests take, after which they have noticed a mutant: it has no end."""
SLOW = 2.0
"""Seconds of a test that is not asked: what it would notice, a faster one should."""
UNFIT = "it could not be put in"
AT_ONCE = 500
"""Tests that one process looks at."""
MOST = 1000
"""Tests that are asked of a mutant, the fastest ones: what none of them notices counts as a survivor."""


def files(words: list[str]) -> list[Path]:
    found = [path for area in AREAS for path in sorted(_modules(ROOT / "robocomp_yaml" / area))]
    return [path for path in found if not words or any(word in str(path) for word in words)]


def _modules(area: Path) -> list[Path]:
    return [area] if area.is_file() else [path for path in area.rglob("*.py") if "templates" not in path.parts]


class Mutating:
    """Given to pytest, which collects the tests; then this runs some of them for each mutant."""

    def __init__(self, drawn: list[mutants.Mutant]) -> None:
        self.drawn = drawn
        self.words = os.fdopen(os.dup(2), "w")  # pytest takes what is written to the other
        self.survivors: list[mutants.Mutant] = []
        self.unfit: list[mutants.Mutant] = []

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self.items = {item.nodeid: item for item in session.items}
        for path in files([]):
            importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
        gc.unfreeze()  # what `conftest` froze is in no list
        self.functions = [one for one in gc.get_objects() if isinstance(one, FunctionType)]
        gc.freeze()
        self.look_at_new_ones()
        for mutant in self.drawn:
            self.say(f"{self.end(mutant):8}  {mutant}")
        return True

    def look_at_new_ones(self) -> None:
        """What is known of a test holds as long as the code and the tests stay as they are."""
        tests = sorted((ROOT / "tests").glob("*.py")) + [path for one in TESTS for path in _modules(ROOT / one)]
        code = digest(b"".join(path.read_bytes() for path in (*files([]), *tests)))
        kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
        self.seen = kept if kept.get("code") == code else {"code": code, "lines": {}, "seconds": {}}
        began, new = time.monotonic(), [test for test in self.items if test not in self.seen["seconds"]]
        for first in range(0, len(new), AT_ONCE):
            self.merge(json.loads(_forked(partial(self.look, new[first : first + AT_ONCE]))))
        KEPT.parent.mkdir(exist_ok=True)
        KEPT.write_text(json.dumps(self.seen))
        self.say(f"looked at {len(new)} of {len(self.items)} tests in {time.monotonic() - began:.0f} s")

    def merge(self, more: dict[str, Any]) -> None:
        self.seen["seconds"] |= more["seconds"]
        for file, lines in more["lines"].items():
            for line, tests in lines.items():
                self.seen["lines"].setdefault(file, {}).setdefault(line, []).extend(test for test in tests if test)

    def say(self, text: str) -> None:
        print(text.replace(f"{ROOT}/", ""), file=self.words, flush=True)

    def look(self, tests: list[str]) -> str:
        """By file and line, the tests that run it; and how long each takes, as JSON."""
        measured = coverage.Coverage(data_file=None, include=[str(path) for path in files([])])
        measured.start()
        seconds = {}
        for nodeid in tests:
            measured.switch_context(nodeid)
            began = time.process_time()
            if not _passes(self.items[nodeid]):
                self.say(f"it fails without a mutant: {nodeid}")
                continue
            seconds[nodeid] = time.process_time() - began
        measured.stop()
        data = measured.get_data()
        lines = {file: data.contexts_by_lineno(file) for file in data.measured_files()}
        return json.dumps({"lines": lines, "seconds": seconds})

    def end(self, mutant: mutants.Mutant) -> str:
        seconds = self.seen["seconds"]
        lines = self.seen["lines"].get(str(mutant.path), {})
        known = lines.get(str(mutant.line)) or lines.get(str(mutant.statement), ())
        quick = [test for test in known if test in self.items and seconds[test] < SLOW]
        tests = sorted(quick, key=lambda test: seconds[test])
        found = _forked(partial(self.killer, mutant, tests[:MOST]))
        if found == UNFIT:
            self.unfit.append(mutant)
        elif not found:
            self.survivors.append(mutant)
        return "unfit" if found == UNFIT else "noticed" if found else "SURVIVED" if tests else "NOT RUN"

    def killer(self, mutant: mutants.Mutant, tests: list[str]) -> str:
        longest = int(LONGEST + 3 * sum(self.seen["seconds"][test] for test in tests))
        resource.setrlimit(resource.RLIMIT_CPU, (longest, longest))
        signal.alarm(longest * 10)
        if not self.put_in(mutant):
            return UNFIT
        return next((test for test in tests if not _passes(self.items[test])), "")

    def put_in(self, mutant: mutants.Mutant) -> bool:
        """All functions that were made of its code have the new one: whoever imported them has, too."""
        new, path = mutant.code(), str(mutant.path)
        old = [one for one in self.functions if one.__code__.co_filename == path and _is_the_same(one.__code__, new)]
        for function in old:
            function.__code__ = new
        return bool(old)


def _is_the_same(old: CodeType, new: CodeType) -> bool:
    return (old.co_firstlineno, old.co_qualname) == (new.co_firstlineno, new.co_qualname)


def _passes(item: pytest.Item) -> bool:
    """Every fixture is taken down afterwards: the next test that is run is any."""
    reports = runtestprotocol(item, log=False, nextitem=None)
    return all(not report.failed for report in reports)


def _forked(do: Callable[[], str]) -> str:
    """What a child says; a word where it says nothing, as it was killed."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        said = UNFIT
        try:
            os.close(reading)
            os.setsid()
            said = do()
        finally:
            with os.fdopen(writing, "w") as pipe:
                pipe.write(said)
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        said = pipe.read()
    _, status = os.waitpid(child, 0)
    return said if status == 0 else "it had no end"


def main() -> int:
    parser = argparse.ArgumentParser(prog="make mutants", description=__doc__.splitlines()[0])
    parser.add_argument("--mutants", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("words", nargs="*", metavar="WORD")
    given = parser.parse_args()
    all_of_them = [mutant for path in files(given.words) for mutant in mutants.of(path)]
    random.Random(given.seed).shuffle(all_of_them)
    drawn = list(islice((mutant for mutant in all_of_them if mutant.is_python), given.mutants))
    run = Mutating(sorted(drawn, key=lambda mutant: (mutant.path, mutant.start)))
    run.say(f"{len(drawn)} of {len(all_of_them)} mutants, seed {given.seed}")
    os.chdir(ROOT)
    arguments = ["-q", "-p", "no:cacheprovider", "-p", "no:rerunfailures", "-p", "no:xdist"]
    arguments += ["-o", "tmp_path_retention_policy=none", *TESTS]
    pytest.main(arguments, plugins=[run])
    fit = len(drawn) - len(run.unfit)
    noticed = fit - len(run.survivors)
    run.say(f"\n{noticed} of {fit} were noticed: {noticed / fit:.0%}; {len(run.unfit)} could not be put in. Survivors:")
    for mutant in run.survivors:
        run.say(f"  {mutant}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
