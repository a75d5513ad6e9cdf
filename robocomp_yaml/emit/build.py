"""From a program to the plan of all files: which output roots there are, and what goes below each.

An interface's Slice goes to the workspace's slice folder (`-o DIR`: to DIR), with that of all it imports. A component
goes to its own folder (`-o DIR`: to the same place below DIR), with the Slice that it needs in `slice/`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import cdsl, emitting, idsl, machines
from robocomp_yaml.diag.diagnostic import ERROR, NOTE, Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.digraph import inner_first, reached
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.layout import is_settings
from robocomp_yaml.emit.options import Options
from robocomp_yaml.emit.shared import Shared
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.transactions.plan import FilePlan, RootPlan

if TYPE_CHECKING:
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.model.interface import Module


class Build(msgspec.Struct):
    """The plans, and what kept documents from being compiled; `left_out` are the real paths of those."""

    plans: list[RootPlan] = []
    diagnostics: list[Diagnostic] = []
    left_out: set[str] = set()


def build(program: Program, diagnostics: Iterable[Diagnostic], options: Options) -> Build:
    """Plans for every asked document without errors, in its own text or in what it imports."""
    result = Build()
    state = _State.of(diagnostics)
    texts: dict[LinkedModule, FilePlan] = {}

    def slices(modules: Iterable[LinkedModule], folder: str = "") -> Iterator[FilePlan]:
        for linked in modules:
            if linked not in texts:
                text, sources = slice_target.text(linked), (linked.module.path,)
                texts[linked] = FilePlan(slice_target.file_name(linked), text, sources=sources)
            plain = texts[linked]
            yield replace(plain, path=folder + plain.path) if folder else plain

    def slice_root(linked: LinkedModule) -> str:
        return options.output or options.workspace_of(linked.module.path).slice_folder

    asked = {program.modules[real]: real for real in program.asked & program.modules.keys()}

    def beside(root: str) -> Callable[[LinkedModule], bool]:
        return lambda other: other in asked and slice_root(other) == root

    for linked in sorted(asked, key=lambda linked: linked.module.path):
        if not options.wants("slice") or options.only:
            continue
        if _usable(linked.module, [linked], state, result):
            root = slice_root(linked)
            owner = os.path.relpath(linked.module.path, root)
            needed = [linked, *_imports(linked, beside(root))]
            result.plans.append(RootPlan(root, owner, tuple(slices(needed))))
        else:
            result.left_out.add(asked[linked])
    shared = Shared(options, slices, program.disk)
    for real in sorted(program.asked_components(), key=lambda r: program.components[r].component.path):
        component = program.components[real]
        if options.only and not options.only(component):
            continue
        if _usable_component(component, state, result):
            # with the targets, which Slice alone needs not
            from robocomp_yaml.emit.component import component_plan, component_root, values_of

            place = shared.layout(component, component_root(component.component.path, options))
            if not options.only:
                shared.add(component, place)
            plan = component_plan(component, options, slices, program, place)
            sources = _documents_of(component)
            files = [replace(file, sources=(*sources, *file.sources)) for file in plan.files]
            if any(document.path in state.faulty for document in values_of(component, program)):
                # What is wrong has been said; what the values wrote before stays until they are right again.
                files = [file for file in files if not is_settings(file.path)]
                plan = replace(plan, partial=True)
            result.plans.append(replace(plan, files=tuple(files)))
        else:
            result.left_out.add(real)
    result.plans += shared.plans({(plan.root, plan.owner) for plan in result.plans})
    result.left_out |= _unused(program, state, result.left_out)
    return result


def _documents_of(linked: LinkedComponent) -> tuple[str, ...]:
    """The documents that all of a component is made of."""
    parameters = linked.parameters.document
    return (linked.component.path, *((parameters.path,) if parameters is not None else ()), *linked.machine_files)


def _unused(program: Program, state: _State, left_out: set[str]) -> set[str]:
    """Other documents that were of no use: they could not be read, they have errors, or their component has."""
    lost = {program.components[real] for real in left_out & program.components.keys()}
    broken = {real for real, component in program.documents_of_components().items() if component in lost}
    paths = {real: linked.document.path for real, linked in program.parameters.items() if linked.document}
    paths |= {real: linked.document.path for real, linked in program.values.items()}
    paths |= {real: linked.deployment.path for real, linked in program.deployments.items()}
    unread = program.asked - program.modules.keys() - program.components.keys() - paths.keys()
    return unread | broken | {real for real, path in paths.items() if path in state.faulty}


class _State(msgspec.Struct):
    """Documents by path: those with errors, and those with an unresolved import that was lowered to less."""

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
        """The document that keeps a module from being compiled: its own, or one that it imports; '' for none."""
        for scope in inner_first([linked], lambda scope: [o for o in scope.imports if o not in self._causes]):
            if scope.module.path in self.faulty or scope.unresolved:
                self._causes[scope] = scope.module.path
            else:
                self._causes[scope] = next((self._causes[o] for o in scope.imports if self._causes[o]), "")
        return self._causes[linked]


def _imports(linked: LinkedModule, covered: Callable[[LinkedModule], bool]) -> Iterable[LinkedModule]:
    """What a module imports, directly or not, but for what has a plan of its own for the same folder."""

    def own(scope: LinkedModule) -> list[LinkedModule]:
        return [imported for imported in scope.imports if not covered(imported)]

    return reached(own(linked), own)


def _usable(document: Module | Component, modules: Iterable[LinkedModule], state: _State, result: Build) -> bool:
    """Whether a document has no error, nor anything that it imports; when only the latter, says what follows."""
    if document.path in state.faulty:
        return False
    for linked in modules:
        cause = state.cause(linked)
        if cause:
            result.diagnostics.append(_unresolved(document, cause, state))
            return False
    return True


def _usable_component(linked: LinkedComponent, state: _State, result: Build) -> bool:
    component = linked.component
    for file in linked.machine_files:
        if file in state.faulty:
            result.diagnostics.append(_unresolved(component, file, state))
            return False
    if linked.broken and component.path not in state.faulty:
        result.diagnostics.append(_unresolved(component, component.path, state))
        return False
    if component.gui:
        from robocomp_yaml.check.cdsl.forms import FORM

        form = os.path.normpath(os.path.join(os.path.dirname(component.path), FORM))
        if form in state.faulty:
            result.diagnostics.append(_unresolved(component, form, state))
            return False
    document = linked.parameters.document
    if document is not None and document.path in state.faulty:
        if component.path not in state.faulty:
            result.diagnostics.append(_unresolved(component, document.path, state))
        return False
    return _usable(component, linked.imports, state, result)


def _unresolved(document: Module | Component, cause: str, state: _State) -> Diagnostic:
    related = [Related("this document has errors, or imports what is not there", Span(cause))]
    told = emitting.UNRESOLVED.at(
        document.span,
        name=document.name,
        related=related if cause != document.path else (),
        hint=f"`{typed('rcyaml', 'check', document.path)}` says what is missing; mend that first",
    )
    # Where the cause is an error already, this only says what follows from it.
    return told if cause in state.lowered else told.as_severity(NOTE)
