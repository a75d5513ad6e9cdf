#!/usr/bin/env python3
"""Calls a component from outside of its network, as any program with Ice can: `say.py PROXY TEXT` lets Speech say it."""

from __future__ import annotations

import sys
import time
from pathlib import Path

COMPONENT = Path(__file__).resolve().parent / "talkinghead" / "components" / "speech"
SLICE = COMPONENT.parents[1] / "slice"
sys.path.insert(0, str(COMPONENT))


def main(proxy: str, text: str) -> None:
    import Ice

    Ice.loadSlice("", ["-I", str(SLICE), "--all", str(SLICE / "Speech.ice")])
    import RoboCompSpeech

    with Ice.initialize(["--Ice.Default.InvocationTimeout=5000"]) as communicator:
        try:
            speech = RoboCompSpeech.SpeechPrx.checkedCast(communicator.stringToProxy(proxy))
        except Ice.Exception as error:
            sys.exit(f"say.py: no server answers at '{proxy}': {str(error).splitlines()[-1]}")
        print(f"Speech.say({text!r}) returns {speech.say(text, False)}", flush=True)
        while speech.isBusy():
            time.sleep(0.1)
        print("Speech.isBusy() returns False: everything is said")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: say.py 'speech:tcp -p PORT' TEXT")
    try:
        from generated.runtime import interpreter
    except ModuleNotFoundError:
        sys.exit(f"say.py: {COMPONENT.parents[1]} is not compiled: `rcyaml migrate` and `rcyaml compile` there come first")
    try:
        interpreter.settle(str(COMPONENT), sys.argv)  # goes on in a Python that has Ice
        main(*sys.argv[1:])
    except interpreter.NoPython as error:
        sys.exit(f"say.py: {error}")
