"""What components with a window, or with code for RoboComp's own tool, have besides: files that are the same in all of
them, and the window's form."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.copied import copied
from robocomp_yaml.emit.render import render
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan

PATH = "src/mainUI.ui"


class View(msgspec.Struct, frozen=True):
    """`base` is a class of Qt; `is_main` says that its widgets stand in a central one."""

    base: str
    title: str
    is_main: bool


def text(base: str, title: str) -> str:
    return render("qt/mainUI.ui.j2", View(base, title, base == "QMainWindow"))


_NONE: frozenset[str] = frozenset()


def files(
    linked: LinkedComponent, *, of_machines: frozenset[str], of_windows: frozenset[str] = _NONE
) -> list[FilePlan]:
    """The folders `qt` and `robocomp` of the language's templates: the latter with the files `of_machines` only where
    there is a state machine, the former without those `of_windows` where the code is RoboComp's."""
    component = linked.component
    name = component.language.name
    plans: list[FilePlan] = []
    if component.gui or component.compatibility:
        plans += copied(name, "qt", of_windows if component.compatibility else _NONE)
    if component.compatibility:
        plans += copied(name, "robocomp", _NONE if linked.machine else of_machines)
    return [*plans, *form_of(linked)]


def form_of(linked: LinkedComponent) -> list[FilePlan]:
    """The form of the component's window, if it has one."""
    gui = linked.component.gui
    return [FilePlan(PATH, text(gui.base, linked.component.name), ONCE)] if gui else []
