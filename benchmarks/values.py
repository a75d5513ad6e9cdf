"""Values: checking a document of 5,000 records, as ratios, and compiling a 350-line PDSL.

    python benchmarks/values.py [RUNS]

The floor is a Python process that only composes the same document with libyaml's C parser.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from run import FLOOR, RCYAML, compare, measure

RECORDS = 5000
TYPES = """types:
  Motor:
    struct:
      name: string
      id: string
      invertedSign: {type: bool, default: false}
      min: {type: float, range: [-3.15, 3.15], unit: rad}
      max: {type: float, range: [-3.15, 3.15], unit: rad}
      zero: {type: float, default: 0, unit: rad}
      vel: {type: float, range: [0, 2], default: 0.9, unit: rad/s}
"""


def records(folder: Path, *, complete: bool) -> Path:
    """A values document with RECORDS records; unless `complete`, each lacks one member with a default."""
    (folder / "etc").mkdir(parents=True)
    (folder / "c.cdsl.yaml").write_text("component: C\nlanguage: python\n")
    (folder / "c.pdsl.yaml").write_text(
        f"component: c.cdsl.yaml\n{TYPES}parameters:\n  motors: {{list: Motor}}\n"
        "constraints:\n  - all(m.min < m.max for m in motors)\n"
    )
    vel = ", vel: .9" if complete else ""
    rows = "".join(
        f"    - {{name: motor{n}, id: A{n}, invertedSign: true, min: -3.14, max: 3.14, zero: 0{vel}}}\n"
        for n in range(RECORDS)
    )
    document = folder / "etc/config.yaml"
    document.write_text(f"component: ../c.cdsl.yaml\nparameters:\n  motors:\n{rows}")
    return document


def long_pdsl(folder: Path, language: str) -> Path:
    """A component with a PDSL of 350 lines."""
    folder.mkdir(parents=True)
    (folder / "c.cdsl.yaml").write_text(f"component: C\nlanguage: {language}\n")
    lines = ["component: c.cdsl.yaml", *TYPES.splitlines(), "parameters:"]
    kinds = (
        "{{type: float, range: [0, 1], default: 0.5, unit: m, doc: Parameter {n}.}}",
        "{{type: int, default: {n}}}",
        "{{type: string, default: text{n}}}",
        "{{list: Motor, size: [0, 9], default: []}}",
        "{{list: {{list: float, size: 3}}, default: [[1, 0, 0]]}}",
        "{{group: {{on: {{type: bool, default: true}}}}}}",
    )
    while len(lines) < 350:
        n = len(lines)
        lines.append(f"  p{n}: " + kinds[n % len(kinds)].format(n=n))
    (folder / "c.pdsl.yaml").write_text("\n".join(lines) + "\n")
    return folder


def main(runs: int) -> None:
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        print(f"{RECORDS} records, {runs} runs of each in turn; ratios of processor time: median (min–max)\n")
        for complete, goal in ((True, "1.2"), (False, "1.6")):
            document = records(work / str(complete), complete=complete)
            floor = [sys.executable, "-c", FLOOR, str(document)]
            label = "check, nothing to fill in / floor" if complete else "check, 5,000 defaults / floor"
            compare(label, [*RCYAML, "config", "check", str(document)], floor, goal, runs)
        for language in ("python", "cpp"):
            folder = long_pdsl(work / language, language)
            out = work / f"{language}-out"
            command = [*RCYAML, "compile", str(folder), "-o", str(out)]
            best = min((measure(command, out) for _ in range(runs + 1)), key=lambda usage: usage.cpu)
            assert (out / "generated").is_dir(), "nothing was written"
            print(f"350-line PDSL to {language}, cold: {best.cpu:.3f} s cpu, {best.wall:.3f} s wall  goal 0.25 s")


if __name__ == "__main__":
    os.environ.pop("RCYAML_PATH", None)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a cold compilation uses rcyaml's own bytecode
    subprocess.run([*RCYAML, "--version"], stdout=subprocess.DEVNULL, check=True)
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
