"""MouthComp: given, and the same for the ways that have no deployment language."""

import signal
import sys
from pathlib import Path

import Ice

HERE = Path(__file__).resolve().parent
Ice.loadSlice("", ["--all", f"-I{HERE}", str(HERE / "Mouth.ice")])

import RoboCompMouth


class MouthI(RoboCompMouth.Mouth):
    width = 0.0

    def open(self, width, current=None):
        self.width = width

    def opening(self, current=None):
        return self.width


def main() -> int:
    data = Ice.InitializationData()
    data.properties = Ice.createProperties(sys.argv)
    data.properties.load(str(HERE / "config"))
    with Ice.initialize(data) as communicator:
        signal.signal(signal.SIGINT, lambda number, frame: communicator.shutdown())
        signal.signal(signal.SIGTERM, lambda number, frame: communicator.shutdown())
        mouth = communicator.createObjectAdapter("Mouth")
        mouth.add(MouthI(), Ice.stringToIdentity("mouth"))
        mouth.activate()
        communicator.waitForShutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
