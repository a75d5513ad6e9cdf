"""The whole workflow with the examples, as a user would type it: migrate, check, compile, deploy, call, look.

Works on a copy of the examples in `.demo/`. Run it with `make demo`. The exit code is 1 if the network cannot be
started because Ice is missing.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from manager_picture import show
from session import Session, comment, ends, say

HERE = Path(__file__).resolve().parent
DEMO = HERE.parent / ".demo"
NETWORK = "head.ddsl.yaml"
FOLDERS = ("talkinghead", "jointmotor")
TEXT = "I am up and running"
session = Session(DEMO)


def runs_here() -> bool:
    """Whether this machine has what the components need: Ice."""
    hosts = session.answer("deploy", "probe", NETWORK)["hosts"]
    return all(not one["missing"] for found in hosts.values() for one in found)


def proxy_of(interface: str) -> str:
    """The proxy of an interface in the running network. Raises LookupError if no process serves it."""
    for process in session.answer("deploy", "status", NETWORK)["processes"]:
        for served in process["endpoints"]:
            if served["interface"] == interface:
                return f"{served['identity']}:{served['endpoint']}"
    raise LookupError(f"nobody serves {interface}")


def main() -> int:
    if (DEMO / NETWORK).is_file():
        session.answer("deploy", "down", NETWORK)  # the network of a demo that was killed
    shutil.rmtree(DEMO, ignore_errors=True)
    DEMO.mkdir()
    for name in FOLDERS:
        shutil.copytree(HERE / name, DEMO / name, ignore=shutil.ignore_patterns("cpp", "__pycache__"))
    for name in (NETWORK, "say.py"):
        shutil.copy(HERE / name, DEMO)
    comment(f"A robot's head, copied to {DEMO.name}/: two components as legacy files, and one as YAML.")
    session.run("rcyaml", "migrate", "talkinghead")
    session.run("cat", "talkinghead/components/speech/speechcomp.cdsl.yaml")
    comment("Compile all of it to Slice, and to components that run.")
    session.run("rcyaml", "compile", "talkinghead", "jointmotor")
    session.run("rcyaml", "check")
    comment("The network: processes, interfaces and connections.")
    session.run("rcyaml", "graph", NETWORK)
    if not runs_here():
        say("")
        subprocess.run([sys.executable, HERE.parent / "tools" / "prepare.py", "advise"], check=True)
        return 1
    comment("Each process is started as soon as those that it needs are ready.")
    try:
        session.run("rcyaml", "deploy", "up", NETWORK)
        comment("A call from outside, over Ice.")
        session.run("python3", "say.py", proxy_of("Speech"), TEXT)
        session.run("rcyaml", "deploy", "status", NETWORK)
        session.run("rcyaml", "deploy", "logs", "-n", "6", NETWORK)
        show(session, NETWORK)
    finally:
        comment("All processes are stopped in order.")
        session.run("rcyaml", "deploy", "down", NETWORK)
    comment(f"{DEMO.name}/ contains all of it. For your own robot: `.venv/bin/rcyaml new --help`, and the README.")
    return 0


if __name__ == "__main__":
    ends(main, "demo")
