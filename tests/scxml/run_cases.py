"""Runs Python's tables: `run_cases.py NAME…` prints, as JSON, what each machine entered and logged.

It is a program of its own, since it imports the package `generated` that the tests have put together.
"""

from __future__ import annotations

import importlib
import json
import sys
from typing import Any

from generated.machine.sessions import Sessions

LONGEST = 60  # seconds that no case needs


class Host:
    """Keeps the states that were entered, and what was logged; cases have neither guards nor actions."""

    def __init__(self) -> None:
        self.now = 0.0
        self.entered_states: list[str] = []
        self.logged: list[str] = []

    def guard(self, name: str) -> bool:
        raise AssertionError(name)

    act = guard

    def entered(self, state: str) -> None:
        self.entered_states.append(state)

    def left(self, state: str) -> None:
        pass

    def log(self, label: str, value: Any) -> None:
        self.logged.append(f"{label} {'' if value is None else value}")

    def warn(self, message: str) -> None:
        pass


def run(name: str) -> dict[str, list[str]]:
    tables = importlib.import_module(f"generated.{name}")
    host = Host()
    sessions = Sessions(host, tables.MODELS, lambda: host.now)
    session = sessions.open(tables.MACHINE)
    session.interpreter.start()
    sessions.run()
    while session.interpreter.is_running and (due := sessions.next_due()) is not None and due < LONGEST:
        host.now = due
        sessions.run()
    return {"entered": host.entered_states, "logged": host.logged}


print(json.dumps({name: run(name) for name in sys.argv[1:]}))
