"""Plans Java components, which `generated/build` builds with the JDK, slice2java and Ice for Java.

Most code is the run time (`templates/runtime/`), which is the same in all components and is compiled once. A small
generated part, the user's skeleton and two scripts differ.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable

from robocomp_yaml.emit import runtime
from robocomp_yaml.emit.layout import Layout, stated
from robocomp_yaml.emit.lowering.component import COMMON, lower
from robocomp_yaml.emit.render import View, render
from robocomp_yaml.languages._shared.views import ignored_program
from robocomp_yaml.languages.java import parameters
from robocomp_yaml.languages.java.ports import port_views
from robocomp_yaml.languages.java.text import comment, literal, one_line
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan


def needs(component: LinkedComponent) -> Callable[[str], bool]:
    """Whether a component outside of a workspace needs a file of the run time: always."""
    return lambda path: True


def plan(component: LinkedComponent, layout: Layout) -> list[FilePlan]:
    """The files of a component, except `slice/`, `etc/` and the run time."""
    view = _view(component, layout)
    return [
        parameters.plan(component),
        *(
            FilePlan(f"generated/{name}.java", render(f"java/{name}.java.j2", view))
            for name in ("GenericWorker", "Services", "Main")
        ),
        FilePlan("generated/build", render("java/build.j2", view), executable=True),
        FilePlan("generated/start", render("java/start.j2", view), executable=True),
        FilePlan("src/SpecificWorker.java", render("java/SpecificWorker.java.j2", view), ONCE),
        ignored_program(component.component.name),
    ]


def _view(linked: LinkedComponent, layout: Layout) -> View:
    """What the templates show."""
    lowered, ports = lower(linked), port_views(linked)
    every = (*linked.implements, *linked.requires, *linked.publishes, *linked.subscribes)
    return View(
        source=one_line(lowered.source),
        runtime=layout.runtime,
        version=runtime.version("java"),
        slice=layout.slice,
        # the files in `slice`, as words of the shell
        slices=" ".join(shlex.quote(file) for file in lowered.files if file != COMMON),
        made_for=stated(layout.made_for) if layout.made_for else "",
        name=lowered.name,
        comment=comment(lowered.doc),
        period=lowered.period,
        ports=ports,
        # the names of all ports, as literals
        names=", ".join(literal(name) for name in dict.fromkeys(port.name for port in every)),
        interfaces=lowered.interfaces,
        needs_storm=bool(ports.publishes or ports.subscribes),
    )
