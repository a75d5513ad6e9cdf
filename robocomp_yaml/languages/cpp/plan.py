"""Plans C++ components, which are built with CMake and need only Ice 3.7.

Most code is the run time, which is the same in all components and is compiled once. A small generated part, the user's
skeleton and the files for CMake differ.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from robocomp_yaml.emit import runtime, windows
from robocomp_yaml.emit.layout import Layout, stated
from robocomp_yaml.emit.lowering.component import BEHAVIOR, COMMON, lower
from robocomp_yaml.emit.lowering.kinds import pattern_count
from robocomp_yaml.emit.render import View, render
from robocomp_yaml.emit.slice import file_name
from robocomp_yaml.languages._shared.views import ignored_program
from robocomp_yaml.languages.cpp import LANGUAGE, parameters, qt
from robocomp_yaml.languages.cpp.ports import port_views
from robocomp_yaml.languages.cpp.text import comment, one_line
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.transactions.plan import ONCE, FilePlan

# Targets that CMake defines itself.
_CMAKE_TARGETS = frozenset(
    "all clean depend edit_cache help install package package_source preinstall rebuild_cache test".split()
)

_QT_VERSION = "${QT_VERSION_MAJOR}"


def plan(component: LinkedComponent, layout: Layout) -> list[FilePlan]:
    """The files of a component, except `slice/`, `etc/` and the run time."""
    parts = [
        *(LANGUAGE.part("statemachine").files(component.machine) if component.machine else []),
        *windows.form_of(component),
    ]
    view = _view(component, layout)
    if view.robocomp:
        return _robocomp(component, view, parts)
    return [
        *parameters.plan(component),
        *parts,
        *(
            FilePlan(f"generated/{name}", render(f"cpp/{name}.j2", view))
            for name in ("interfaces.h", "genericworker.h", "genericworker.cpp", "main.cpp", "component.cmake")
        ),
        FilePlan("src/specificworker.h", render("cpp/specificworker.h.j2", view), ONCE),
        FilePlan("src/specificworker.cpp", render("cpp/specificworker.cpp.j2", view), ONCE),
        FilePlan("CMakeLists.txt", render("cpp/CMakeLists.txt.j2", view), ONCE),
        ignored_program(component.component.name),
    ]


def needs(component: LinkedComponent) -> Callable[[str], bool]:
    """Whether a component outside of a workspace needs a file of the run time."""
    folders = {"cmake", "runtime", "slice", *windows.folders(component)}
    parts = set(_parts(component, has_topics=bool(component.publishes or component.subscribes)))
    skipped = {f"runtime/{part}.cpp" for part in ("expressions", "pattern", "topics") if part not in parts}
    return lambda path: path.partition("/")[0] in folders and path not in skipped


def _robocomp(component: LinkedComponent, view: View, parts: list[FilePlan]) -> list[FilePlan]:
    """As `plan`, for code that was written for RoboComp's own tool."""
    names = {
        "generated/interfaces.h": "interfaces.h",
        "generated/genericworker.h": "robocomp_genericworker.h",
        "generated/genericworker.cpp": "robocomp_genericworker.cpp",
        "generated/main.cpp": "robocomp_main.cpp",
        "generated/robocomp/enumerators.h": "robocomp_enumerators.h",
        "generated/robocomp/handles.h": "robocomp_handles.h",
        "generated/component.cmake": "component.cmake",
        "generated/CMakeLists.txt": "robocomp_CMakeLists.txt",
    }
    accepted = render("cpp/robocomp_accepted.h", view)
    own = {
        "src/specificworker.h": "robocomp_specificworker.h",
        "src/specificworker.cpp": "robocomp_specificworker.cpp",
        "CMakeLists.txt": "CMakeLists.txt",
    }
    return [
        *parameters.plan(component),
        *parts,
        *(FilePlan(path, render(f"cpp/{name}.j2", view)) for path, name in names.items()),
        *(FilePlan(path, render(f"cpp/{name}.j2", view), ONCE, accepted=accepted) for path, name in own.items()),
        ignored_program(component.component.name),
    ]


def _view(linked: LinkedComponent, layout: Layout) -> View:
    """What the templates show. All files of a component use the same view."""
    component = linked.component
    ports = port_views(linked)
    has_topics = bool(ports.publishes or ports.subscribes)
    lowered = lower(linked)
    is_needed = linked.component.compatibility or not lowered.is_common
    files = [file for file in lowered.files if is_needed or file != COMMON]
    connections = "connections" if has_topics or ports.requires else "/*connections*/"
    services = "services" if ports.services else "/*services*/"
    # The code of windows and of RoboComp's components clashes with main.cpp in one translation unit.
    is_main_apart = component.gui is not None or bool(component.compatibility)
    is_taken = component.name.lower() in _CMAKE_TARGETS
    return View(
        source=one_line(lowered.source),
        name=lowered.name,
        comment=comment(lowered.doc),
        period=lowered.period,
        headers=[f"{file}.h" for file in files],
        ports=ports,
        connect_parameters=f"const runtime::Connections& {connections}, runtime::Services& {services}",
        has_topics=has_topics,
        target=f"{component.name}_component" if is_taken else component.name,
        standard=component.language.standard or LANGUAGE.standards[0],
        runtime=layout.runtime,
        version=runtime.version("cpp"),
        slice=layout.slice,
        made_for=stated(layout.made_for) if layout.made_for else "",
        interfaces=lowered.interfaces,
        slices=_slices(linked),
        parts=" ".join(f"rcyaml::{part}" for part in _parts(linked, has_topics=has_topics)),
        sources=[
            *("genericworker.cpp", "parameters.cpp"),
            *(["statemachine.cpp"] if linked.machine else []),
            *([] if is_main_apart else ["main.cpp"]),
        ],
        is_main_apart=is_main_apart,
        machine=LANGUAGE.part("statemachine").view(linked.machine) if linked.machine else None,
        base=_base(linked),
        qt=qt.qt_view(linked),
        robocomp=qt.robocomp_view(linked, ports),
    )


def _slices(linked: LinkedComponent) -> list[str]:
    """Each Slice file of the component's own modules, followed by the files that it includes, as words of CMake.
    CommonBehavior is part of the run time."""

    def word(scope: LinkedModule) -> str:
        stem = file_name(scope).removesuffix(".ice")
        return '"{}"'.format(stem.replace("\\", "\\\\").replace('"', '\\"'))

    return [
        " ".join(word(one) for one in (scope, *(other for other in scope.closure() if other is not scope)))
        for scope in linked.modules()
        if scope.module.name != BEHAVIOR or not runtime.has_common(linked)
    ]


def _parts(linked: LinkedComponent, *, has_topics: bool) -> Iterator[str]:
    """The libraries of the run time that the component links."""
    if linked.component.compatibility:
        yield f"robocomp{_QT_VERSION}"
    if linked.component.gui:
        yield f"widgets{_QT_VERSION}"
    elif linked.component.compatibility:
        yield f"qt{_QT_VERSION}"
    if linked.machine:
        yield "machine"
    if has_topics:
        yield "topics"
    if linked.parameters.parameters.constraints:
        yield "expressions"
    if pattern_count(linked.parameters.parameters.root):
        yield "pattern"
    yield "core"


def _base(linked: LinkedComponent) -> str:
    """The base class of GenericWorker."""
    base = "machine::Worker" if linked.machine else "runtime::Worker"
    return f"runtime::WindowWorker<{base}>" if linked.component.gui else base
