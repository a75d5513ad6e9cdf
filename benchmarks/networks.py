"""What running networks cost, and when they notice what does not work.

    python benchmarks/networks.py [SECONDS]

CPU times in seconds, or as a part of a core over SECONDS (30); memory as PSS (each shared page is divided among those
that share it); times until something is noticed are wall-clock times. The engine icegrid is measured on this machine:
what runs there beside the registry, the keeper and the node is what runs on another host beside its node. The load is
small servers of Ice (g++ and Ice for C++), and a component in Python that is halted or blocks its worker.
"""

from __future__ import annotations

import os
import resource
import shutil
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from deploy import COUNT, document, rcyaml
from deploy_icegrid import servers
from robocomp_yaml.deploy.local import procfs
from run import working_folder

ENGINES = ("local", "icegrid")
MANY = 200
FEW = 8
WORKER = """\
import os, time
from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def compute(self):
        while os.path.exists(os.environ["BLOCK"]):
            time.sleep(0.1)
"""
ALIVE = "alive: {every: 5 s}\n"


def own(folder: str) -> dict[int, str]:
    """The pids of what rcyaml itself runs for a deployment, with what each is."""
    found: dict[int, str] = {}
    for pid in procfs.pids():
        words = procfs.command(pid)
        line = " ".join(words)
        if folder not in line and not procfs.mark_of(pid).startswith(f"{folder}:"):
            continue
        kind = next((kind for kind, mark in (
            ("registry", "icegridregistry"), ("node", "icegridnode"), ("keeper", "icegrid.keeper"),
            ("run", "/run "), ("guard", "guard"), ("watch", "/watch"), ("supervisor", "deploy.local"),
        ) if mark in line), "")  # fmt: skip
        if kind:
            found[pid] = kind
    return found


def pss(pid: int) -> float:
    """In MiB."""
    try:
        with open(f"/proc/{pid}/smaps_rollup", encoding="ascii") as file:
            return next(int(line.split()[1]) for line in file if line.startswith("Pss:")) / 1024
    except (OSError, StopIteration):
        return 0.0


def by_kind(pids: dict[int, str]) -> dict[str, float]:
    found: dict[str, float] = {}
    for pid, kind in pids.items():
        found[kind] = found.get(kind, 0.0) + pss(pid)
    return found


def cpu(pids: dict[int, str]) -> float:
    """Seconds, also of children that have ended. The kernel's ticks would miss what works for less than a tick."""
    ticks = os.sysconf("SC_CLK_TCK")
    total = 0.0
    for pid in pids:
        try:
            fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()
            times = [path.read_text(encoding="ascii") for path in Path(f"/proc/{pid}/task").glob("*/schedstat")]
        except OSError:
            continue
        total += sum(int(field) for field in fields[13:15]) / ticks + sum(int(time.split()[0]) for time in times) / 1e9
    return total


@contextmanager
def up(path: Path, engine: str) -> Iterator[str]:
    folder = str(path.parent / ".rcyaml/deployments/Many")
    shutil.rmtree(path.parent / ".rcyaml", ignore_errors=True)
    rcyaml("deploy", "up", "--engine", engine, path)
    try:
        yield folder
    finally:
        rcyaml("deploy", "down", "--engine", engine, path)


def nothing_to_do(root: Path) -> None:
    many = document(root / "many.ddsl.yaml", MANY, MANY)
    with up(many, "local"):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        rcyaml("deploy", "up", many)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"up, nothing to do, {MANY} processes: {used:.2f} s of CPU; goal: 0.5 s")


def at_rest(root: Path, seconds: float) -> None:
    load = servers(root)
    if load is None:
        print("Ice servers cannot be built: g++ or Ice for C++ is missing (Debian: libzeroc-ice-dev)")
        return
    text = load.document.read_text(encoding="utf-8")
    for engine in ENGINES:
        used = {}
        for alive in ("off", "on"):
            load.document.write_text(text + (ALIVE if alive == "on" else "alive: off\n"), encoding="utf-8")
            with up(load.document, engine) as folder:
                time.sleep(3)
                pids = own(folder)
                before = cpu(pids)
                time.sleep(seconds)
                used[alive] = (cpu(pids) - before) / seconds
                memory = by_kind(pids)
        print(f"liveness of {COUNT} processes, {engine}: {100 * (used['on'] - used['off']):.2f} % of a core "
              f"(at rest without it {100 * used['off']:.2f} %); goal: 1 %")  # fmt: skip
        tell_memory(engine, COUNT, memory)
    load.document.write_text(text.replace(f"instances: {COUNT}", f"instances: {FEW}"), encoding="utf-8")
    for engine in ENGINES:
        with up(load.document, engine) as folder:
            time.sleep(3)
            tell_memory(engine, FEW, by_kind(own(folder)))


def tell_memory(engine: str, count: int, memory: dict[str, float]) -> None:
    parts = ", ".join(f"{kind} {size:.1f}" for kind, size in sorted(memory.items()))
    own_part = sum(size for kind, size in memory.items() if kind != "run")
    print(f"memory of rcyaml, {engine}, {count} processes: {sum(memory.values()):.1f} MiB ({parts}); goal: 70 MiB"
          + (f" and 1 MiB a process; without that {own_part:.1f} MiB" if engine == "icegrid" else ""))  # fmt: skip
    if engine == "icegrid":
        guards = memory.get("guard", 0.0) / 2  # one beside the registry, one beside the node
        more = guards + memory.get("run", 0.0) + memory.get("watch", 0.0)
        print(f"  on another host, beside icegridnode: {more:.1f} MiB; goal: {10 + count} MiB")


def noticed(root: Path) -> None:
    (root / "eye" / "src").mkdir(parents=True)
    (root / "eye" / "eye.cdsl.yaml").write_text("component: Eye\nlanguage: python\nperiod: 500 ms\n")
    (root / "eye" / "src" / "specificworker.py").write_text(WORKER)
    block = root / "block"
    path = root / "one.ddsl.yaml"
    path.write_text(f"deployment: Many\ncomponents:\n  eye: {{component: eye, env: {{BLOCK: {block}}}}}\n")
    rcyaml("-q", "compile", path)
    for engine in ENGINES:
        for what in ("halted", "worker blocked"):
            with up(path, engine) as folder:
                time.sleep(6)
                log, pid = Path(folder, "logs", "eye.log"), 0
                for one in procfs.marked(folder):
                    entry = procfs.entry(one)
                    if entry and entry.group == one and procfs.mark_of(one).endswith(":eye"):
                        pid = one
                began = time.monotonic()
                if what == "halted":
                    os.kill(pid, signal.SIGSTOP)
                else:
                    block.touch()
                while "not alive" not in log.read_text() and time.monotonic() < began + 60:
                    time.sleep(0.05)
                took = time.monotonic() - began
                block.unlink(missing_ok=True)
                print(f"{what}, {engine}: noticed after {took:.1f} s; goal: {12 if what == 'halted' else 20} s")


def main(seconds: float) -> None:
    with working_folder() as name:
        root = Path(name).resolve()
        for folder in ("many", "eye"):
            (root / folder).mkdir()
        nothing_to_do(root / "many")
        at_rest(root / "servers", seconds)
        noticed(root / "eye")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 30)
