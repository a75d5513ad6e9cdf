"""What editors wait for: `rcyaml lsp`, and yaml-language-server on the same files in the same run.

    python benchmarks/editors.py [RUNS] [--page]

Both servers are processes that are asked as an editor asks them. CPU is that of the process and all its threads, from
the notification until the answer; wall time is that on this machine, which may do other things. yaml-language-server
is used if the tests of editors have installed it. `--page` writes docs/performance.md.
"""

from __future__ import annotations

import os
import queue
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from living import LINES, long_interfaces, workspace
from run import RCYAML

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from editor.yaml_language_server import LanguageServer  # noqa: E402

PAGE = ROOT / "docs/performance.md"
SMALL, LARGE = 300, 10_000
MISTAKE = "nonsense: 1\n"
GOALS = {100: 60, 3_000: 150, 15_000: 400}
KINDS = {
    "an interface": "interfaces/Work3.idsl.yaml",
    "a component": "comp3/comp3.cdsl.yaml",
    "parameters": "comp3/comp3.pdsl.yaml",
    "values": "comp3/etc/config.yaml",
    "the deployment": "big.ddsl.yaml",
}


@dataclass(frozen=True)
class Row:
    """A figure with its goal. CPU in milliseconds, unless `unit` is another."""

    name: str
    goal: float
    unit: str = "ms"


START = Row("start", 1300)
OF_LINES = {lines: Row(f"a key in an interface of {lines:,} lines", GOALS[lines]) for lines in LINES}
OF_KINDS = {kind: Row(f"a key in {kind}, {SMALL} documents", 60) for kind in KINDS}
WHOLE = Row(f"all {SMALL} documents, after a key in one", 300)
COMPLETION = Row(f"the first completion, {SMALL} documents", 100)
FIRST = Row(f"first diagnostics, {LARGE:,} documents", 4000)
IN_LARGE = Row(f"a key in a component, {LARGE:,} documents", 100)
IN_DEPLOYMENT = Row(f"a key in a deployment of {LARGE // 4:,} processes", 100)
MEMORY = Row(f"memory, {LARGE:,} documents", 1024, "MiB")
ROWS = [START, *OF_LINES.values(), *OF_KINDS.values(), WHOLE, COMPLETION, FIRST, IN_LARGE, IN_DEPLOYMENT, MEMORY]


class Server(LanguageServer):
    TIMEOUT = 180.0

    def cpu(self) -> float:
        """Milliseconds of all threads until now."""
        tasks = Path(f"/proc/{self._process.pid}/task")
        return sum(int((one / "schedstat").read_text().split()[0]) for one in tasks.iterdir()) / 1e6

    def memory(self) -> float:
        status = Path(f"/proc/{self._process.pid}/status").read_text()
        return int(status.split("VmRSS:")[1].split()[0]) / 1024

    def change(self, path: Path, text: str, version: int) -> None:
        document = {"uri": path.as_uri(), "version": version}
        self._notify("textDocument/didChange", {"textDocument": document, "contentChanges": [{"text": text}]})

    def until(self, path: Path, *, has_mistake: bool) -> None:
        """Waits until the marks of a document have the mistake, or not."""
        while has_mistake != any("nonsense" in one["message"] for one in self.diagnostics(path)):
            pass

    def quiet(self) -> float:
        """Waits until nothing is done any more. Returns the CPU until then."""
        known, since = self.cpu(), time.monotonic()
        while time.monotonic() - since < 0.8:
            time.sleep(0.05)
            if (now := self.cpu()) > known + 1:
                known, since = now, time.monotonic()
        return known

    def drain(self, path: Path) -> None:
        marks: queue.Queue[Any] = self._diagnostics[path.as_uri()]
        while not marks.empty():
            marks.get_nowait()


Figures = dict[Row, tuple[float, float]]
"""CPU, or the figure in its own unit, and wall time."""


def keys(server: Server, path: Path, runs: int) -> tuple[float, float]:
    """The median CPU and wall time from a key to the marks, which come and go with it."""
    text, cpu, wall = path.read_text(), list[float](), list[float]()
    server.quiet()
    for number in range(1, runs + 1):
        server.drain(path)
        before, began = server.cpu(), time.monotonic()
        server.change(path, text + MISTAKE if number % 2 else text, number + 1)
        server.until(path, has_mistake=bool(number % 2))
        cpu.append(server.cpu() - before)
        wall.append((time.monotonic() - began) * 1000)
        server.quiet()
    server.change(path, text, runs + 2)
    return statistics.median(cpu), statistics.median(wall)


def opened(server: Server, path: Path) -> tuple[float, float]:
    before, began = server.cpu(), time.monotonic()
    server.open(path, path.read_text())
    server.diagnostics(path)
    return server.cpu() - before, (time.monotonic() - began) * 1000


def started(command: list[str], folder: Path) -> tuple[Server, tuple[float, float]]:
    began = time.monotonic()
    server = Server(command)
    server.start(folder, {}, {"schemaServer": "no"})  # both say what is wrong with the shape
    return server, (server.cpu(), (time.monotonic() - began) * 1000)


