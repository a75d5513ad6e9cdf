"""The Java target: a component that `generated/build` builds, with the JDK, slice2java and Ice for Java alone.

Most of it is the same for every component and is copied as it stands (`templates/runtime/`); what differs are a small
generated part, the user's skeleton and two scripts.
"""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.copied import copied
from robocomp_yaml.emit.lowering.component import lower
from robocomp_yaml.emit.render import render
from robocomp_yaml.languages.java import parameters
from robocomp_yaml.languages.java.ports import AccessorView, Ports, ServiceView
from robocomp_yaml.languages.java.text import comment, literal, one_line
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.plan import ONCE, FilePlan


class View(msgspec.Struct, frozen=True):
    """What the templates show. `ports` are literals of Java, with commas; `needs_storm` says that there are topics."""

    source: str
    name: str
    comment: str
    period: int
    services: list[ServiceView]
    accessors: list[AccessorView]
    ports: str
    needs_storm: bool


def plan(component: LinkedComponent) -> list[FilePlan]:
    """The component's files but for `slice/` and `etc/`."""
    view = _view(component)
    return [
        *copied("java", "runtime"),
        parameters.plan(component),
        *(
            FilePlan(f"generated/{name}.java", render(f"java/{name}.java.j2", view))
            for name in ("GenericWorker", "Services", "Main")
        ),
        FilePlan("generated/build", render("java/build.j2", view), executable=True),
        FilePlan("generated/start", render("java/start.j2", view), executable=True),
        FilePlan("src/SpecificWorker.java", render("java/SpecificWorker.java.j2", view), ONCE),
        FilePlan("bin/.gitignore", f"{_HEAD}\n/{view.name}\n", ONCE),
    ]


_HEAD = "# This file is yours: rcyaml wrote it once. Below is what the build makes."


def _view(linked: LinkedComponent) -> View:
    lowered, ports = lower(linked), Ports(linked)
    services = [*ports.implements, *ports.subscribes]
    if services:
        services[-1] = msgspec.structs.replace(services[-1], comma="")
    every = (*linked.implements, *linked.requires, *linked.publishes, *linked.subscribes)
    return View(
        source=one_line(lowered.source),
        name=lowered.name,
        comment=comment(lowered.doc),
        period=lowered.period,
        services=services,
        accessors=[*ports.requires, *ports.publishes],
        ports=", ".join(literal(name) for name in dict.fromkeys(port.name for port in every)),
        needs_storm=bool(ports.publishes or ports.subscribes),
    )
