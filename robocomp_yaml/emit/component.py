"""The plan of a component: all files below its folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext
from functools import partial

import msgspec
from msgspec.structs import replace

from robocomp_yaml import resources
from robocomp_yaml.addresses.table import assign
from robocomp_yaml.emit import config, runtime
from robocomp_yaml.emit.layout import ALONE, CONFIG, GENERATED, SLICE, Layout
from robocomp_yaml.emit.lowering.component import BEHAVIOR, COMMON
from robocomp_yaml.emit.options import EmitOptions
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.workspace import WorkspaceSettings
from robocomp_yaml.parameters.json_schema import DOCUMENT, EFFECTIVE, document_schema
from robocomp_yaml.parameters.specification.document import ValuesDocument
from robocomp_yaml.plugins import LANGUAGES
from robocomp_yaml.source.relative import relative
from robocomp_yaml.transactions.plan import FilePlan, RootPlan

SCHEMA, EFFECTIVE_SCHEMA = "generated/config.schema.json", "generated/effective.schema.json"
DOCS, EXAMPLE = "generated/parameters.md", "generated/example.config.yaml"


def component_plan(
    linked: LinkedComponent,
    options: EmitOptions,
    slices: Callable[[Iterable[LinkedModule], str], Iterator[FilePlan]],
    program: Program,
    layout: Layout,
) -> RootPlan:
    """The plan of one component: the files of its language, its own Slice and run time if it does not share them,
    `etc/config` from values or a first one, and documentation."""
    component = linked.component
    root = component_root(component.path, options)
    files: list[FilePlan] = []
    if options.emits("slice") and layout.has_own_slice:
        modules = linked.modules()
        files += slices(modules, f"{SLICE}/")
        if not component.language.target.runtime and all(scope.module.name != BEHAVIOR for scope in modules):
            files.append(FilePlan(f"{SLICE}/{COMMON}", resources.text(f"templates/slice/{COMMON}")))
    if options.emits(component.language.name):
        with _blaming_plugin(linked, options):
            # The newest version of RoboComp's own tool generates into the same folder.
            is_robocomp = bool(component.compatibility)
            files += (
                replace(file, takes_over=is_robocomp and file.path.startswith(f"{GENERATED}/"))
                for file in _kept_of_language(linked, layout, program, options)
            )
            if component.sources or component.libraries:
                from robocomp_yaml.emit import uses

                files += uses.plan(linked, source_folders(linked, options.workspace_of(component.path), root))
    if options.emits("config"):
        if options.only is None:
            files += schemas(linked)
        configured: list[FilePlan] = []
        if program.values:
            from robocomp_yaml.emit.value_files import configs  # most components have no values

            configured = list(configs(linked, program, lambda: options.ports(linked), root))
        files += configured
        # Beside other configurations, a first one with defaults would be started by mistake.
        if all(file.path != CONFIG for file in configured) and (not configured or _has_config(root)):
            table = assign([linked], program.disk) if _is_complete(root, linked) else options.ports(linked)
            files.append(config.plan(linked, table))
    if options.emits("docs"):
        files += _docs(linked)
    owner = relative(component.path, root)
    return RootPlan(root, owner, tuple(files), partial=bool(options.targets))


def _kept_of_language(
    linked: LinkedComponent, layout: Layout, program: Program, options: EmitOptions
) -> list[FilePlan]:  # fmt: skip
    """The files of the component's language, which are kept as long as its documents and those of its modules are the
    same: after an edit, most are. Machines and forms may be in files of their own, and plug-ins may read anything."""
    component = linked.component
    plugins = options.workspace_of(component.path).plugins.of(LANGUAGES)
    if linked.machine or component.gui or component.language.name in plugins:
        return of_language(linked, layout)
    modules = (scope.module for scope in linked.modules())
    causes = (
        component, linked.parameters.parameters, linked.parameters.document, layout.slice, layout.runtime,
        layout.made_for, *modules,
    )  # fmt: skip
    return program.memory.result(("language", component.path), causes, lambda: of_language(linked, layout))


def of_language(linked: LinkedComponent, layout: Layout = ALONE) -> list[FilePlan]:
    """The files of the component's language, with the run time, unless that is shared."""
    target = linked.component.language.target
    part = target.part("plan")
    if not target.runtime:
        return list(part.plan(linked))
    files = list(part.plan(linked, layout))
    if layout.has_own_runtime:
        needs = part.needs(linked)
        files += [
            replace(file, path=f"{GENERATED}/{file.path}") for file in runtime.files(target.name) if needs(file.path)
        ]
    return files


