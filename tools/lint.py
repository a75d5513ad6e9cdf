"""Static checks of the code: the rules and the format of ruff, the types of mypy, and the layers.

lint.py [NAME...]   all checks, or some: rules, format, types, layers; exit code 1 if one fails
lint.py --fix       sorts the imports, and formats the code
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RUFF = ("-m", "ruff")
CHECKS = {
    "rules": (*RUFF, "check", "--quiet", "--output-format", "concise"),
    "format": (*RUFF, "format", "--check", "--quiet", "--diff"),
    "types": ("-m", "mypy", "--no-error-summary"),
    "layers": ("-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports(no_cache=True))"),
}
FIXES = ((*RUFF, "check", "--quiet", "--fix", "--select", "I"), (*RUFF, "format", "--quiet"))


def main(*words: str) -> int:
    if words == ("--fix",):
        return max(run(arguments).returncode for arguments in FIXES)
    if unknown := set(words) - set(CHECKS):
        print(f"unknown: {', '.join(sorted(unknown))}; there are {', '.join(CHECKS)}", file=sys.stderr)
        return 2
    wrong = [name for name in words or CHECKS if not passes(name)]
    return 1 if wrong else 0


def passes(name: str) -> bool:
    done = run(CHECKS[name])
    if done.returncode:
        print(f"{name}:\n{done.stdout}{done.stderr}", flush=True)
    return done.returncode == 0


def run(arguments: tuple[str, ...]) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
