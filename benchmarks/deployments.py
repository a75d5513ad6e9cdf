"""Deployments: CPU seconds for reading, deriving and checking a document of 500 components, and whether the time is
linear in the number of components.

    python benchmarks/deployments.py [RUNS]
"""

from __future__ import annotations

import statistics
import sys
import tempfile
from pathlib import Path

from run import RCYAML, measure

SIZES = (250, 500, 1000)
GOAL = 1.5  # seconds, for 500
KINDS = 10
INTERFACE = """\
module: RoboCompWork
interfaces:
  Work: {methods: {carryOut: {in: {what: string, times: int}, returns: bool}}}
topics:
  Done: {methods: {finished: {in: {what: string}}}}
"""


def deployment(folder: Path, size: int) -> Path:
    """A chain of `size` components of ten kinds on four hosts, each with a topic and a value of its own."""
    folder.mkdir(parents=True)
    (folder / "Work.idsl.yaml").write_text(INTERFACE)
    for kind in range(KINDS):
        home = folder / f"kind{kind}"
        (home / "etc").mkdir(parents=True)
        (home / "bin").mkdir()
        (home / "bin" / f"Kind{kind}").symlink_to("/bin/true")
        (home / f"kind{kind}.cdsl.yaml").write_text(
            f"component: Kind{kind}\nlanguage: python\nimports: [../Work]\nimplements: [Work]\n"
            "requires: [{Next: Work}]\npublishes: [Done]\n"
        )
        (home / f"kind{kind}.pdsl.yaml").write_text(
            f"component: kind{kind}.cdsl.yaml\nparameters:\n  speed: {{type: float, range: [0, 2], default: 1}}\n"
            "  device: string\n  gains: {list: float, default: [1, 2, 3]}\n"
        )
        (home / "etc/config.yaml").write_text(
            f"component: ../kind{kind}.cdsl.yaml\nparameters: {{device: /dev/null}}\n"
        )
    hosts = ", ".join(f"h{number}: 10.0.0.{number + 2}" for number in range(4))
    lines = [f"deployment: Big\nhosts: {{{hosts}}}\nservices: {{storm: {{icestorm: {{host: h0}}}}}}\ncomponents:"]
    for number in range(size):
        following = f"c{number + 1}" if number + 1 < size else '"work:tcp -h 10.0.0.99 -p 10000"'
        lines.append(
            f"  c{number}: {{component: kind{number % KINDS}, host: h{number % 4}, connect: {{Next: {following}}}, "
            "set: {speed: 1.5}}"
        )
    document = folder / "big.ddsl.yaml"
    document.write_text("\n".join(lines) + "\n")
    return document


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    with tempfile.TemporaryDirectory(prefix="rcyaml-") as name:
        documents = {size: deployment(Path(name) / str(size), size) for size in SIZES}
        took = {}
        for size, document in documents.items():
            command = [*RCYAML, "check", str(document)]
            measure(command)
            took[size] = statistics.median(measure(command).cpu for _ in range(runs))
    for size, seconds in took.items():
        goal = f"  (goal: {GOAL} s)" if size == 500 else ""
        print(f"check of {size:5} components: {seconds:.2f} s of processor time{goal}")
    first, last = SIZES[0], SIZES[-1]
    print(f"{last // first} times as many take {took[last] / took[first]:.1f} times as long")


if __name__ == "__main__":
    main()
