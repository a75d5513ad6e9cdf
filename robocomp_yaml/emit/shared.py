"""The files that the components of a workspace share: the Slice of interfaces, and the run time of each language."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Set

from robocomp_yaml.emit.layout import ALONE, Layout, fingerprint, runtime_folder
from robocomp_yaml.emit.options import EmitOptions
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.workspace import WorkspaceSettings
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.relative import relative
from robocomp_yaml.transactions.plan import FilePlan, RootPlan

Slices = Callable[[Iterable[LinkedModule]], Iterator[FilePlan]]


class Shared:
    """Collects the shared files, component by component. `slices` renders modules."""

    def __init__(self, options: EmitOptions, slices: Slices, disk: Disk) -> None:
        self._options, self._slices, self._disk = options, slices, disk
        self._runtimes: dict[tuple[str, str], RootPlan] = {}
        self._modules: dict[LinkedModule, str] = {}

    def layout(self, linked: LinkedComponent, root: str) -> Layout:
        """The layout of the component in the folder `root`."""
        options, target = self._options, linked.component.language.target
        if options.output is not None or options.standalone:
            return ALONE
        from robocomp_yaml.emit import runtime  # interfaces alone need none

        workspace = options.workspace_of(linked.component.path)
        if not (workspace.declared and target.runtime and runtime.has_common(linked)):
            return ALONE
        shared_runtime = relative(runtime_folder(workspace, target), root)
        modules = linked.modules()
        if not all(self._is_shared(workspace, linked, one) for one in modules):
            return Layout(runtime=shared_runtime)
        texts = {file.path: file.text for file in self._slices(modules)}
        return Layout(relative(workspace.slice_folder, root), shared_runtime, fingerprint(texts))

    def _is_shared(self, workspace: WorkspaceSettings, linked: LinkedComponent, scope: LinkedModule) -> bool:
        return (
            self._is_of(workspace, scope)
            and not _is_own(workspace, linked, scope, self._disk)
            and not _is_hidden(workspace, scope, self._disk)
        )

    def _is_of(self, workspace: WorkspaceSettings, scope: LinkedModule) -> bool:
        other = self._options.workspace_of(scope.module.path)
        return other.declared and self._disk.real(other.root) == self._disk.real(workspace.root)

    def add(self, linked: LinkedComponent, layout: Layout) -> None:
        """Adds the shared files that this component needs."""
        options, component = self._options, linked.component
        workspace = options.workspace_of(component.path)
        if not layout.has_own_slice and options.emits("slice"):
            self._modules.update(dict.fromkeys(linked.modules(), workspace.slice_folder))
        name = component.language.name
        if not layout.has_own_runtime and options.emits(name) and (workspace.root, name) not in self._runtimes:
            from robocomp_yaml.emit import runtime

            root = runtime_folder(workspace, component.language.target)
            owner = relative(os.path.join(workspace.root, WORKSPACE_FILE), root)
            self._runtimes[workspace.root, name] = RootPlan(root, owner, runtime.files(name))

    def plans(self, planned: Set[tuple[str, str]]) -> Iterator[RootPlan]:
        """The plans of the shared files, except those that are `planned`, as pairs of root and owner."""
        yield from self._runtimes.values()
        for scope, root in self._modules.items():
            owner = relative(scope.module.path, root)
            if (root, owner) not in planned:
                yield RootPlan(root, owner, tuple(self._slices([scope])), partial=True)


def own_modules(program: Program, options: EmitOptions) -> set[LinkedModule]:
    """The modules of the program that are each the own module of a component."""
    disk, of = program.disk, options.workspace_of
    return {
        scope for linked in program.components.values() for scope in linked.modules()
        if _is_below(scope, linked) and _is_own(of(linked.component.path), linked, scope, disk)
    }  # fmt: skip


def _is_own(workspace: WorkspaceSettings, linked: LinkedComponent, scope: LinkedModule, disk: Disk) -> bool:
    """Whether a module is the component's own: in a folder below the component's, which is not in the search path."""
    folder = disk.real(os.path.dirname(scope.module.path))
    return _is_below(scope, linked) and all(folder != disk.real(path) for path in workspace.interfaces)


def _is_below(scope: LinkedModule, linked: LinkedComponent) -> bool:
    """Whether a module is in a folder below that of a component."""
    folders = os.path.dirname(scope.module.path), os.path.dirname(linked.component.path)
    return not f"{relative(*folders)}/".startswith(("./", "../"))


def _is_hidden(workspace: WorkspaceSettings, scope: LinkedModule, disk: Disk) -> bool:
    """Whether imports of the workspace resolve the name of this module to another document."""
    name = os.path.basename(scope.module.path)
    for folder in workspace.interfaces:
        if disk.has_file(path := os.path.join(folder, name)):
            return disk.real(path) != disk.real(scope.module.path)
    return False
