"""What the commands cost that talk to a running network, in CPU time, beside the goals.

    python benchmarks/talking.py [RUNS]

`call` is a whole process, beside a Python process that only imports Ice. `topic echo` and `record` run for ten seconds
beside a component that publishes a thousand messages per second in one topic, and a hundred in each of twenty; each
message must arrive. `top` samples 200 processes once a second.
"""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from building import write
from run import RCYAML, measure, working_folder

TOPICS, SECONDS, PROCESSES = 20, 10, 200
DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Sensors.idsl.yaml": "module: RoboCompSensors\n"
    "types:\n  Pose: {struct: {x: float, y: float, z: float, frame: string, at: long}}\n"
    "interfaces: {Sensors: {methods: {last: {in: {number: int}, returns: Pose}}}}\n"
    "topics:\n"
    + "".join(f"  T{n}: {{methods: {{moved: {{in: {{pose: Pose, number: long}}}}}}}}\n" for n in range(TOPICS))
    + "  Fast: {methods: {moved: {in: {pose: Pose, number: long}}}}\n",
    "hub/hub.cdsl.yaml": "component: Hub\nlanguage: python\nimports: [Sensors]\nimplements: [Sensors]\nperiod: 10 ms\n"
    f"publishes: [Fast, {', '.join(f'T{n}' for n in range(TOPICS))}]\n",
    "robot.ddsl.yaml": "deployment: Robot\nservices: {storm: {icestorm: {port: 19817}}}\n"
    "components: {hub: {component: hub}}\n",
    "many/many.ddsl.yaml": "deployment: Many\ncomponents:\n"
    f"  'p{{i}}': {{program: sleep, args: ['600'], instances: {PROCESSES}}}\n",
}
WORKER = f"""\
import os
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompSensors


class SpecificWorker(GenericWorker):
    def initialize(self):
        self.number = 0
        self.topics = [getattr(self, f"t{{n}}_proxy") for n in range({TOPICS})]

    def compute(self):
        pose = RoboCompSensors.Pose(x=1.5, y=2.5, z=3.5, frame="base", at=self.number)
        if os.path.exists("fast"):
            for _ in range(10):
                self.number += 1
                self.fast_proxy.moved(pose, self.number)
        elif os.path.exists("slow"):
            self.number += 1
            for topic in self.topics:
                topic.moved(pose, self.number)

    def Sensors_last(self, number):
        return RoboCompSensors.Pose()
"""


def used(command: list[str], folder: Path, seconds: float) -> tuple[float, str]:
    """The part of a core that a command uses after its first second, and its output. It is ended by Ctrl-C."""
    with tempfile.TemporaryFile("w+") as output:
        process = subprocess.Popen(command, cwd=folder, stdout=output, stderr=subprocess.DEVNULL)
        time.sleep(1.5)
        before, begin = cpu(process.pid), time.monotonic()
        time.sleep(seconds)
        part = (cpu(process.pid) - before) / (time.monotonic() - begin)
        process.send_signal(signal.SIGINT)
        process.wait()
        output.seek(0)
        return part, output.read()


def cpu(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main(runs: int) -> None:
    with working_folder() as name:
        folder = Path(name)
        for path, text in DOCUMENTS.items():
            write(folder / path, text)
        os.environ["XDG_STATE_HOME"] = f"{name}/own"
        os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        os.chdir(folder)
        subprocess.run([*RCYAML, "-q", "compile"], check=True)
        write(folder / "hub/src/specificworker.py", WORKER)
        for document in ("robot.ddsl.yaml", "many"):
            subprocess.run([*RCYAML, "-q", "deploy", "up", document], check=True)
        try:
            call = [*RCYAML, "call", "hub.Sensors.last", "number=3", "--deployment", "robot.ddsl.yaml"]
            bare = [sys.executable, "-c", "import Ice"]
            measure(call), measure(bare)
            pairs = [(measure(call).cpu, measure(bare).cpu) for _ in range(runs)]
            took, importing = (statistics.median(column) for column in zip(*pairs, strict=True))
            print(f"call, cold: {took:.2f} s of CPU, of which importing Ice is {importing:.2f} s (goal: 0.4 s)")

            (folder / "hub" / "fast").touch()
            (folder / "fast").touch()
            options = ["--format", "json", "--deployment", "robot.ddsl.yaml"]
            part, output = used([*RCYAML, "topic", "echo", "Fast", *options], folder, SECONDS)
            lines = output.splitlines()
            first, last = (int(line.rpartition('"number": ')[2].rstrip("}")) for line in (lines[0], lines[-1]))
            lost = last - first + 1 - len(lines)
            rate = len(lines) / (SECONDS + 1.5)
            print(f"echo, {rate:.0f}/s: {100 * part:.0f} % of a core, {lost} lost (goal: 1,000/s, 0 lost)")
            for path in (folder / "hub" / "fast", folder / "fast"):
                path.rename(path.with_name("slow"))

            topics = [f"T{n}" for n in range(TOPICS)]
            part, output = used([*RCYAML, "record", *topics, "-o", "a.mcap", *options], folder, SECONDS)
            print(f"record, {TOPICS} topics at 100 Hz: {100 * part:.0f} % of a core (goal: 15 %)")
            print(f"  {' '.join(output.split())}")

            part, _ = used([*RCYAML, "top", "--every", "1s", "--format", "json", "many"], folder, SECONDS)
            print(f"top, {PROCESSES} processes once a second: {100 * part:.1f} % of a core")
        finally:
            for document in ("robot.ddsl.yaml", "many"):
                subprocess.run([*RCYAML, "-q", "deploy", "down", document], stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 7)
