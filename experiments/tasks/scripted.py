"""A way without a language for deployments: its network is a script that the user writes."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import ExitStack

from measure import PYTHON, Way

START = """\
#!/bin/bash
# Starts the mouth, and then speech, which needs it. Ends them with: ./start.sh stop
cd "$(dirname "$0")"
if [ "$1" = stop ]; then
    kill $(cat speech.pid mouth.pid)
    rm -f speech.pid mouth.pid
    exit
fi
start() {
    $PYTHON "$1/main.py" > "$1.log" 2>&1 &
    echo $! > "$1.pid"
    for try in $(seq 100); do
        (echo > "/dev/tcp/localhost/$2") 2> /dev/null && return
        sleep 0.1
    done
    echo "$1 is not ready; see $1.log"
    exit 1
}
PYTHON=${PYTHON:-python3}
start mouth 10102
start speech 10101
"""


class Scripted(Way):
    script = START

    def programs(self) -> dict[str, tuple[str, Sequence[str]]]:
        """The components, each with the folder in which it starts and the words after `python`."""
        raise NotImplementedError

    def do_network(self) -> None:
        self.write("start.sh", self.script)
        (self.folder / "start.sh").chmod(0o755)
        self.cost.commands.append("chmod +x start.sh")
        self.command("env", f"PYTHON={PYTHON}", "./start.sh", shown="./start.sh")

    def stop(self) -> None:
        if (self.folder / "mouth.pid").exists():
            subprocess.run(["./start.sh", "stop"], cwd=self.folder, capture_output=True, check=False)

    def running(self, task: str) -> Iterator[dict[str, int]]:
        if task == "network":
            try:
                yield self.ports()
            finally:
                self.stop()
            return
        with ExitStack() as stack:
            for name, (folder, words) in self.programs().items():
                stack.enter_context(self.program([PYTHON, *words], folder, self.ports()[name]))
            yield self.ports()
