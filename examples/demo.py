"""The whole workflow with the examples, as a user would type it: migrate, check, compile, deploy, call.

Works on a copy of the examples in `.demo/`. Run it with `make demo`. The exit code is 1 if the network cannot be
started because Ice is missing.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
DEMO = HERE.parent / ".demo"
NETWORK = "head.ddsl.yaml"
TEXT = "I am up and running"
BOLD, DIM, PLAIN = ("\x1b[1m", "\x1b[2m", "\x1b[0m") if sys.stdout.isatty() else ("", "", "")
# As in an active virtual environment, this Python is the first on the path: components use it if it has Ice.
ENVIRONMENT = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}


def say(text: str) -> None:
    print(text, flush=True)


def comment(text: str) -> None:
    say(f"\n{DIM}# {text}{PLAIN}")


def run(*words: str) -> None:
    """Runs a command in the copy, and shows the command and its output."""
    say(f"{BOLD}$ {' '.join(word if word.isalnum() else quoted(word) for word in words)}{PLAIN}")
    colors = ["--color", "always" if sys.stdout.isatty() else "never"]
    command = [sys.executable, "-m", "robocomp_yaml", *colors, *words[1:]] if words[0] == "rcyaml" else words
    subprocess.run(command, cwd=DEMO, check=True, env=ENVIRONMENT)


def quoted(word: str) -> str:
    return f"'{word}'" if set(word) & set(" :") else word


def asked(*words: str) -> dict[str, Any]:
    """The JSON output of `rcyaml deploy`, without showing it."""
    done = subprocess.run(
        [sys.executable, "-m", "robocomp_yaml", "deploy", *words, "--format", "json"],
        cwd=DEMO, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer


def runs_here() -> bool:
    """Whether this machine has what the components need: Ice."""
    return all(not one["missing"] for found in asked("probe", NETWORK)["hosts"].values() for one in found)


def proxy_of(interface: str) -> str:
    """The proxy of an interface in the running network. Raises LookupError if no process serves it."""
    for process in asked("status", NETWORK)["processes"]:
        for served in process["endpoints"]:
            if served["interface"] == interface:
                return f"{served['identity']}:{served['endpoint']}"
    raise LookupError(f"nobody serves {interface}")


def main() -> int:
    if (DEMO / NETWORK).is_file():
        asked("down", NETWORK)  # the network of a demo that was killed
    shutil.rmtree(DEMO, ignore_errors=True)
    shutil.copytree(HERE, DEMO, ignore=shutil.ignore_patterns("demo.py", "cpp", "__pycache__"))
    comment(f"A robot's head, copied to {DEMO.name}/: two components as legacy files, and one as YAML.")
    run("rcyaml", "migrate", "talkinghead")
    run("cat", "talkinghead/components/speech/speechcomp.cdsl.yaml")
    comment("Compile all of it to Slice, and to components that run.")
    run("rcyaml", "compile", "talkinghead", "jointmotor")
    run("rcyaml", "check")
    comment("The network: processes, interfaces and connections.")
    run("rcyaml", "graph", NETWORK)
    if not runs_here():
        say("")
        subprocess.run([sys.executable, HERE.parent / "tools" / "prepare.py", "advise"], check=True)
        return 1
    comment("Each process is started as soon as those that it needs are ready.")
    try:
        run("rcyaml", "deploy", "up", NETWORK)
        comment("A call from outside, over Ice.")
        run("python3", "say.py", proxy_of("Speech"), TEXT)
        run("rcyaml", "deploy", "status", NETWORK)
        run("rcyaml", "deploy", "logs", "-n", "6", NETWORK)
    finally:
        comment("All processes are stopped in order.")
        run("rcyaml", "deploy", "down", NETWORK)
    comment(f"{DEMO.name}/ contains all of it. For your own robot: `.venv/bin/rcyaml new --help`, and the README.")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except subprocess.CalledProcessError as failure:
        sys.exit(f"\nThe demo ends here: a command failed (exit code {failure.returncode}); see its output above.")
    except KeyboardInterrupt:
        sys.exit(130)
