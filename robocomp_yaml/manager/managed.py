"""One deployment as the manager serves it: its documents, their living analysis, and changes of both."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from robocomp_yaml import api
from robocomp_yaml.api.availability import available
from robocomp_yaml.api.editing import layout
from robocomp_yaml.api.editing.changes import ComponentChange, DocumentChange
from robocomp_yaml.api.editing.components import PORT_LISTS, document_of
from robocomp_yaml.api.editing.editor import DocumentEditor, Revision
from robocomp_yaml.api.pushing import push
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.deploy import json_data
from robocomp_yaml.deploy.operations import reasons_to_stop
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.emit.graphs.closed import closed
from robocomp_yaml.emit.graphs.forms.json import node_data, picture_data
from robocomp_yaml.emit.graphs.picture import Cell
from robocomp_yaml.emit.graphs.screen import screen_geometry
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.manager.facts import entries_of, process_of
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import Names
from robocomp_yaml.network.network import Network
from robocomp_yaml.source.inside import stays_inside

if TYPE_CHECKING:
    from robocomp_yaml.api.addresses import Addresses
    from robocomp_yaml.api.topics import Topics

T = TypeVar("T")
NETWORK, COMPONENTS = "network", "components"


class ManagedDeployment:
    """The methods block, and are called in threads; what they use is used by one at a time."""

    def __init__(self, path: str, include: Sequence[str] = (), engine: str | None = None) -> None:
        self.path, self._engine = os.path.normpath(path), engine
        folder = os.path.dirname(self.path) or "."
        self.root = root_above(folder) or folder
        self._living = api.follow(self.root, include=include)
        self._editor = DocumentEditor(self._living)
        self._include = tuple(include)
        self._workspace: Workspace | None = None
        self._names: tuple[Workspace, Names] | None = None
        self._shown: tuple[tuple[object, ...], Revision] | None = None  # the last one, and what it was made of
        self._lock = threading.Lock()
        self._states: dict[str, object] = {}
        self._seen: dict[str, object] = {}  # by `changes`
        self._left: dict[str, object] = {}  # after the changes that were made here
        self._cells: dict[frozenset[str], dict[str, Cell]] = {}

    def with_workspace(self, work: Callable[[Workspace], T]) -> T:
        """What `work` makes of the documents as they are now."""
        with self._lock:
            workspace = self._workspace = self._living.load()
            read = workspace.analysis.disk.contents
            self._states = {path: _state(path) for path in (*read, self.path, layout.path_of(self.path))}
            return work(workspace)

    def with_text(self, path: str, text: str, work: Callable[[Workspace, Workspace, str], T]) -> T:
        """What `work` makes of the documents as they are, the documents with an unsaved text, and its path. Changes on
        the disk since the last look are not seen. Raises Refused if it is no document of the workspace."""
        with self._lock:
            before = self._workspace = self._workspace or self._living.load()
            chosen = self._own(before, path)
            try:
                self._living.edit(chosen, text)
                return work(before, self._living.look(*self._living.paths), chosen)
            except UnicodeEncodeError:
                raise Refused("the text contains half a character (a surrogate)") from None
            finally:
                self._living.edit(chosen, None)

    def names(self, workspace: Workspace) -> Names:
        """The names in the documents, which are collected once."""
        known = self._names
        if known is None or known[0] is not workspace:
            known = self._names = (workspace, names_of(workspace.analysis))
        return known[1]

    def changes(self) -> dict[str, bool]:
        """The files that are not as they were at the last such question, and whether it is a document that somebody
        else changed. What
        `with_workspace` read meanwhile does not matter: it reads for one page, and this tells all of them."""
        now: dict[str, object] = {path: _state(path) for path in list(self._states)}
        changed = [path for path, state in now.items() if self._seen.get(path, state) != state]
        self._seen, positions = now, layout.path_of(self.path)
        return {path: path != positions and self._left.get(path) != now[path] for path in changed}

    def network(self) -> tuple[Network, str]:
        """The network, and the name of its engine. Raises Faulty and Refused."""

        def work(workspace: Workspace) -> tuple[Network, str]:
            deployment = workspace.deployment(self.path, engine=self._engine, lenient=True)
            return deployment.network, deployment.engine

        return self.with_workspace(work)

    def graph(self, shut: Collection[str] = (), of: str = NETWORK) -> dict[str, Any]:
        """The picture of the network as data, with the version of its document. `shut` are the boxes that are closed:
        `host NAME`, `group NAME`. `of` may be COMPONENTS: those of the workspace. Raises Faulty if there is no
        picture."""

        def work(workspace: Workspace) -> dict[str, Any]:
            found = self.drawn(workspace, shut, of)
            if found is None and not os.path.isfile(self.path):
                raise Refused(f"{self.path} is not there any more; the last picture of it stays")
            if found is None:
                raise Faulty(workspace.analysis.diagnostics, workspace.documents_read)
            return found

        return self.with_workspace(work)

    def drawn(self, workspace: Workspace, shut: Collection[str], of: str = NETWORK) -> dict[str, Any] | None:
        """The picture of the network in these documents, which may be unsaved; None if errors leave none."""
        if of not in (NETWORK, COMPONENTS):
            raise Refused(f"there is no picture of '{of}': {NETWORK} or {COMPONENTS}")
        is_network = of == NETWORK
        name = os.path.basename(os.path.abspath(self.root))
        picture = workspace.picture(self.path) if is_network else workspace.picture_of_components(name)
        if picture is None:
            return None
        seen, members = closed(picture, shut) if shut and is_network else (picture, {})
        cells = self._cells.setdefault(frozenset(members if is_network else (COMPONENTS,)), {})
        geometry = screen_geometry(seen, cells)
        cells.update(geometry.cells)  # what is added again is where it was
        data = picture_data(seen, geometry)
        for node in data["nodes"]:
            if node["name"] in members:
                node["members"] = [node_data(picture.nodes[name]) for name in members[node["name"]]]
        return {**data, "of": of, "document": self.path, "version": self._editor.version(self.path)}

    def entries(self) -> dict[str, Any]:
        """The entries with their ports, and what can be added."""
        return self.with_workspace(lambda workspace: entries_of(workspace, self.path))

    def process(self, name: str) -> dict[str, Any]:
        """The parameters and methods of a process. Raises Refused if it is unknown."""
        return self.with_workspace(lambda workspace: process_of(workspace, self.path, name))

    def plan(self, names: Sequence[str], action: str) -> dict[str, Any]:
        """What an operation would do. Raises Faulty and Refused."""
        deployment = self._deployment(lenient=action == "down")
        if action == "down":
            stopping, chosen = deployment.stopping(*names), deployment.chosen(names)
            reasons = reasons_to_stop(deployment.network, stopping, chosen)
            return {
                "stop": stopping,
                "reasons": reasons,
                "diagnostics": [as_data(one) for one in deployment.diagnostics],
            }
        plan = deployment.plan(*names, restart=action == "restart")
        return {"plan": json_data.plan_steps(plan), "diagnostics": [as_data(one) for one in deployment.diagnostics]}

    def operate(
        self, action: str, names: Sequence[str], on_failure: str, timeout: float | None, report: Callable[[Any], None]
    ) -> dict[str, Any]:  # fmt: skip
        """Does an operation: `up`, `restart`, `down` or `rollback`. Raises Faulty and Refused."""
        deployment = self._deployment(lenient=action in ("down", "rollback"))
        match action:
            case "down":
                data: dict[str, Any] = {"stopped": deployment.down(*names, report=report)}
            case "rollback":
                data = json_data.result_data(
                    deployment.rollback(on_failure=on_failure, timeout=timeout, report=report)
                )  # fmt: skip
            case _:
                data = json_data.result_data(deployment.up(
                    *names, restart=action == "restart", on_failure=on_failure, timeout=timeout, report=report
                ))  # fmt: skip
        return _outcome(deployment, data)

    def logs(self, names: Sequence[str], last: int, since: str, pattern: str) -> list[dict[str, str]]:
        deployment = self._deployment(lenient=True)
        found = deployment.logs(*names, last=last, since=since, pattern=pattern)
        return [json_data.line_data(line) for line in found]

    def addresses(self) -> Addresses:
        """Who can be called in the deployment. Raises Faulty and Refused."""
        from robocomp_yaml.api.addresses import Addresses

        return self.with_workspace(lambda workspace: Addresses(self.path, self._include, workspace.analysis))

    def topics(self) -> Topics:
        """The topics of the deployment. Raises Faulty and Refused."""
        from robocomp_yaml.api.topics import Topics

        return Topics(self.addresses())

    def document(self, path: str) -> dict[str, Any]:
        """The text of a document of this workspace, with its version and what is wrong with it. Raises Refused for any
        other file."""

        def work(workspace: Workspace) -> dict[str, Any]:
            chosen = self._own(workspace, path)
            version = self._editor.version(chosen)
            text = workspace.analysis.disk.contents[chosen].decode("utf-8-sig", "replace")
            found = [as_data(one) for one in workspace.analysis.diagnostics if one.span.file == chosen]
            return {"document": chosen, "version": version, "text": text, "diagnostics": found}

        return self.with_workspace(work)

    def documents(self) -> list[str]:
        """The paths of the documents of this workspace."""
        return self.with_workspace(self._documents)

    def revise(self, change: DocumentChange, document: str, based_on: str, *, write: bool, force: bool) -> Revision:
        """Makes a change, and writes it if that is wanted. Raises EditConflict, Faulty and Refused."""

        def work(workspace: Workspace) -> Revision:
            if isinstance(change, ComponentChange) and not (document or change.component):
                raise Refused("a change of a component names the component, or its document")
            disk = workspace.analysis.disk
            shown = (change, document, disk.version, disk.contents)
            known = self._shown[1] if self._shown is not None and self._shown[0] == shown else None
            if known is not None and based_on in ("", known.based_on):
                revision = known  # nothing is judged twice: the documents are those of which it was shown
            else:
                revision = self._editor.revise(self._own(workspace, document or self.path), change, based_on, workspace)
            self._shown = None if write else (shown, revision)
            return self._written(workspace, revision, write=write, force=force)

        return self.with_workspace(work)

    def rewrite(self, document: str, text: str, based_on: str, *, write: bool, force: bool) -> Revision:
        """Replaces the text of a document. Raises EditConflict, Faulty and Refused."""

        def work(workspace: Workspace) -> Revision:
            revision = self._editor.rewrite(self._own(workspace, document), text, based_on, workspace)
            return self._written(workspace, revision, write=write, force=force)

        return self.with_workspace(work)

    def _written(self, workspace: Workspace, revision: Revision, *, write: bool, force: bool) -> Revision:
        self._own(workspace, revision.path)
        if write:
            self._editor.write(revision, force=force)
            self._made(revision)
        return revision

    def _made(self, revision: Revision) -> None:
        """What has another name stays where it is in the pictures."""
        self._left[revision.path] = _state(revision.path)
        for path, old, new in revision.renamed:
            if os.path.realpath(path) == os.path.realpath(self.path):
                self._cells = {shut: layout.renamed(cells, old, new) for shut, cells in self._cells.items()}

    def undo(self, document: str, *, again: bool) -> Revision:
        """Undoes the last change of a document, or makes it `again`. Raises Refused."""

        def work(workspace: Workspace) -> Revision:
            path = self._own(workspace, document or self.path)
            revision = self._editor.redo(path) if again else self._editor.undo(path)
            self._made(revision)
            return revision

        return self.with_workspace(work)

    def component(self, name: str) -> dict[str, Any]:
        """What a component implements, requires, publishes and subscribes to. Raises Refused if it is unknown."""

        def work(workspace: Workspace) -> dict[str, Any]:
            program = workspace.analysis.program
            path = self._own(workspace, document_of(program, name))
            linked = program.components[os.path.realpath(path)]
            ports = {key: [port.name for port in getattr(linked, key)] for key in PORT_LISTS}
            return {"name": linked.component.name, "path": path, "version": self._editor.version(path), **ports}

        return self.with_workspace(work)

    def positions(self) -> dict[str, layout.Position]:
        """The positions that a person chose for nodes of the picture."""
        return layout.read(self.path)

    def move(self, positions: Mapping[str, layout.Position | None]) -> dict[str, layout.Position]:
        """Keeps positions, or forgets them. Raises Refused."""
        with self._lock:
            return layout.move(self.path, positions)

    def available(self, host: str) -> dict[str, Any]:
        """What a host has of the components of the deployment, and what it lacks. Raises Faulty and Refused."""
        deployment = self._deployment(lenient=True)
        found = available(deployment, host)
        return {
            "host": host,
            "processes": [
                {"name": one.name, "component": one.component, "assigned": one.is_assigned,
                 "present": one.is_present, "missing": list(one.missing)}
                for one in found
            ],
            "diagnostics": [as_data(one) for one in deployment.diagnostics],
        }  # fmt: skip

    def push(self, hosts: Sequence[str], report: Callable[[str, str], None]) -> dict[str, Any]:
        """Brings to hosts what their processes need. Raises Faulty and Refused."""
        deployment = self._deployment(lenient=False)
        done = push(deployment, hosts, report=report)
        return _outcome(deployment, {"hosts": [json_data.push_data(one) for one in done]})

    def _deployment(self, *, lenient: bool) -> api.Deployment:
        return self.with_workspace(
            lambda workspace: workspace.deployment(self.path, engine=self._engine, lenient=lenient)
        )

    def _documents(self, workspace: Workspace) -> list[str]:
        read = (document.path for document in workspace.analysis.documents.values())
        root = os.path.realpath(self.root)
        return sorted(path for path in read if stays_inside(root, os.path.realpath(path)))

    def _own(self, workspace: Workspace, path: str) -> str:
        """The path of a document of this workspace. Raises Refused for any other."""
        chosen = os.path.normpath(path)
        if chosen not in self._documents(workspace):
            raise Refused(f"'{path}' is not a document of this workspace")
        return chosen


def _outcome(deployment: api.Deployment, data: dict[str, Any]) -> dict[str, Any]:
    """What an operation returned, and whether it had no errors."""
    found = deployment.diagnostics
    return {**data, "ok": not has_errors(found), "diagnostics": [as_data(one) for one in found]}


def _state(path: str) -> tuple[int, int, int] | None:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
