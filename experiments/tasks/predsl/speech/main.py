"""SpeechComp before any language described it: its communication is code of the user."""

import signal
import sys
from pathlib import Path

import Ice

HERE = Path(__file__).resolve().parent
Ice.loadSlice("", ["--all", f"-I{HERE}", str(HERE / "Speech.ice")])

from speechI import SpeechI
from worker import Worker


def main() -> int:
    data = Ice.InitializationData()
    data.properties = Ice.createProperties(sys.argv)
    data.properties.load(str(HERE / "config"))
    with Ice.initialize(data) as communicator:
        signal.signal(signal.SIGINT, lambda number, frame: communicator.shutdown())
        signal.signal(signal.SIGTERM, lambda number, frame: communicator.shutdown())
        worker = Worker()
        speech = communicator.createObjectAdapter("Speech")
        speech.add(SpeechI(worker), Ice.stringToIdentity("speech"))
        speech.activate()
        worker.start()
        communicator.waitForShutdown()
        worker.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
