"""The benchmarks: whole processes, which alternate with what they are compared with, reported as ratios.

    make bench                  # or: python benchmarks/run.py [RUNS]

The floor of reading is a Python process that only composes the same documents with libyaml's C parser. The documents
are the migrated interfaces of the corpus beside the checkout, or, if it is missing, generated ones.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
CORPUS = HERE.parent.parent / "shared" / "corpus" / "idsl"
RCYAML = [str(Path(sys.executable).with_name("rcyaml"))]
FLOOR = """
import sys
from ruamel.yaml.cyaml import CSafeLoader
for path in sys.argv[1:]:
    with open(path, encoding="utf-8") as file:
        CSafeLoader(file.read()).get_single_node()
"""


@dataclass(frozen=True)
class Usage:
    """The CPU and wall-clock seconds of a process, and the peak of its memory in MiB."""

    cpu: float
    wall: float
    memory: float


@contextmanager
def working_folder() -> Iterator[str]:
    """A folder for a benchmark that deploys something. However the benchmark ends, also by SIGTERM, nothing of it runs
    afterwards, and the folder is gone."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    with tempfile.TemporaryDirectory() as name:
        root = str(Path(name).resolve())
        try:
            yield root
        finally:
            listed = subprocess.run([*RCYAML, "deploy", "ls", "--format", "json"], stdout=subprocess.PIPE).stdout
            for one in json.loads(listed)["deployments"]:
                if one["document"].startswith(f"{root}/"):
                    subprocess.run([*RCYAML, "deploy", "down", one["document"]], stdout=subprocess.DEVNULL)


def measure(command: list[str], fresh: Path | None = None) -> Usage:
    """The usage of one run of a command; the folder `fresh` is deleted before."""
    if fresh is not None:
        shutil.rmtree(fresh, ignore_errors=True)
    start = os.times().elapsed
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, used = os.wait4(process.pid, 0)
    wall = os.times().elapsed - start
    return Usage(used.ru_utime + used.ru_stime, wall, used.ru_maxrss / 1024)


def compare(
    label: str, command: list[str], other: list[str], goal: str, runs: int,
    fresh: Path | None = None, other_fresh: Path | None = None,
) -> None:  # fmt: skip
    """Runs both commands alternately, after a warm-up; prints the median of the pairs' ratios."""
    measure(command, fresh), measure(other, other_fresh)
    pairs = [(measure(command, fresh), measure(other, other_fresh)) for _ in range(runs)]
    cpu = statistics.median(one.cpu / two.cpu for one, two in pairs)
    low, high = min(one.cpu / two.cpu for one, two in pairs), max(one.cpu / two.cpu for one, two in pairs)
    seconds = statistics.median(one.cpu for one, _ in pairs)
    memory = max(one.memory for one, _ in pairs)
    print(f"{label:<44} {cpu:6.2f} ({low:.2f}–{high:.2f})  goal {goal:<8} {seconds:7.3f} s cpu {memory:6.0f} MiB")


def generated(folder: Path, modules: int, interfaces: int) -> Path:
    """A folder of `modules` documents with `interfaces` interfaces each; each imports the previous one."""
    folder.mkdir(parents=True)
    for m in range(modules):
        lines = [f"module: RoboCompGen{m}", f"imports: [Gen{m - 1}]" if m else "imports: []", "types:"]
        lines += ["  Pose: {struct: {x: float, y: float, z: float}}", "  Path: {sequence: Pose}", "interfaces:"]
        for i in range(interfaces):
            lines += [f"  I{m}x{i}:", "    methods:", f"      get{i}: {{in: {{path: Path, n: int}}, returns: Pose}}"]
            lines += [f"      stop{i}:"]
        (folder / f"Gen{m}.idsl.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


def documents(work: Path) -> Path:
    """A folder of documents without errors."""
    if not CORPUS.is_dir():
        return generated(work / "generated", 140, 3)
    folder = work / "corpus"
    subprocess.run([*RCYAML, "-q", "migrate", str(CORPUS), "-o", str(folder)], stdout=subprocess.DEVNULL)
    found = subprocess.run([*RCYAML, "check", "--format", "json", str(folder)], capture_output=True, text=True)
    import json

    for diagnostic in json.loads(found.stdout)["diagnostics"]:
        if diagnostic["severity"] == "error":
            Path(diagnostic["file"]).unlink(missing_ok=True)
    return folder


def component(folder: Path, language: str) -> Path:
    folder.mkdir(parents=True)
    (folder / "Speech.idsl.yaml").write_text(
        "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}, returns: bool}\n"
        "topics:\n  SpeechEvents:\n    methods:\n      spoken: {in: {text: string}}\n", encoding="utf-8",
    )  # fmt: skip
    (folder / "speech.cdsl.yaml").write_text(
        f"component: SpeechComp\nlanguage: {language}\nimports: [Speech]\nimplements: [Speech]\n"
        "publishes: [SpeechEvents]\n", encoding="utf-8",
    )  # fmt: skip
    return folder


def main(runs: int) -> None:
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # the warm-up writes the bytecode that an installed rcyaml has
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        docs = documents(work)
        paths = sorted(str(path) for path in docs.rglob("*.idsl.yaml"))
        floor = [sys.executable, "-c", FLOOR, *paths]
        print(f"{len(paths)} documents, {runs} runs of each in turn; ratios of processor time: median (min–max)\n")
        compare(
            "rcyaml --help / python -c 'import click'",
            [*RCYAML, "--help"],
            [sys.executable, "-c", "import click"],
            "1.5",
            runs,
        )
        compare("check / floor", [*RCYAML, "check", str(docs)], floor, "4", runs)
        out = work / "out"
        compile_ = [*RCYAML, "compile", str(docs), "-o", str(out)]
        compare("compile, cold / floor", compile_, floor, "4", runs, out)
        subprocess.run(compile_, stdout=subprocess.DEVNULL)
        compare("compile, nothing to do / floor", compile_, floor, "1.3", runs)
        small, large = generated(work / "g1", 100, 10), generated(work / "g10", 1000, 10)
        compare(
            "compile, 10,000 interfaces / 1,000",
            [*RCYAML, "compile", str(large), "-o", str(work / "o10")],
            [*RCYAML, "compile", str(small), "-o", str(work / "o1")],
            "10",
            3,
            work / "o10",
            work / "o1",
        )
        for language in ("python", "cpp"):
            source = component(work / language, language)
            target = work / f"{language}-out"
            compare(
                f"one {language} component, cold / python",
                [*RCYAML, "compile", str(source), "-o", str(target)],
                [sys.executable, "-c", "pass"],
                "0.25 s",
                runs,
                target,
            )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 7)
