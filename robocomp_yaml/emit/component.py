"""The plan of a component: everything below its folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator

from robocomp_yaml import resources
from robocomp_yaml.emit import config, uses
from robocomp_yaml.emit.options import Options
from robocomp_yaml.emit.plan import CONFIG, FilePlan, RootPlan
from robocomp_yaml.emit.ports import assign
from robocomp_yaml.emit.targets import languages
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.link.workspace import Workspace


def component_plan(
    linked: LinkedComponent,
    options: Options,
    slices: Callable[[Iterable[LinkedModule], str], Iterator[FilePlan]],
) -> RootPlan:
    """The plan of one component: Slice, the target of its language, and a first `etc/config`."""
    component = linked.component
    root = _component_root(component.path, options)
    plan = RootPlan(root, os.path.relpath(component.path, root), partial=bool(options.targets))
    if options.wants("slice"):
        modules = linked.modules()
        plan.files += slices(modules, "slice/")
        if all(scope.module.name != "RoboCompCommonBehavior" for scope in modules):
            common = resources.text("templates/slice/CommonBehavior.ice")
            plan.files.append(FilePlan("slice/CommonBehavior.ice", common))
    if options.wants(component.language.name):
        plan.files += languages()[component.language.name].plan(linked)
        if component.sources or component.libraries:
            plan.files += uses.plan(linked, places(linked, options.workspace_of(component.path), root))
    if options.wants("config"):
        written = os.path.lexists(os.path.join(root, CONFIG))
        plan.files.append(config.plan(linked, assign([linked]) if written else options.ports(linked)))
    return plan


def places(linked: LinkedComponent, workspace: Workspace, root: str) -> list[str]:
    """Where files of the repository are looked for, relative to `root`: beside the document, then in the workspace."""
    folder = os.path.dirname(linked.component.path) or "."
    return list(dict.fromkeys(os.path.relpath(place, root) for place in (folder, workspace.root or ".")))


def _component_root(path: str, options: Options) -> str:
    folder = os.path.dirname(path) or "."
    if options.output is None:
        return folder
    for asked in options.below:
        relative = os.path.relpath(folder, asked)
        if not relative.startswith(os.pardir):
            return os.path.normpath(os.path.join(options.output, relative))
    return options.output
