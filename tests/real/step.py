"""Imports, constructs and steps the Python component in a folder: a script for the tests of real repositories.

Third parties that are missing are replaced by fakes; so are other components, since they do not run. Prints one line of
JSON: `{"stage": "import" | "construct" | "step" | "done", "wrong": text}`.
"""

from __future__ import annotations

import ast
import builtins
import dis
import importlib.util
import json
import logging
import os
import sys
import threading
import traceback
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import FrameType, ModuleType, SimpleNamespace
from typing import ClassVar
from unittest.mock import MagicMock

ROOT = Path(sys.argv[1]).resolve()
SECONDS = 1.5
OURS = {"generated", "genericworker", "interfaces", "specificworker", "Ice", "IceStorm", "PySide6", "PySide2", "PySide"}


def undefined_names(folder: Path) -> set[str]:
    """The names that code uses and does not define, so that they come from `import *`."""
    used: set[str] = set()
    for path in folder.glob("*.py"):
        try:
            nodes = list(ast.walk(ast.parse(path.read_bytes())))
        except SyntaxError:
            continue
        names = [node for node in nodes if isinstance(node, ast.Name)]
        used |= {node.id for node in names if isinstance(node.ctx, ast.Load)}
        used -= {node.id for node in names if not isinstance(node.ctx, ast.Load)}
        used -= {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
        used -= {node.arg for node in nodes if isinstance(node, ast.arg)}
    return used - set(dir(builtins)) - {"QtCore", "QtWidgets", "QtGui", "Ice", "GenericWorker", "interfaces", "ifaces"}


UNDEFINED = undefined_names(ROOT / "src")


class Value(MagicMock):
    """Whatever a fake returns. It has as many elements as the code unpacks."""

    def __init__(self, *arguments: object, **more: object) -> None:
        super().__init__(*arguments, **more)
        # Each mock has a class of its own.
        type(self).__iter__ = lambda _: iter([Value() for _ in range(unpacked(sys._getframe(1)))])


def unpacked(frame: FrameType) -> int:
    """How many elements the current instruction of a frame unpacks."""
    code, at = frame.f_code.co_code, frame.f_lasti
    return code[at + 1] if dis.opname[code[at]] == "UNPACK_SEQUENCE" else 0


class Fake(ModuleType):
    """A module with every name."""

    __path__: ClassVar[list[str]] = []

    def __getattr__(self, name: str) -> object:
        if name == "__all__":
            return sorted(UNDEFINED)
        if name.startswith("__"):
            raise AttributeError(name)
        value = Value(name=f"{self.__name__}.{name}")
        setattr(self, name, value)
        return value


class Fakes(MetaPathFinder, Loader):
    """Finds what nobody else has found."""

    def find_spec(self, name: str, path: object, target: object = None) -> ModuleSpec | None:
        top = name.partition(".")[0]
        if top == "PySide6" and "PySide6" in sys.modules:
            return importlib.util.spec_from_loader(name, self, is_package=True)  # an add-on that is not installed
        if top in OURS or top.startswith("_") or top in sys.stdlib_module_names:
            return None
        return importlib.util.spec_from_loader(name, self, is_package=True)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return Fake(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        pass


class Listener(logging.Handler):
    """Collects the errors of slots."""

    def __init__(self) -> None:
        super().__init__()
        self.heard: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        if record.levelno >= logging.ERROR:
            self.heard.append(logging.Formatter().format(record))


def main() -> None:
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    sys.path[:0] = [str(ROOT), str(ROOT / "src")]
    sys.meta_path.append(Fakes())
    sys.modules["gi"] = Fake("gi")  # its parts are packages of their own, and seldom installed
    listener = Listener()
    logging.getLogger().addHandler(listener)
    report(*run(listener))


def report(stage: str, wrong: str) -> None:
    """Says what happened, and ends."""
    sys.stdout.flush()
    os.write(REPORT, json.dumps({"stage": stage, "wrong": wrong[-3000:]}).encode())
    os._exit(0)


def run(listener: Listener) -> tuple[str, str]:
    from generated.component import COMPONENT
    from generated.parameters import TABLE, Parameters
    from generated.runtime import application, settings, topics
    from generated.runtime import stopping as stopping_module
    from generated.runtime.stage import Stage
    from generated.runtime.stopping import Stopping

    application.connect = lambda *_: MagicMock(name="proxy")
    topics.Topics.__init__ = lambda self, *_: None
    topics.Topics.publisher = lambda self, port: MagicMock(name="publisher")
    topics.Topics.subscribe = topics.Topics.unsubscribe = lambda self, *_: None
    settings.Settings.endpoints = settings.Settings.topic_endpoints = lambda self, name: "tcp -h 127.0.0.1"
    settings.Settings.first = lambda self, *keys: ""
    topics.Topics.name = lambda self, port, *_: port.name
    at = "import"

    def by_force(_: int) -> None:
        """The run time ends a component whose methods do not return."""
        main = sys._current_frames()[threading.main_thread().ident or 0]
        report(at, "No end: " + "".join(traceback.format_stack(main)[-3:]))

    stopping_module.os = SimpleNamespace(**{**vars(os), "_exit": by_force})
    try:
        stopping = Stopping()
        config = [path for path in [ROOT / "etc" / "config"] if path.exists()]
        stage = (COMPONENT.stage or Stage)(COMPONENT, settings.Settings(config, []), stopping, False)
        worker_class = stage.worker_class()
        at = "construct"
        created = []
        original = stage.create

        def create(*arguments: object) -> object:
            nonlocal at
            created.append(original(*arguments))
            at = "step"
            threading.Timer(SECONDS, stopping.request).start()
            return created[0]

        stage.create = create
        app = application.Application(COMPONENT, worker_class, (TABLE, Parameters), stage)
        threading.Timer(30, lambda: os._exit(3)).start()
        app.run()
    except BaseException:  # noqa: BLE001 - whatever it is, it is what went wrong
        return at, traceback.format_exc()
    if listener.heard:
        return at, "\n".join(listener.heard)
    return ("done", "") if at == "step" else (at, "SystemExit: the code ended by itself")


REPORT = os.dup(1)
os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
main()
