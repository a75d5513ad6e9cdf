"""The living analysis: CPU milliseconds from an edit to its diagnostics, in workspaces of different sizes.

    python benchmarks/living.py [RUNS] [DOCUMENTS …]

A workspace has one interface, one component, its parameters and its values for each four documents, and a deployment
of all components. An edit changes one document of the overlay, as a key in an editor does. `document` is the time to
the diagnostics of the document and of what it names, `workspace` the time to the diagnostics of all.
"""

from __future__ import annotations

import gc
import os
import resource
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from robocomp_yaml import api

INTERFACE = """\
# an interface
module: RoboCompWork{n}
types:
  Pose: {{struct: {{x: float, y: float, angle: float}}}}
interfaces:
  Work{n}: {{methods: {{carryOut: {{in: {{what: string, at: Pose}}, returns: bool}}}}}}
topics:
  Done{n}: {{methods: {{finished: {{in: {{what: string}}}}}}}}
"""
COMPONENT = """\
# a component
component: Comp{n}
language: python
imports: [../interfaces/Work{n}, ../interfaces/Work{m}]
implements: [Work{n}]
requires: {required}
publishes: [Done{n}]
"""
PARAMETERS = """\
# its parameters
component: comp{n}.cdsl.yaml
parameters:
  speed: {{type: float, range: [0, 2], default: 1}}
  device: string
  camera: {{group: {{width: {{type: int, default: 640}}, height: {{type: int, default: 480}}}}}}
  gains: {{list: float, default: [1, 2, 3]}}
"""
VALUES = """\
# its values
component: ../comp{n}.cdsl.yaml
parameters: {{device: /dev/null, speed: 1.5}}
"""


def workspace(folder: Path, documents: int) -> Path:
    """Writes a workspace of about so many documents; returns its deployment."""
    count = documents // 4
    (folder / "interfaces").mkdir(parents=True)
    (folder / "rcyaml.yaml").write_text("interfaces: [interfaces]\n")
    lines = ["# a deployment", "deployment: Big", "hosts: {left: 10.0.0.2, right: 10.0.0.3}"]
    lines += ["services: {storm: {icestorm: {host: left}}}", "components:"]
    for n in range(count):
        home = folder / f"comp{n}"
        (home / "etc").mkdir(parents=True)
        last = n + 1 == count
        names = {"n": n, "m": n - 1 if last else n + 1, "required": "[]" if last else f"[Work{n + 1}]"}
        (folder / f"interfaces/Work{n}.idsl.yaml").write_text(INTERFACE.format(**names))
        (home / f"comp{n}.cdsl.yaml").write_text(COMPONENT.format(**names))
        (home / f"comp{n}.pdsl.yaml").write_text(PARAMETERS.format(**names))
        (home / "etc/config.yaml").write_text(VALUES.format(**names))
        host = "left" if n % 2 else "right"
        lines.append(f"  c{n}: {{component: comp{n}, host: {host}, set: {{speed: 0.5}}}}")
    document = folder / "big.ddsl.yaml"
    document.write_text("\n".join(lines) + "\n")
    return document


KINDS = {
    "interface": "interfaces/Work3.idsl.yaml",
    "component": "comp3/comp3.cdsl.yaml",
    "parameters": "comp3/comp3.pdsl.yaml",
    "values": "comp3/etc/config.yaml",
    "deployment": "big.ddsl.yaml",
}
LINES = (100, 3_000, 15_000)


def cpu(function: Callable[[], object]) -> float:
    """CPU milliseconds of a call."""
    before = time.process_time()
    function()
    return (time.process_time() - before) * 1000


def edits(living: api.LivingWorkspace, path: str, runs: int, look: Callable[[], api.Workspace]) -> list[float]:
    """CPU milliseconds from each of several edits of a document to the diagnostics."""
    text, took = Path(path).read_text(), []
    for number in range(runs):
        living.edit(path, text.replace("# ", f"# {number} ", 1))
        took.append(cpu(lambda: look().check()))
        gc.collect()
    living.edit(path, None)
    return took


def of_workspace(documents: int, runs: int) -> None:
    """Edits in a workspace of so many documents. Each begins in a process of its own, with no memory."""
    workspace(Path(), documents)
    living = api.follow()
    print(
        f"{documents} documents: first diagnostics {cpu(lambda: living.look(KINDS['component']).check()):.0f} ms",
        end="",
    )
    print(f", of all {cpu(lambda: living.load().check()):.0f} ms")
    at_rest()
    for kind, path in KINDS.items():
        one = statistics.median(edits(living, path, runs, lambda path=path: living.look(path)))
        whole = statistics.median(edits(living, path, max(runs // 3, 1), living.load))
        print(f"  {kind:<11} document {one:6.1f} ms   workspace {whole:6.1f} ms")
    print(f"  {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


def of_lines(runs: int) -> None:
    """Edits in one long document of each kind."""
    for lines in LINES:
        entries = "\n".join(f"  c{n}: {{program: sh, args: [-c, 'sleep {n}']}}" for n in range(lines))
        parameters = "\n".join(f"  p{n}: {{type: float, range: [0, 2], default: 1}}" for n in range(lines))
        for path, text in {
            "Long.idsl.yaml": f"# long\nmodule: RoboCompLong\ninterfaces:\n{long_interfaces(lines)}\n",
            "long.pdsl.yaml": f"# long\nparameters:\n{parameters}\n",
            "long.ddsl.yaml": f"# long\ndeployment: Long\ncomponents:\n{entries}\n",
        }.items():
            Path(path).write_text(text)
            living = api.follow()
            living.look(path).check()
            at_rest()
            took = edits(living, path, max(runs // 3, 3), lambda path=path, living=living: living.look(path))
            print(f"{lines:>6} lines  {path:<15} {statistics.median(took):6.1f} ms")
            Path(path).unlink()


def long_interfaces(lines: int) -> str:
    """The interfaces of a document of so many lines."""
    methods = "\n".join(f"      call{n}: {{in: {{a: int, b: string}}, returns: bool}}" for n in range(8))
    return "\n".join(f"  I{n}:\n    methods:\n{methods}" for n in range(lines // 10))


def at_rest() -> None:
    """What the language server does: the garbage collector runs when nothing is to be done, and need not visit the
    kept documents."""
    gc.disable()
    gc.collect()
    gc.freeze()


def main() -> None:
    runs, *sizes = [int(argument) for argument in sys.argv[1:]] or [30]
    tasks: list[Callable[[], None]] = [lambda size=size: of_workspace(size, runs) for size in sizes or (300, 10_000)]
    for task in [*tasks, lambda: of_lines(runs)]:
        process = os.fork()
        if process == 0:
            with tempfile.TemporaryDirectory(prefix="rcyaml-") as name:
                os.chdir(name)
                task()
                sys.stdout.flush()
                os.chdir("/")
            os._exit(0)
        os.waitpid(process, 0)


if __name__ == "__main__":
    main()
