"""Migrates the corpus of legacy files beside the checkout, and prints the result and the time for each format.

python benchmarks/migration.py
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections import Counter
from pathlib import Path

from run import CORPUS as INTERFACES
from run import RCYAML, measure

CORPUS = INTERFACES.parent
STATES = ("converted", "warned", "refused", "skipped")


def main() -> None:
    if not CORPUS.is_dir():
        sys.exit("the corpus beside the checkout is missing")
    states = "".join(f"{state:>11}" for state in STATES)
    print(f"{'format':<12}{'files':>6}{states}{'lines lost':>12}{'seconds':>9}{'MiB':>6}")
    folders = sorted(path for path in CORPUS.iterdir() if path.is_dir())
    with tempfile.TemporaryDirectory() as name:
        for source in (*folders, CORPUS):
            title = source.name if source != CORPUS else "all"
            report = Path(name) / f"{title}.json"
            used = measure([*RCYAML, "-q", "migrate", str(source), "-o", f"{name}/{title}", "--report", str(report)])
            files = json.loads(report.read_text(encoding="utf-8"))["files"]
            states = Counter(file["status"] for file in files)
            lost = sum(file["lines"]["lost"] for file in files)
            counts = "".join(f"{states[state]:>11}" for state in STATES)
            print(f"{title:<12}{len(files):>6}{counts}{lost:>12}{used.wall:>9.2f}{used.memory:>6.0f}")


if __name__ == "__main__":
    main()
