"""Runs many components, one after the other, each in a fork of this process: a script for the test of the corpus.

Reads `[root, …]` from standard input, prints `[root, what went wrong or "", number of calls]` for each. A component has
its config already. It starts with all its adapters, publishers and subscriptions, calls each of its own methods through its
proxies with the plainest values, publishes each event, and stops. A fork, because loading Slice leaves its types
behind, and importing Ice and the run time again each time would take most of the time.
"""

from __future__ import annotations

import importlib
import inspect
import json
import logging
import os
import re
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import Ice


def main() -> None:
    roots = json.load(sys.stdin)
    sys.dont_write_bytecode = True
    sys.path.insert(0, roots[0])
    importlib.import_module("generated.runtime.application")
    for root in roots:
        reader, writer = os.pipe()
        if os.fork() == 0:
            wrong, calls = run(Path(root))
            os.write(writer, json.dumps([root, "".join(wrong)[:10000], calls]).encode())
            os._exit(0)
        os.close(writer)
        with os.fdopen(reader, "rb") as pipe:
            print(pipe.read().decode(), flush=True)
        os.wait()


def run(root: Path) -> tuple[list[str], int]:
    """What went wrong, and how many calls were made."""
    import generated.runtime
    from generated.runtime.application import Application
    from generated.runtime.settings import Settings
    from generated.runtime.stage import Stage
    from generated.runtime.stopping import Stopping

    generated.__path__[:] = [str(root / "generated")]
    sys.path[:1] = [str(root), str(root / "src")]
    wrong: list[str] = []
    calls: list[str] = []
    logging.basicConfig(level=logging.WARNING, handlers=[Listener(wrong)])
    try:
        from generated.component import COMPONENT
        from generated.parameters import TABLE, Parameters
        from specificworker import SpecificWorker

        class Caller(SpecificWorker):
            def compute(self) -> None:
                self.setPeriod(3_600_000)  # once is enough
                try:
                    calls.extend(call_all(self, COMPONENT))
                finally:
                    self.killYourSelf()

        stage = Stage(COMPONENT, Settings([root / "etc" / "config"], []), Stopping(), only_check=False)
        code = Application(COMPONENT, Caller, (TABLE, Parameters), stage).run()
        wrong += [f"exit code {code}"] if code else []
    except BaseException:  # noqa: BLE001 - whatever it is, it is what went wrong
        wrong.append(traceback.format_exc())
    return wrong, len(calls)


class Listener(logging.Handler):
    """Takes every warning and error."""

    def __init__(self, heard: list[str]) -> None:
        super().__init__()
        self.heard = heard
        self.setFormatter(logging.Formatter("%(levelname)s %(name)s: %(message)s\n"))

    def emit(self, record: logging.LogRecord) -> None:
        self.heard.append(self.format(record))


def call_all(worker: Any, component: Any) -> Iterator[str]:
    """Calls every method and publishes every event; their names."""
    pairs = [
        *zip(component.requires, component.implements, strict=False),
        *zip(component.publishes, component.subscribes, strict=False),
    ]
    for port, served in pairs:
        proxy = getattr(worker, port.accessor)
        for method in served.methods:
            parameters = inspect.signature(getattr(worker, method.calls)).parameters.values()
            values = [plainest(parameter.annotation) for parameter in parameters]
            getattr(proxy, method.operation)(*values)
            yield method.calls


def plainest(annotation: str) -> Any:
    """The plainest value of a type, as a stub would return it."""
    import generated.interfaces

    known = {"bool": False, "int": 0, "float": 0.0, "str": "", "bytes": b""}
    if annotation in known:
        return known[annotation]
    if found := re.match(r"(list|dict)\[", annotation):
        return [] if found[1] == "list" else {}
    module, name = annotation.split(".")
    loaded: ModuleType = getattr(generated.interfaces, module)
    kind = getattr(loaded, name)
    return min(kind._enumerators.items())[1] if issubclass(kind, Ice.EnumBase) else kind()


main()
