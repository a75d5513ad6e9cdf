"""`make fuzz`: all random tests with new examples, again and again until the time is over.

    python tests/fuzz/run.py [--minutes 10] [--jobs 2] [WORD …]

Words choose the test files whose names hold one of them. Each file is run with a seed of its own; a find is printed at
once, and at the end with the command that shows it again. Exit code 1 where something was found.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOUND = ROOT / ".fuzz"
SELDOM = ("test_verdicts_cpp.py",)  # its cases are one program, which takes a minute to build
_FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+?::\S+)(?: - (.*))?$", re.MULTILINE)
_PASSED = re.compile(r"\b(\d+) passed")


def harnesses(words: list[str]) -> list[Path]:
    """Every test file that asks Hypothesis for examples; ours first."""
    found = [
        path for path in sorted((ROOT / "tests").rglob("test_*.py")) if "@given" in path.read_text(encoding="utf-8")
    ]
    found = [path for path in found if not words or any(word in path.name for word in words)]
    return sorted(found, key=lambda path: path.parent != ROOT / "tests" / "fuzz")


def weight(path: Path) -> float:
    """How many turns a file has where most have one."""
    return 0.2 if path.name in SELDOM else 3 if path.parent.name == "fuzz" else 1


@dataclass
class Run:
    """What was done, and what was found: by test, the command that shows it, and where its output is."""

    files: list[Path]
    until: float
    started: float = field(default_factory=time.monotonic)
    finds: dict[str, tuple[str, Path]] = field(default_factory=dict)
    rounds: dict[Path, int] = field(default_factory=dict)
    passed: int = 0
    lock: threading.Lock = field(default_factory=threading.Lock)

    def next(self) -> Path | None:
        """The file that had the fewest turns for its weight."""
        with self.lock:
            if time.monotonic() >= self.until:
                return None
            path = min(self.files, key=lambda path: (self.rounds.get(path, 0) / weight(path), path.name in SELDOM))
            self.rounds[path] = self.rounds.get(path, 0) + 1
            return path

    def work(self) -> None:
        while (path := self.next()) is not None:
            self.turn(path, random.SystemRandom().randrange(2**32))

    def turn(self, path: Path, seed: int) -> None:
        name = path.relative_to(ROOT)
        command = [sys.executable, "-m", "pytest", str(name), "-q", "-n", "0", "-p", "no:cacheprovider",
                   f"--hypothesis-seed={seed}"]  # fmt: skip
        process = subprocess.Popen(
            command, cwd=ROOT, env={**os.environ, "RCYAML_FUZZ": "1"}, start_new_session=True, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="backslashreplace",
        )  # fmt: skip
        try:
            output, _ = process.communicate(timeout=max(self.until - time.monotonic(), 1))
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGINT)
            try:
                output, _ = process.communicate(timeout=20)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                output, _ = process.communicate()
        self.tell(name, seed, output, process.returncode)

    def tell(self, name: Path, seed: int, output: str, code: int) -> None:
        failed = _FAILED.findall(output)
        if not failed and code not in (0, 2, 5, -signal.SIGINT, -signal.SIGKILL):
            failed = [(str(name), f"pytest ended with {code}")]
        passed = int(match[1]) if (match := _PASSED.search(output)) else 0
        with self.lock:
            self.passed += passed
            minutes = (time.monotonic() - self.started) / 60
            what = f"{len(failed)} FAILED" if failed else f"{passed} passed" if code in (0, 5) else "cut short"
            print(f"{minutes:5.1f} min  {name}  seed {seed}: {what}", flush=True)
            for test, why in failed:
                if test in self.finds:
                    continue
                log = FOUND / f"{re.sub(r'[^A-Za-z0-9_]+', '-', test)}.txt"
                log.parent.mkdir(exist_ok=True)
                log.write_text(output, encoding="utf-8", errors="backslashreplace")
                self.finds[test] = (
                    f"RCYAML_FUZZ=1 {sys.executable} -m pytest '{test}' -n 0 --hypothesis-seed={seed}",
                    log,
                )
                print(f"           found: {test}: {why}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(prog="make fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("words", nargs="*", metavar="WORD")
    given = parser.parse_args()
    run = Run(harnesses(given.words), time.monotonic() + given.minutes * 60)
    if not run.files:
        parser.error("no test file is called so")
    print(f"{len(run.files)} files of random tests, for {given.minutes:g} minutes", flush=True)
    workers = [threading.Thread(target=run.work) for _ in range(given.jobs)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    print(f"\n{sum(run.rounds.values())} runs of {len(run.rounds)} files, {run.passed} tests passed")
    for test, (command, log) in run.finds.items():
        print(f"\nfound: {test}\n  its output: {log.relative_to(ROOT)}\n  again: {command}")
    if not run.finds:
        print("nothing was found")
    return 1 if run.finds else 0


if __name__ == "__main__":
    sys.exit(main())
