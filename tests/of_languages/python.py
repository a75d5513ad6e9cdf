"""Python: nothing is built."""

from __future__ import annotations

import sys

from of_languages import Spoken

PARAMETERS = """\
import threading

from generated.genericworker import GenericWorker


def race(parameters):
    def write():
        for number in range(500):
            value = 0.5 if number % 2 else 1.0
            parameters.change({"gains": [value] * 3, "motors[0].vel": value})

    parameters.change({"gains": [1.0] * 3, "motors[0].vel": 1.0})
    writer = threading.Thread(target=write)
    writer.start()
    seen = set()
    while writer.is_alive():
        now = parameters.now
        seen.add((*now.gains, now.motors[0].vel))
    writer.join()
    print("seen:", *sorted({" ".join(f"{value:g}" for value in values) for values in seen}), sep=" | ", flush=True)


class SpecificWorker(GenericWorker):
    def initialize(self):
        if self.parameters.device == "/dev/race":
            race(self.parameters)
        self.parameters.listen(self.show)
        self.show(None)

    def show(self, change):
        now = self.parameters
        motors = " ".join(f"{m.name}:{m.vel:g}" for m in now.motors)
        paths = ",".join(change.paths) if change else "-"
        print(f"[{paths}]", now.mode, now.device, now.basicPeriod, now.token, len(now.gains), motors,
              f"{sum(now.offsets.values()):g}", int(now.Yolo.useGpu), now.period.compute, flush=True)
        if now.device == "/dev/safe":
            print("safe:", now.pin, *now.locks, now.password, now.server, flush=True)
        if now.basicPeriod == 7:
            try:
                now.change({"basicPeriod": 8, "motors[0].vel": 9})
            except ValueError as error:
                print("refused:", error, flush=True)
        if now.basicPeriod == 9:
            now.basicPeriod = 10
"""
PAPER = """\
from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self):
        now = self.parameters
        print(now.handler, now.device, now.baudRate, now.basicPeriod, len(now.motors), flush=True)
        for m in now.motors:
            print(m.name, m.id, int(m.invertedSign), f"{m.min:g} {m.max:g} {m.zero:g} {m.vel:g}", flush=True)
"""
SPOKEN = Spoken(
    "python",
    "src/specificworker.py",
    lambda root: None,
    PARAMETERS,
    PAPER,
    lambda skeleton: "",
    starts=(sys.executable,),
)
