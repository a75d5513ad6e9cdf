"""Python components in Qt's event loop: those with a window, and those with code for RoboComp's own tool."""

from __future__ import annotations

from robocomp_yaml.languages.python.names import module_variable, python_name
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model.interface import Sequence

QT_STAGE, ROBOCOMP_STAGE = "generated.qt.stage", "generated.robocomp.stage"


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
