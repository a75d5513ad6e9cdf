"""What components with a window, or with code for RoboComp's own tool, have besides: files that are the same in all of
them, and the window's form."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.render import render
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan

PATH = "src/mainUI.ui"


class WindowView(msgspec.Struct, frozen=True):
    """`base` is a class of Qt; `is_main` says that its widgets stand in a central one."""

    base: str
    title: str
    is_main: bool


def text(base: str, title: str) -> str:
    return render("qt/mainUI.ui.j2", WindowView(base, title, base == "QMainWindow"))


def folders(linked: LinkedComponent) -> set[str]:
    """The folders of the run time for state machines, Qt, and code for RoboComp's own tool that a component needs."""
    component = linked.component
    needed = {
        "machine": linked.machine or component.compatibility,
        "qt": component.gui or component.compatibility,
        "robocomp": component.compatibility,
    }
    return {folder for folder, is_needed in needed.items() if is_needed}


def form_of(linked: LinkedComponent) -> list[FilePlan]:
    """The form of the component's window, if it has one."""
    gui = linked.component.gui
    return [FilePlan(PATH, text(gui.base, linked.component.name), ONCE)] if gui else []
