"""The further files of components with a window, or with code for RoboComp's own tool: shared folders of the run time,
and the form of the window."""

from __future__ import annotations

from robocomp_yaml.emit.render import render
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan

PATH = "src/mainUI.ui"


def text(base: str, title: str) -> str:
    """The text of a form with a class of Qt as its base. The widgets of a main window are in a central widget."""
    return render("qt/mainUI.ui.j2", base=base, title=title, is_main=base == "QMainWindow")


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
