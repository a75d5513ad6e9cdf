"""Makes the plans of all files of a program: the output roots, and the files below each.

The Slice of an interface and of its imports is written to the workspace's slice folder (`-o DIR`: to DIR). A component
is written to its own folder (`-o DIR`: to the same path below DIR), with the Slice that it needs in `slice/`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import cdsl, emitting, idsl, machines
from robocomp_yaml.diag.diagnostic import ERROR, NOTE, Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.digraph import postorder, reachable
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.layout import is_settings
from robocomp_yaml.emit.options import EmitOptions
from robocomp_yaml.emit.shared import Shared, own_modules
from robocomp_yaml.grouping import grouped
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.source.relative import relative
from robocomp_yaml.transactions.plan import FilePlan, RootPlan

if TYPE_CHECKING:
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.model.interface import Module


class Build(msgspec.Struct):
    """The plans, and diagnostics about documents that cannot be compiled; `skipped` are the real paths of these.
    `components` are those of plans, by root and owner."""

    plans: list[RootPlan] = []
    components: dict[tuple[str, str], LinkedComponent] = {}
    diagnostics: list[Diagnostic] = []
    skipped: set[str] = set()


def build(program: Program, diagnostics: Iterable[Diagnostic], options: EmitOptions) -> Build:
    """The plans for all requested documents without errors, in the documents and in their imports."""
    result = Build()
    state = _State.of(diagnostics)
    texts: dict[LinkedModule, FilePlan] = {}

    def slices(modules: Iterable[LinkedModule], folder: str = "") -> Iterator[FilePlan]:
        for linked in modules:
            if linked not in texts:
                causes = tuple(one.module for one in linked.closure())
                part, path = ("slice", linked.module.path), slice_target.file_name(linked)
                text = program.memory.result(part, causes, partial(slice_target.text, linked))
                texts[linked] = FilePlan(path, text, sources=(linked.module.path,))
            plain = texts[linked]
            yield replace(plain, path=folder + plain.path) if folder else plain

    requested = {program.modules[real]: real for real in program.requested & program.modules.keys()}
    if options.output is None:
        of_components = own_modules(program, options)
        requested = {linked: real for linked, real in requested.items() if linked not in of_components}
    roots = {linked: options.output or options.workspace_of(linked.module.path).slice_folder for linked in requested}

    for linked in sorted(requested, key=lambda linked: linked.module.path):
        if not options.emits("slice") or options.only:
            continue
        cause = "" if linked.module.path in state.faulty else state.cause(linked)
        if _unusable(linked.module, cause, state, result):
            result.skipped.add(requested[linked])
            continue
        owner = relative(linked.module.path, roots[linked])
        files = tuple(slices([linked, *_imports(linked, roots)]))
        result.plans.append(RootPlan(roots[linked], owner, files))
    shared = Shared(options, slices, program.disk)
    lodgers = _lodgers(program, options)
    for real in sorted(program.requested_components(), key=lambda r: program.components[r].component.path):
        component = program.components[real]
        if options.only and not options.only(component):
            continue
        if real in lodgers:
            result.diagnostics.append(_lodged(component, lodgers[real]))
            result.skipped.add(real)
            continue
        if _unusable(component.component, next(_causes(component, state), ""), state, result):
            result.skipped.add(real)
            continue
        # Slice alone needs no target
        from robocomp_yaml.emit.component import component_plan, component_root, values_of

        layout = shared.layout(component, component_root(component.component.path, options))
        if not options.only:
            shared.add(component, layout)
        plan = component_plan(component, options, slices, program, layout)
        sources = _documents_of(component)
        files = tuple(replace(file, sources=(*sources, *file.sources)) for file in plan.files)
        if any(document.path in state.faulty for document in values_of(component, program)):
            # The errors are reported already. What values generated before is kept until they have no errors.
            files = tuple(file for file in files if not is_settings(file.path))
            plan = replace(plan, partial=True)
        result.plans.append(replace(plan, files=files))
        result.components[plan.root, plan.owner] = component
    result.plans += shared.plans({(plan.root, plan.owner) for plan in result.plans})
    result.skipped |= _unused(program, state, result.skipped)
    return result


def _lodgers(program: Program, options: EmitOptions) -> dict[str, LinkedComponent]:
    """The components in the folder of another one, which has the folder's name, with that one."""
    if not program.components:
        return {}
    from robocomp_yaml.emit.component import component_root

    by_root = grouped(
        (program.disk.real(component_root(program.components[real].component.path, options)), real)
        for real in program.requested_components()
    )
    lodgers: dict[str, LinkedComponent] = {}
    for root, reals in by_root.items():
        owners = [real for real in reals if os.path.basename(root).lower() in _names(program.components[real])]
        if len(owners) == 1:
            lodgers |= {real: program.components[owners[0]] for real in reals if real not in owners}
    return lodgers


