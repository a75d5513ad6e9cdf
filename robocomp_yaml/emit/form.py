"""The form of a component's window, `src/mainUI.ui`: written once, then drawn with Qt Designer."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.render import render

PATH = "src/mainUI.ui"


class View(msgspec.Struct, frozen=True):
    """`base` is a class of Qt; `is_main` says that its widgets stand in a central one."""

    base: str
    title: str
    is_main: bool


def text(base: str, title: str) -> str:
    return render("qt/mainUI.ui.j2", View(base, title, base == "QMainWindow"))
