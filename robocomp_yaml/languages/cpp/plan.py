"""The C++ target: a component that is built with CMake and needs Ice 3.7 alone.

Most of it is the same for every component and is copied as it stands (`templates/runtime/`); what differs are a
small generated part, the user's skeleton and the files for CMake.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.emit import windows
from robocomp_yaml.emit.copied import copied
from robocomp_yaml.emit.lowering.component import lower
from robocomp_yaml.emit.render import render
from robocomp_yaml.languages.cpp import LANGUAGE, parameters, qt
from robocomp_yaml.languages.cpp.ports import AccessorView, Ports, ServiceView
from robocomp_yaml.languages.cpp.qt import QtView, RobocompView
from robocomp_yaml.languages.cpp.text import comment, one_line, quoted
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan

if TYPE_CHECKING:
    from robocomp_yaml.emit.machines.views import MachineView

_TOPICS = frozenset(("topics.cpp", "topics.h"))  # of the run time, only where a component has topics
# Targets that CMake makes by itself.
_CMAKE_TARGETS = frozenset(
    "all clean depend edit_cache help install package package_source preinstall rebuild_cache test".split()
)


class View(msgspec.Struct, frozen=True):
    """What the templates show: each file is about the same few things."""

    source: str
    name: str
    comment: str
    period: int
    headers: list[str]
    services: list[ServiceView]
    implements: list[ServiceView]
    subscribes: list[ServiceView]
    accessors: list[AccessorView]
    requires: list[AccessorView]
    publishes: list[AccessorView]
    connect_parameters: str
    has_topics: bool
    target: str
    standard: int
    ice_components: str
    libraries: str
    slice_stems: str
    sources: list[str]
    qt: QtView | None
    robocomp: RobocompView | None
    machine: MachineView | None
    base: str


def plan(component: LinkedComponent) -> list[FilePlan]:
    """The component's files but for `slice/` and `etc/`."""
    of_qt = windows.files(component, of_machines=qt.MACHINE_FILES, of_windows=qt.WINDOW_FILES)
    parts = [*(_machine().files(component.machine) if component.machine else []), *of_qt]
    view = _view(component, parts)
    if view.robocomp:
        return _robocomp(component, view, parts)
    return [
        *copied("cpp", "runtime", _unused(component)),
        *parameters.plan(component),
        *parts,
        *(
            FilePlan(f"generated/{name}", render(f"cpp/{name}.j2", view))
            for name in ("interfaces.h", "genericworker.h", "genericworker.cpp", "main.cpp", "component.cmake")
        ),
        FilePlan("src/specificworker.h", render("cpp/specificworker.h.j2", view), ONCE),
        FilePlan("src/specificworker.cpp", render("cpp/specificworker.cpp.j2", view), ONCE),
        FilePlan("CMakeLists.txt", render("cpp/CMakeLists.txt.j2", view), ONCE),
        _ignored(view),
    ]


def _machine() -> ModuleType:
    from robocomp_yaml.languages.cpp import statemachine  # with all about machines, which few have

    return statemachine


def _unused(component: LinkedComponent) -> frozenset[str]:
    """The files of the run time that the component does not need."""
    unused = parameters.unused_runtime(component.parameters.parameters)
    return unused if component.publishes or component.subscribes else unused | _TOPICS


def _robocomp(component: LinkedComponent, view: View, parts: list[FilePlan]) -> list[FilePlan]:
    """As plan(), where the user's code is written for RoboComp's own tool."""
    names = {
        "generated/interfaces.h": "interfaces.h",
        "generated/genericworker.h": "robocomp_genericworker.h",
        "generated/genericworker.cpp": "robocomp_genericworker.cpp",
        "generated/main.cpp": "robocomp_main.cpp",
        "generated/robocomp/enumerators.h": "robocomp_enumerators.h",
        "generated/component.cmake": "component.cmake",
        "generated/CMakeLists.txt": "robocomp_CMakeLists.txt",
    }
    own = {
        "src/specificworker.h": "robocomp_specificworker.h",
        "src/specificworker.cpp": "robocomp_specificworker.cpp",
        "CMakeLists.txt": "CMakeLists.txt",
    }
    return [
        *copied("cpp", "runtime", _unused(component)),
        *parameters.plan(component),
        *parts,
        *(FilePlan(path, render(f"cpp/{name}.j2", view)) for path, name in names.items()),
        *(FilePlan(path, render(f"cpp/{name}.j2", view), ONCE) for path, name in own.items()),
        _ignored(view),
    ]


def _ignored(view: View) -> FilePlan:
    """The program is made by a build, where components in Python have a launcher that belongs to the repository."""
    head = "# This file is yours: rcyaml wrote it once. Below is what the build makes."
    return FilePlan("bin/.gitignore", f"{head}\n/{view.name}\n", ONCE)


def _view(linked: LinkedComponent, parts: list[FilePlan]) -> View:
    component = linked.component
    ports = Ports(linked)
    has_topics = bool(ports.publishes or ports.subscribes)
    has_services = bool(ports.implements or ports.subscribes)
    lowered = lower(linked)
    files = lowered.files
    connections = "connections" if has_topics or ports.requires else "/*connections*/"
    services = "services" if has_services else "/*services*/"
    sources = [file.path.removeprefix("generated/") for file in (*copied("cpp", "runtime", _unused(linked)), *parts)]
    ice = ["Ice++11", "IceStorm++11"] if has_topics else ["Ice++11"]
    is_taken = component.name.lower() in _CMAKE_TARGETS
    return View(
        source=one_line(lowered.source),
        name=lowered.name,
        comment=comment(lowered.doc),
        period=lowered.period,
        headers=[f"{file}.h" for file in files],
        services=[*ports.implements, *ports.subscribes],
        implements=ports.implements,
        subscribes=ports.subscribes,
        accessors=[*ports.requires, *ports.publishes],
        requires=ports.requires,
        publishes=ports.publishes,
        connect_parameters=f"const runtime::Connections& {connections}, runtime::Services& {services}",
        has_topics=has_topics,
        target=f"{component.name}_component" if is_taken else component.name,
        standard=component.language.standard or LANGUAGE.standards[0],
        ice_components=" ".join(ice),
        libraries=" ".join(f"Ice::{name}" for name in ice),
        slice_stems=" ".join(quoted(file.removesuffix(".ice")) for file in files),
        sources=["genericworker.cpp", "parameters.cpp", *(path for path in sources if path.endswith(".cpp"))],
        machine=_machine().view(linked.machine) if linked.machine else None,
        base=_base(linked),
        qt=qt.qt_view(linked),
        robocomp=qt.robocomp_view(linked, ports),
    )


def _base(linked: LinkedComponent) -> str:
    """What GenericWorker is derived from."""
    base = "machine::Worker" if linked.machine else "runtime::Worker"
    return f"runtime::WindowWorker<{base}>" if linked.component.gui else base
