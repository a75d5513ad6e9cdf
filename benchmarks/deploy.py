"""Deployments: 50 small processes are started, left unchanged, killed and stopped; a document of 500 is planned.

    python benchmarks/deploy.py [RUNS]

Wall-clock times in seconds: median (min–max). The floor of an `up` is a Python process that only starts the same 50
programs, one after the other. Every process is ready after a tenth of a second.
"""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from robocomp_yaml.deploy.local import procfs
from run import RCYAML, working_folder

COUNT, LARGE, CRASHES = 50, 500, 20
FLOOR = f"import subprocess\nfor _ in range({COUNT}): subprocess.Popen(['true'])"


def document(path: Path, count: int, width: int) -> Path:
    """A document of `count` sleeping processes; each is after the one that precedes it by `width`."""
    lines = ["deployment: Many", "components:"]
    for number in range(count):
        after = f", after: [p{number - width}]" if number >= width else ""
        lines.append(f"  p{number}: {{program: sleep, args: ['1000']{after}}}")
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return path


def seconds(action: Callable[[], object]) -> float:
    began = time.perf_counter()
    action()
    return time.perf_counter() - began


def tell(what: str, samples: list[float], goal: str) -> None:
    median = statistics.median(samples)
    print(f"{what:<48} {median:6.2f} s ({min(samples):.2f}–{max(samples):.2f}), goal {goal}")


def rcyaml(*args: str | Path) -> None:
    subprocess.run([*RCYAML, *args], check=True, stdout=subprocess.DEVNULL)


def children(folder: str) -> dict[str, int]:
    """The processes of a deployment by their names."""
    return {procfs.mark_of(pid).rpartition(":")[2]: pid for pid in procfs.marked(folder)}


def back_after_kill(folder: str, name: str, pid: int) -> float:
    """Seconds from a process's death until its next run exists."""
    supervisor = procfs.entry(pid).parent  # type: ignore[union-attr]
    known = {one.pid for one in procfs.table().values() if one.parent == supervisor}

    def crash() -> None:
        os.kill(pid, signal.SIGKILL)
        while not [one for one in procfs.table().values() if one.parent == supervisor and one.pid not in known]:
            time.sleep(0.002)

    return seconds(crash)


def main(runs: int) -> None:
    with working_folder() as name:
        folder = str(Path(name).resolve() / ".rcyaml/deployments/Many")
        many = document(Path(name) / "many.ddsl.yaml", COUNT, COUNT)
        ups: list[float] = []
        again: list[float] = []
        downs: list[float] = []
        for run in range(runs):
            ups.append(seconds(lambda: rcyaml("deploy", "up", many)))
            again.append(seconds(lambda: rcyaml("deploy", "up", many)))
            if run < runs - 1:
                downs.append(seconds(lambda: rcyaml("deploy", "down", many)))
        running = children(folder)
        supervisors = [pid for pid in procfs.marked(folder) if procfs.mark_of(pid).endswith(":")]
        parts = sorted((procfs.memory([pid]) for pid in supervisors), reverse=True)
        crashes = [back_after_kill(folder, f"p{number}", running[f"p{number}"]) for number in range(CRASHES)]
        downs.append(seconds(lambda: rcyaml("deploy", "down", many)))
        tell(f"the floor: {COUNT} times Popen", [
            seconds(lambda: subprocess.run([sys.executable, "-c", FLOOR])) for _ in range(runs)
        ], "-")  # fmt: skip
        tell(f"up, {COUNT} processes side by side", ups, "IceGrid alone + 0.5 s")
        tell("up, nothing to do", again, "1 s")
        tell("down", downs, "-")
        tell(f"a crash until the next run, {CRASHES} times", crashes, "0.6 s")
        mebibytes = [size / (1 << 20) for size in parts]
        print(f"{'supervisor and keeper':<48} {sum(mebibytes):6.1f} MiB ({' + '.join(f'{m:.1f}' for m in mebibytes)}), "
              "goal 40 MiB")  # fmt: skip
        for count in (LARGE // 2, LARGE):
            large = document(Path(name) / f"large{count}.ddsl.yaml", count, 50)
            plans = [seconds(lambda: rcyaml("deploy", "plan", large)) for _ in range(runs)]  # noqa: B023
            tell(f"check and plan, {count} processes", plans, "1.5 s for 500, linear")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
