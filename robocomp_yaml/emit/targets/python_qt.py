"""Python components in Qt's event loop: those with a window, and those with code for RoboComp's own tool."""

from __future__ import annotations

from functools import cache

from robocomp_yaml import resources
from robocomp_yaml.emit import form
from robocomp_yaml.emit.targets.python_names import module_variable, python_name
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model.interface import Sequence
from robocomp_yaml.transactions.plan import ONCE, FilePlan

QT_STAGE, ROBOCOMP_STAGE = "generated.qt.stage", "generated.robocomp.stage"
_MACHINE_FILES = ("machine.py",)  # of the folder robocomp, only for components with a state machine


def stage(linked: LinkedComponent) -> str:
    """The module whose `Stage` the component's worker lives on, or '' for the usual one."""
    if linked.component.compatibility:
        return ROBOCOMP_STAGE
    return QT_STAGE if linked.component.gui else ""


def qt_base(linked: LinkedComponent) -> str:
    """What RoboComp's GenericWorker is derived from."""
    gui = linked.component.gui
    return f"QtWidgets.{gui.base}" if gui else "QtCore.QObject"


def sequences(linked: LinkedComponent) -> list[str]:
    """For each module that has any: the module and the names of its sequences, as arguments."""
    rows = []
    for scope in linked.modules():
        names = [python_name(d.name) for d in scope.module.definitions if isinstance(d, Sequence)]
        if names:
            rows.append(", ".join([module_variable(scope.module.name), *(f'"{name}"' for name in names)]))
    return rows


def files(linked: LinkedComponent) -> list[FilePlan]:
    """What is the same in every such component, and the window's form."""
    component = linked.component
    plans: list[FilePlan] = []
    if component.gui or component.compatibility:
        plans += _folder("qt")
    if component.compatibility:
        plans += (plan for plan in _folder("robocomp") if linked.machine or _name(plan) not in _MACHINE_FILES)
    if component.gui:
        plans.append(FilePlan(form.PATH, form.text(component.gui.base, component.name), ONCE))
    return plans


@cache
def _folder(name: str) -> tuple[FilePlan, ...]:
    folder = resources.folder("templates") / "python" / name
    found = sorted(folder.glob("*.py"))
    return tuple(FilePlan(f"generated/{name}/{file.name}", file.read_text(encoding="utf-8")) for file in found)


def _name(plan: FilePlan) -> str:
    return plan.path.rpartition("/")[2]
