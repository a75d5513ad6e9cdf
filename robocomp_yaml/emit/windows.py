"""The further files of components with a window, or with code for RoboComp's own tool: shared folders of the run time,
and the form of the window."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.render import render
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan

PATH = "src/mainUI.ui"


class WindowView(msgspec.Struct, frozen=True):
    """`base` is a class of Qt; `is_main`: its widgets are in a central widget."""

    base: str
    title: str
    is_main: bool


def text(base: str, title: str) -> str:
    """The text of a form."""
    return render("qt/mainUI.ui.j2", WindowView(base, title, base == "QMainWindow"))


def folders(linked: LinkedComponent) -> set[str]:
    """The folders of the run time that a component needs for state machines, Qt, and code for RoboComp's own tool."""
    component = linked.component
    needed = {
        "machine": linked.machine or component.compatibility,
        "qt": component.gui or component.compatibility,
        "robocomp": component.compatibility,
    }
    return {folder for folder, is_needed in needed.items() if is_needed}


def form_of(linked: LinkedComponent) -> list[FilePlan]:
    """The form of the component's window; empty if it has none."""
    gui = linked.component.gui
    return [FilePlan(PATH, text(gui.base, linked.component.name), ONCE)] if gui else []