def measured(command: list[str], small: Path, large: Path, runs: int) -> Figures:
    """The figures of a server. The long documents are in a workspace of their own, beside the small one."""
    found: Figures = {}
    server, found[START] = started(command, small)
    for lines, row in OF_LINES.items():
        opened(server, path := small.with_name("long") / f"Long{lines}.idsl.yaml")
        found[row] = keys(server, path, runs)
        server.close(path)
    for kind, row in OF_KINDS.items():
        opened(server, path := small / KINDS[kind])
        found[row] = keys(server, path, runs)
        if kind == "a component":
            whole = []
            for number in range(3):
                before = server.quiet()
                server.change(path, f"# {number}\n{path.read_text()}", 100 + number)
                whole.append(server.quiet() - before)
            found[WHOLE] = statistics.median(whole), 0
            before, began = server.cpu(), time.monotonic()
            server.completion(path, path.read_text().replace("implements: [", "implements: [|"))
            found[COMPLETION] = server.cpu() - before, (time.monotonic() - began) * 1000
        server.close(path)
    server.stop()
    server, _ = started(command, large)
    found[FIRST] = opened(server, path := large / KINDS["a component"])
    server.quiet()
    found[IN_LARGE] = keys(server, path, runs)
    opened(server, path := large / KINDS["the deployment"])
    found[IN_DEPLOYMENT] = keys(server, path, max(runs // 3, 3))
    found[MEMORY] = server.memory(), 0
    server.stop()
    return found


def documents(folder: Path) -> tuple[Path, Path]:
    """Two workspaces, whose documents name the schemas for yaml-language-server."""
    small, large, long = folder / "small", folder / "large", folder / "long"
    long.mkdir()
    (long / "rcyaml.yaml").write_text("interfaces: [.]\n")
    for place, count in ((small, SMALL), (large, LARGE)):
        workspace(place, count)
    for lines in LINES:
        text = f"module: RoboCompLong{lines}\ninterfaces:\n{long_interfaces(lines)}\n"
        (long / f"Long{lines}.idsl.yaml").write_text(text)
    named = [*(long / f"Long{lines}.idsl.yaml" for lines in LINES)]
    named += [place / name for place in (small, large) for name in KINDS.values()]
    for path in named:
        kind = "config" if path.name == "config.yaml" else path.name.split(".")[-2]
        schema = (ROOT / f"schemas/{kind}.schema.json").as_uri()
        path.write_text(f"# yaml-language-server: $schema={schema}\n{path.read_text()}")
    return small, large


def beside() -> list[str]:
    """The command of yaml-language-server, if it is installed."""
    cache = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "rcyaml/editor-tests"
    found = sorted(cache.glob("*/node_modules/yaml-language-server/bin/yaml-language-server"))
    return ["node", str(found[-1]), "--stdio"] if found else []


def table(own: Figures, other: Figures) -> Iterator[str]:
    yield "| what | `rcyaml lsp` | goal | `rcyaml lsp`, wall | yaml-language-server | its wall |"
    yield "|---|---|---|---|---|---|"
    for row in ROWS:
        cells = [_cell(own.get(row, (0, 0))[0], row.unit), _cell(row.goal, row.unit), _cell(own.get(row, (0, 0))[1])]
        cells += [_cell(other.get(row, (0, 0))[0], row.unit), _cell(other.get(row, (0, 0))[1])]
        yield f"| {row.name} | {' | '.join(cells)} |"


def _cell(figure: float, unit: str = "ms") -> str:
    return f"{figure:,.0f} {unit}" if figure else "–"


TEXT = """\
# Performance

What editors wait for: processor time of the server from a key to its marks, as the median of {runs} keys, and the wall
time on a machine that does other things as well. yaml-language-server reads the same documents with the same schemas,
without `rcyaml lsp`. It knows one document at a time, so that its figures do not depend on the others.

Measured on {machine}, by `make bench` (`python benchmarks/editors.py {runs} --page`).

{table}

If the networks and components that a document names need more than 60 ms, such as in a deployment of thousands of
processes, a key shows what is wrong with the document by itself, and moves all other marks with their lines; the rest
follows when typing rests.

| more figures | |
|---|---|
| `python benchmarks/living.py` | the living analysis in a program, without the protocol |
| `python benchmarks/run.py` | start, check and compile, as ratios to a Python that starts |
| `python benchmarks/deployments.py` | reading, deriving and checking deployments of 250 to 1,000 components |
| `python benchmarks/building.py`, `calls.py`, `talking.py`, `values.py` | builds, calls, talking to networks, values |
"""


def machine() -> str:
    return (
        f"{os.cpu_count()} cores of a shared machine, Linux, Python {sys.version_info.major}.{sys.version_info.minor}"
    )


def main() -> None:
    runs = next((int(one) for one in sys.argv[1:] if one.isdigit()), 30)
    with tempfile.TemporaryDirectory(prefix="rcyaml-") as name:
        small, large = documents(Path(name))
        own = measured([*RCYAML, "lsp"], small, large, runs)
        other = measured(beside(), small, large, runs) if beside() else {}
    text = "\n".join(table(own, other))
    print(text)
    if "--page" in sys.argv:
        PAGE.write_text(TEXT.format(runs=runs, machine=machine(), table=text))


if __name__ == "__main__":
    main()