def _blaming_plugin(linked: LinkedComponent, options: EmitOptions) -> AbstractContextManager[None]:
    """If a plug-in has the component's language, reports errors as those of the plug-in."""
    name = linked.component.language.name
    owner = options.workspace_of(linked.component.path).plugins.of(LANGUAGES).get(name)
    return owner[0].guarded(f"language '{name}'") if owner else nullcontext()


def source_folders(linked: LinkedComponent, workspace: WorkspaceSettings, root: str) -> list[str]:
    """The folders in which files of the repository are searched, relative to `root`: that of the document, then that of
    the workspace."""
    folder = os.path.dirname(linked.component.path) or "."
    return list(dict.fromkeys(os.path.relpath(each, root) for each in (folder, workspace.root or ".")))


def values_of(linked: LinkedComponent, program: Program) -> list[ValuesDocument]:
    """All documents from which a component's `etc/config` is generated."""
    if not program.values:
        return []
    from robocomp_yaml.emit.value_files import documents_of

    return [layer.document for values in documents_of(linked, program) for layer in values.layers()]


def _has_config(root: str) -> bool:
    return os.path.lexists(os.path.join(root, CONFIG))


def _is_complete(root: str, linked: LinkedComponent) -> bool:
    """Whether the existing `etc/config` sets all ports, so that those of other components are not needed."""
    existing = config.existing(root)
    return all(config.stated(existing, key) is not None for key in config.needed(linked))


def schemas(linked: LinkedComponent) -> Iterator[FilePlan]:
    """The JSON Schemas of a component's values."""
    served = [port.name for port in linked.implements] + [f"{port.name}Topic" for port in linked.subscribes]
    ports = {"endpoints": [*served, "CommonBehavior"], "proxies": [port.name for port in linked.requires]}
    parameters, name = linked.parameters.parameters, linked.component.name

    def text(mode: str) -> str:
        return _one_line_per_key(document_schema(parameters, name, ports, mode))

    for path, mode in ((SCHEMA, DOCUMENT), (EFFECTIVE_SCHEMA, EFFECTIVE)):
        yield FilePlan(path, linked.parameters.once(f"schema {mode} {name} {ports}", partial(text, mode)))


def _one_line_per_key(schema: dict[str, object]) -> str:
    """A JSON object with a line for each key. Indenting the rest would take ten times as long."""
    rows = (f'  "{key}": {msgspec.json.encode(value).decode()}' for key, value in schema.items())
    return "{\n" + ",\n".join(rows) + "\n}\n"


def _docs(linked: LinkedComponent) -> Iterator[FilePlan]:
    """The reference of a component's parameters, and an example of their values."""
    if linked.parameters.document is None:
        return
    from robocomp_yaml.parameters.examples.new import new_document
    from robocomp_yaml.parameters.writing.reference import reference

    parameters, document = linked.parameters.parameters, os.path.basename(linked.component.path)
    head = (
        "# An example with every parameter and its possible values. The first line of your document names the schema "
        "beside this file."
    )
    once, name = linked.parameters.once, linked.component.name
    yield FilePlan(DOCS, once(f"reference {name}", lambda: reference(parameters, name)))
    text = once(f"example {document}", lambda: new_document(parameters, f"../{document}", head, []))
    yield FilePlan(EXAMPLE, text)


def component_root(path: str, options: EmitOptions) -> str:
    """The folder to which the component of a document is compiled."""
    folder = os.path.dirname(path) or "."
    if options.output is None:
        return folder
    for requested in options.below:
        relative = os.path.relpath(folder, requested)
        if not relative.startswith(os.pardir):
            return os.path.normpath(os.path.join(options.output, relative))
    return options.output
