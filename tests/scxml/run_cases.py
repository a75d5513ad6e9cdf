"""Runs Python's tables: `run_cases.py NAME…` prints, as JSON, the state in which each machine ended.

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
    """Keeps the last state that was entered; cases have neither guards nor actions."""

    def __init__(self) -> None:
        self.now = 0.0
        self.last = ""

    def guard(self, name: str) -> bool:
        raise AssertionError(name)

    act = guard

    def entered(self, state: str) -> None:
        self.last = state

    def left(self, state: str) -> None:
        pass

    def log(self, label: str, value: Any) -> None:
        pass

    def complain(self, message: str) -> None:
        pass


def run(name: str) -> str:
    tables = importlib.import_module(f"generated.{name}")
    host = Host()
    sessions = Sessions(host, tables.MODELS, lambda: host.now)
    session = sessions.open(tables.MACHINE)
    session.interpreter.start()
    sessions.run()
    while session.interpreter.is_running and (due := sessions.next_due()) is not None and due < LONGEST:
        host.now = due
        sessions.run()
    return host.last


print(json.dumps({name: run(name) for name in sys.argv[1:]}))
