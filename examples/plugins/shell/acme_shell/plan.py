"""The files of a component: the program, and the user's script."""

import msgspec

from robocomp_yaml.api.plugins import FilePlan, render


class View(msgspec.Struct, frozen=True):
    name: str
    source: str
    seconds: str


def plan(linked):
    component = linked.component
    source = component.path.rpartition("/")[2]
    view = View(component.name, source, f"{(component.period or 1000) / 1000:g}")
    return [
        FilePlan(f"bin/{component.name}", render("shell/main.sh.j2", view), executable=True),
        FilePlan("src/compute.sh", render("shell/compute.sh.j2", view), policy="once"),
    ]