def _names(linked: LinkedComponent) -> tuple[str, str]:
    """The names of a component and of its document, in lower case."""
    component = linked.component
    return component.name.lower(), os.path.basename(component.path).partition(".")[0].lower()


def _lodged(linked: LinkedComponent, owner: LinkedComponent) -> Diagnostic:
    return emitting.LODGED.at(
        linked.component.span, name=linked.component.name, owner=owner.component.name,
        related=[Related("the component of this folder", owner.component.span)], hint=emitting.APART,
    )  # fmt: skip


def _documents_of(linked: LinkedComponent) -> tuple[str, ...]:
    """The documents from which all files of a component are generated."""
    parameters = linked.parameters.document
    return (linked.component.path, *((parameters.path,) if parameters is not None else ()), *linked.machine_files)


def _unused(program: Program, state: _State, skipped: set[str]) -> set[str]:
    """Other documents that are skipped: they cannot be read, they have errors, or their component has."""
    broken = {program.components[real] for real in skipped & program.components.keys()}
    theirs = {real for real, component in program.documents_of_components().items() if component in broken}
    paths = {real: linked.document.path for real, linked in program.parameters.items() if linked.document}
    paths |= {real: linked.document.path for real, linked in program.values.items()}
    paths |= {real: linked.deployment.path for real, linked in program.deployments.items()}
    unread = program.requested - program.modules.keys() - program.components.keys() - paths.keys()
    return unread | theirs | {real for real, path in paths.items() if path in state.faulty}


class _State(msgspec.Struct):
    """Documents by path: those with errors, and those with an unknown import that is not an error."""

    faulty: set[str] = set()
    lowered: set[str] = set()
    _causes: dict[LinkedModule, str] = {}

    @classmethod
    def of(cls, diagnostics: Iterable[Diagnostic]) -> _State:
        state = cls()
        for diagnostic in diagnostics:
            if diagnostic.severity == ERROR:
                state.faulty.add(diagnostic.span.file)
            elif diagnostic.code in (idsl.UNRESOLVED_IMPORT.id, cdsl.UNRESOLVED_IMPORT.id, machines.UNREADABLE.id):
                state.lowered.add(diagnostic.span.file)
        return state

    def cause(self, linked: LinkedModule) -> str:
        """The document that keeps a module from being compiled: its own or an imported one, '' for none."""
        for scope in postorder([linked], lambda scope: [o for o in scope.imports if o not in self._causes]):
            if scope.module.path in self.faulty or scope.unresolved:
                self._causes[scope] = scope.module.path
            else:
                self._causes[scope] = next((self._causes[o] for o in scope.imports if self._causes[o]), "")
        return self._causes[linked]


def _imports(linked: LinkedModule, roots: Mapping[LinkedModule, str]) -> Iterable[LinkedModule]:
    """All imports of a module, direct or not, except those that have a plan for the same folder."""

    def own(scope: LinkedModule) -> list[LinkedModule]:
        return [imported for imported in scope.imports if roots.get(imported) != roots[linked]]

    return reachable(own(linked), own)


def _causes(linked: LinkedComponent, state: _State) -> Iterator[str]:
    """The documents that keep a component from being compiled, except its own if it has errors."""
    component, document = linked.component, linked.parameters.document
    is_faulty = component.path in state.faulty
    yield from (file for file in linked.machine_files if file in state.faulty)
    if linked.broken and not is_faulty:
        yield component.path
    if component.gui:
        from robocomp_yaml.check.cdsl.forms import FORM

        form = os.path.normpath(os.path.join(os.path.dirname(component.path), FORM))
        if form in state.faulty:
            yield form
    if not is_faulty:
        if document is not None and document.path in state.faulty:
            yield document.path
        yield from filter(None, map(state.cause, linked.imports))


def _unusable(document: Module | Component, cause: str, state: _State, result: Build) -> bool:
    """Whether a document cannot be compiled: it has errors, or `cause` has, which is reported."""
    if cause:
        result.diagnostics.append(_unresolved(document, cause, state))
    return bool(cause) or document.path in state.faulty


def _unresolved(document: Module | Component, cause: str, state: _State) -> Diagnostic:
    related = [Related("this document has errors, or an unknown import", Span(cause))]
    diagnostic = emitting.UNRESOLVED.at(
        document.span,
        name=document.name,
        related=related if cause != document.path else (),
        hint=f"`{typed('rcyaml', 'check', document.path)}` reports the cause: fix that first",
    )
    # If the cause is reported as an error, this is only a consequence.
    return diagnostic if cause in state.lowered else diagnostic.as_severity(NOTE)
