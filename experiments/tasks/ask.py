"""Asks running components over Ice whether a task is done: `ask.py TASK NAME=PORT...`. Exit code 1 if not."""

import sys
from pathlib import Path

import Ice

SLICE = Path(__file__).resolve().parent / "slice"


def proxy(communicator, name, port):
    Ice.loadSlice("", ["--all", f"-I{SLICE}", str(SLICE / f"{name}.ice")])
    module = __import__(f"RoboComp{name}")
    found = communicator.stringToProxy(f"{name.lower()}:tcp -h localhost -p {port} -t 5000")
    return getattr(module, f"{name}Prx").checkedCast(found)


def done(task, ask):
    if task == "proxy" or task == "network":
        return ask("Speech").say("hello") == 5 and ask("Mouth").opening() == 5
    if task == "interface":
        ask("Volume").setVolume(70)
        return ask("Volume").getVolume() == 70 and ask("Speech").say("hello") == 5
    if task == "method":
        return ask("Speech").isSpeaking() is False
    if task == "class":
        return ask("Speech").say("Dr. Bot") == len("Doctor Bot")
    raise ValueError(task)


def main():
    task, *given = sys.argv[1:]
    ports = dict(one.split("=") for one in given)
    with Ice.initialize() as communicator:
        return 0 if done(task, lambda name: proxy(communicator, name, ports[name])) else 1


if __name__ == "__main__":
    sys.exit(main())
