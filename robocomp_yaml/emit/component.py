"""The plan of a component: everything below its folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext

from robocomp_yaml import resources
from robocomp_yaml.emit import config, parameter_files
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.emit.options import Options
from robocomp_yaml.emit.ports import Ports, assign
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.workspace import Workspace
from robocomp_yaml.parameters.specification.document import ValuesDocument
from robocomp_yaml.plugins import LANGUAGES
from robocomp_yaml.transactions.plan import FilePlan, RootPlan


def component_plan(
    linked: LinkedComponent,
    options: Options,
    slices: Callable[[Iterable[LinkedModule], str], Iterator[FilePlan]],
    program: Program,
) -> RootPlan:
    """The plan of one component: Slice, its language, `etc/config` from its values or a first one, docs."""
    component = linked.component
    root = _component_root(component.path, options)
    files: list[FilePlan] = []
    if options.wants("slice"):
        modules = linked.modules()
        files += slices(modules, "slice/")
        if all(scope.module.name != "RoboCompCommonBehavior" for scope in modules):
            common = resources.text("templates/slice/CommonBehavior.ice")
            files.append(FilePlan("slice/CommonBehavior.ice", common))
    if options.wants(component.language.name):
        with _telling(linked, options):
            files += component.language.target.part("plan").plan(linked)
            if component.sources or component.libraries:
                from robocomp_yaml.emit import uses

                files += uses.plan(linked, places(linked, options.workspace_of(component.path), root))
    if options.wants("config"):
        if options.only is None:
            files += parameter_files.schemas(linked)
        made = list(_configs(linked, program, lambda: options.ports(linked)))
        files += made
        if all(file.path != CONFIG for file in made):
            table = assign([linked], program.disk) if _is_complete(root, linked) else options.ports(linked)
            files.append(config.plan(linked, table))
    if options.wants("docs"):
        files += parameter_files.docs(linked)
    owner = os.path.relpath(component.path, root)
    return RootPlan(root, owner, tuple(files), partial=bool(options.targets))


def _telling(linked: LinkedComponent, options: Options) -> AbstractContextManager[None]:
    """Where the component's language is a plug-in's, what goes wrong is told as the plug-in's fault."""
    name = linked.component.language.name
    owner = options.workspace_of(linked.component.path).plugins.of(LANGUAGES).get(name)
    return owner[0].answering(f"language '{name}'") if owner else nullcontext()


def places(linked: LinkedComponent, workspace: Workspace, root: str) -> list[str]:
    """Where files of the repository are looked for, relative to `root`: beside the document, then in the workspace."""
    folder = os.path.dirname(linked.component.path) or "."
    return list(dict.fromkeys(os.path.relpath(place, root) for place in (folder, workspace.root or ".")))


def values_of(linked: LinkedComponent, program: Program) -> list[ValuesDocument]:
    """Every document that a component's `etc/config` is made of."""
    if not program.values:
        return []
    from robocomp_yaml.emit.value_files import documents_of

    return [layer.document for values in documents_of(linked, program) for layer in values.layers()]


def _is_complete(root: str, linked: LinkedComponent) -> bool:
    """Whether an `etc/config` stands there that leaves no port open, so that those of the neighbours do not matter."""
    given = config.standing(root)
    return all(config.stated(given, key) is not None for key in config.needed(linked))


def _configs(linked: LinkedComponent, program: Program, table: Callable[[], Ports]) -> Iterator[FilePlan]:
    if program.values:
        from robocomp_yaml.emit.value_files import configs, documents_of  # most components have no values

        yield from configs(linked, documents_of(linked, program), table)


def _component_root(path: str, options: Options) -> str:
    folder = os.path.dirname(path) or "."
    if options.output is None:
        return folder
    for asked in options.below:
        relative = os.path.relpath(folder, asked)
        if not relative.startswith(os.pardir):
            return os.path.normpath(os.path.join(options.output, relative))
    return options.output
