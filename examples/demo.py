"""The main job on the examples, as a user would do it: migrate, check, compile, deploy.

Works on a copy of the examples in `.demo/`. Run it with `make demo`.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
DEMO = HERE.parent / ".demo"
NETWORK = "head.ddsl.yaml"
SECONDS = 2.5  # for the head to say what it has to say
BOLD, DIM, PLAIN = ("\x1b[1m", "\x1b[2m", "\x1b[0m") if sys.stdout.isatty() else ("", "", "")


def show(text: str) -> None:
    print(text, flush=True)


def rcyaml(*args: str) -> None:
    """Runs rcyaml in the copy, showing the command and what it prints. As where a virtual environment is active,
    this Python comes first: components start with it."""
    show(f"\n{BOLD}$ rcyaml {' '.join(args)}{PLAIN}")
    program = [sys.executable, "-m", "robocomp_yaml", "--color", "always" if sys.stdout.isatty() else "never"]
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    subprocess.run([*program, *args], cwd=DEMO, check=True, env={**os.environ, "PATH": path})


def has_ice() -> bool:
    found = subprocess.run([sys.executable, "-c", "import Ice"], capture_output=True)
    return found.returncode == 0


def main() -> None:
    shutil.rmtree(DEMO, ignore_errors=True)
    shutil.copytree(HERE, DEMO, ignore=shutil.ignore_patterns("demo.py", "cpp"))
    show(f"A robot's head, copied to {DEMO.name}/: two components as legacy files, and one that is YAML already.")
    rcyaml("migrate", "talkinghead")
    show(f"\n{BOLD}$ cat talkinghead/components/speech/speechcomp.cdsl.yaml{PLAIN}")
    show((DEMO / "talkinghead/components/speech/speechcomp.cdsl.yaml").read_text().rstrip())
    rcyaml("compile", "talkinghead", "jointmotor")
    rcyaml("check")
    rcyaml("graph", NETWORK)
    if not has_ice():
        show(
            "\nTo run the components, Ice is missing: `apt install python3-zeroc-ice` (Debian 12), or "
            "`pip install zeroc-ice`; then `make demo` again."
        )
        return
    try:
        rcyaml("deploy", "up", NETWORK)
        time.sleep(SECONDS)
        rcyaml("deploy", "status", NETWORK)
        rcyaml("deploy", "logs", "-n", "8", NETWORK)
    finally:
        rcyaml("deploy", "down", NETWORK)
    show(f"\n{DIM}SpeechComp called MouthComp over Ice, beside JointMotorComp; all were stopped in order.{PLAIN}")


if __name__ == "__main__":
    main()
