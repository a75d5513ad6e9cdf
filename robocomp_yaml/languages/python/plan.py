"""Plans Python components, which need only Python 3.9 and Ice 3.7.

Most code is the run time (`templates/runtime/`, `semantics`), which is the same in all components. A few small
generated files, the user's skeleton and a launcher differ.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Iterator

from robocomp_yaml.emit import runtime, windows
from robocomp_yaml.emit.layout import Layout, stated
from robocomp_yaml.emit.lowering.component import BEHAVIOR, lower
from robocomp_yaml.emit.render import View, changed, render
from robocomp_yaml.languages._shared.views import PortViews
from robocomp_yaml.languages.python import LANGUAGE, parameters
from robocomp_yaml.languages.python.names import ice_name, module_variable, python_name
from robocomp_yaml.languages.python.ports import port_views
from robocomp_yaml.languages.python.stubs import stub
from robocomp_yaml.languages.python.text import docstring, one_line
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.references import groups
from robocomp_yaml.model.interface import Sequence
from robocomp_yaml.semantics.slice_names import NOT_ESCAPED
from robocomp_yaml.transactions.plan import ONCE, FilePlan


def plan(component: LinkedComponent, layout: Layout) -> list[FilePlan]:
    """The files of a component, except `slice/`, `etc/` and the run time."""
    ports = port_views(component)
    view = _view(component, ports, layout)
    methods = [method for port in ports.services for method in port.new_methods]
    proxies = [port.proxy for port in ports.accessors]
    signatures = [method.signature for method in methods]
    table = [f"{view.behavior}.", *proxies, *(port.interface for port in ports.services)]
    table += [method.throws for port in ports.implements for method in port.methods]
    stubs = [*signatures, *(method.value for method in methods)]
    return [
        FilePlan("generated/__init__.py", _rendered("__init__.py", view)),
        *(
            LANGUAGE.part("statemachine").files(component.machine, component.component.name)
            if component.machine
            else []
        ),
        FilePlan("generated/interfaces.py", _rendered("interfaces.py", view)),
        FilePlan("generated/interfaces.pyi", _rendered("interfaces.pyi", view)),
        parameters.plan(component),
        FilePlan("generated/component.py", _rendered("component.py", view, table)),
        *windows.form_of(component),
        *(
            _robocomp(view)
            if component.component.compatibility
            else [
                FilePlan("generated/genericworker.py", _rendered("genericworker.py", view, [*proxies, *signatures])),
                FilePlan("src/specificworker.py", _rendered("specificworker.py", view, stubs), ONCE),
            ]
        ),
        FilePlan(f"bin/{component.component.name}", _rendered("launcher", view), ONCE, executable=True),
    ]


_SCRIPTING = "machine/scripting.py"  # it evaluates expressions of documents


def _robocomp(view: View) -> list[FilePlan]:
    """The modules that code for RoboComp's own tool imports, and a skeleton as that tool writes it."""
    every = tuple(module.variable for module in view.modules)
    view = changed(view, imports=", ".join(every), spread=every)
    return [
        FilePlan("generated/robocomp/genericworker.py", render("python/robocomp_genericworker.py.j2", view)),
        FilePlan("generated/robocomp/interfaces.py", render("python/robocomp_interfaces.py.j2", view)),
        FilePlan(
            "src/specificworker.py",
            render("python/robocomp_specificworker.py.j2", view),
            ONCE,
            accepted=render("python/robocomp_accepted.py", view),
        ),
    ]


def _rendered(template: str, view: View, code: Iterable[str] = ()) -> str:
    """The rendered template, which imports the modules that the pieces of code use."""
    named = {name for piece in code for name in re.findall(r"(\w+)\.", piece)}
    imports = ", ".join(sorted(module.variable for module in view.modules if module.variable in named))
    return render(f"python/{template}.j2", view, imports=imports)


def needs(component: LinkedComponent) -> Callable[[str], bool]:
    """Whether a component outside of a workspace needs a file of the run time."""
    folders = {"runtime", "slice", "typings", *windows.folders(component)}
    left_out = set() if component.machine and LANGUAGE.part("statemachine").scripts(component.machine) else {_SCRIPTING}
    return lambda path: path.partition("/")[0] in folders and path not in left_out


def _view(linked: LinkedComponent, ports: PortViews, layout: Layout) -> View:
    """What the templates show. All files of a component use the same view, with the `imports` that they need."""
    component = linked.component
    lowered = lower(linked)
    return View(
        source=one_line(lowered.source),
        runtime="" if layout.has_own_runtime else os.path.normpath(f"../{layout.runtime}/.."),
        version=runtime.version("python"),
        slice=os.path.normpath(f"../{layout.slice}"),
        made_for=stated(layout.made_for) if layout.made_for else "",
        name=lowered.name,
        title=docstring(lowered.doc, ""),
        docstring=docstring(lowered.doc, "    "),
        period=lowered.period,
        # literals of Python
        files=[json.dumps(file, ensure_ascii=False) for file in lowered.imported],
        # Ice's names of Slice modules, and the variables that hold these
        modules=[View(name=ice_name(name), variable=module_variable(name)) for name in lowered.modules],
        escape=any(name in NOT_ESCAPED for name in _identifiers(linked)),
        behavior=module_variable(BEHAVIOR),
        has_behavior=lowered.is_common,  # its Slice is ours, not the user's
        interfaces=lowered.interfaces,
        stubs=[stub(scope) for scope in linked.modules()],
        ports=ports,
        # of components in Qt's event loop
        stage=_stage(linked),
        window=component.gui.base if component.gui else "",
        qt_base=f"QtWidgets.{component.gui.base}" if component.gui else "QtCore.QObject",
        sequences=list(_sequences(linked)),
        machine=LANGUAGE.part("statemachine").view(linked.machine) if linked.machine else None,
        base=_base(linked),
    )


def _base(linked: LinkedComponent) -> str:
    """The base classes of GenericWorker."""
    machine = "MachineWorker" if linked.machine else ""
    window = "WindowWorker" if linked.component.gui else ""
    return ", ".join(base for base in (window, machine) if base) or "Worker"


def _identifiers(linked: LinkedComponent) -> Iterator[str]:
    """Every name in the component's Slice."""
    for scope in linked.modules():
        yield scope.module.name
        for definition in scope.module.definitions:
            yield definition.name
            yield from (name.text for group in groups(definition) for name in group)


def _stage(linked: LinkedComponent) -> str:
    """The module with the `Stage` of the component's worker; '' for the default."""
    if linked.component.compatibility:
        return "generated.robocomp.stage"
    return "generated.qt.stage" if linked.component.gui else ""


def _sequences(linked: LinkedComponent) -> Iterator[str]:
    """For each module with sequences: the module and the names of the sequences, as arguments."""
    for scope in linked.modules():
        names = [f'"{python_name(d.name)}"' for d in scope.module.definitions if isinstance(d, Sequence)]
        if names:
            yield ", ".join([module_variable(scope.module.name), *names])
