"""The main job on the example, as a user would do it: migrate, check, compile, run.

Works on a copy of `examples/talkinghead` in `.demo/`. Run it with `make demo`.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
DEMO = HERE.parent / ".demo"
BOLD, DIM, PLAIN = ("\x1b[1m", "\x1b[2m", "\x1b[0m") if sys.stdout.isatty() else ("", "", "")


def show(text: str) -> None:
    print(text, flush=True)


def rcyaml(*args: str) -> None:
    """Runs rcyaml in the copy, showing the command and what it prints."""
    show(f"\n{BOLD}$ rcyaml {' '.join(args)}{PLAIN}")
    program = [sys.executable, "-m", "robocomp_yaml", "--color", "always" if sys.stdout.isatty() else "never"]
    subprocess.run([*program, *args], cwd=DEMO, check=True)


def has_ice() -> bool:
    found = subprocess.run([sys.executable, "-c", "import Ice"], capture_output=True)
    return found.returncode == 0


def run(*components: tuple[str, str], seconds: float) -> None:
    """Starts components, each in a process of its own, lets them talk, and stops them in order."""
    processes = []
    for folder, name in components:
        show(f"\n{BOLD}$ components/{folder}/bin/{name} &{PLAIN}")
        command = [sys.executable, f"components/{folder}/bin/{name}"]
        processes.append(subprocess.Popen(command, cwd=DEMO))
        time.sleep(0.3)
    time.sleep(seconds)
    failed = [process.args for process in processes if process.poll() is not None]
    for process in reversed(processes):
        process.terminate()
    codes = [process.wait(timeout=5) for process in processes]
    if failed or any(codes):
        sys.exit(f"the components did not run to the end: {failed or codes}")


def main() -> None:
    shutil.rmtree(DEMO, ignore_errors=True)
    shutil.copytree(HERE / "talkinghead", DEMO)
    show(f"A robot's head as legacy files, copied to {DEMO.name}/: two interfaces and two components.")
    rcyaml("migrate", ".")
    show(f"\n{BOLD}$ cat components/speech/speechcomp.cdsl.yaml{PLAIN}")
    show((DEMO / "components/speech/speechcomp.cdsl.yaml").read_text().rstrip())
    rcyaml("check")
    rcyaml("compile")
    if not has_ice():
        show(
            "\nTo run the components, Ice is missing: `apt install python3-zeroc-ice` (Debian 12), or "
            "`pip install zeroc-ice`; then `make demo` again."
        )
        return
    run(("mouth", "MouthComp"), ("speech", "SpeechComp"), seconds=2.5)
    show(f"\n{DIM}SpeechComp called MouthComp over Ice; both were stopped in order.{PLAIN}")


if __name__ == "__main__":
    main()
