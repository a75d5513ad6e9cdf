"""One deployment as the manager serves it: its documents, their living analysis, and changes of both."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from robocomp_yaml import api
from robocomp_yaml.api.editing.changes import ComponentChange, DocumentChange
from robocomp_yaml.api.editing.editor import DocumentEditor, Revision
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.deploy import json_data
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.emit.graphs.forms.json import picture_data
from robocomp_yaml.emit.graphs.picture import Cell
from robocomp_yaml.emit.graphs.screen import screen_geometry
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.network.network import Network
from robocomp_yaml.source.inside import stays_inside

T = TypeVar("T")


class ManagedDeployment:
    """The methods block, and are called in threads; what they use is used by one at a time."""

    def __init__(self, path: str, include: Sequence[str] = (), engine: str | None = None) -> None:
        self.path, self._engine = os.path.normpath(path), engine
        folder = os.path.dirname(self.path) or "."
        self.root = root_above(folder) or folder
        self._living = api.follow(self.root, include=include)
        self._editor = DocumentEditor(self._living)
        self._include = tuple(include)
        self._lock = threading.Lock()
        self._states: dict[str, object] = {}
        self._cells: dict[str, Cell] = {}

    def with_workspace(self, work: Callable[[Workspace], T]) -> T:
        """What `work` makes of the documents as they are now."""
        with self._lock:
            workspace = self._living.load()
            read = workspace.analysis.disk.contents
            self._states = {path: _state(path) for path in (*read, self.path)}
            return work(workspace)

    def has_changed(self) -> bool:
        """Whether a document is not as `with_workspace` read it last."""
        return any(_state(path) != was for path, was in list(self._states.items()))

    def network(self) -> tuple[Network, str]:
        """The network, and the name of its engine. Raises Faulty and Refused."""

        def work(workspace: Workspace) -> tuple[Network, str]:
            deployment = workspace.deployment(self.path, engine=self._engine, lenient=True)
            return deployment.network, deployment.engine

        return self.with_workspace(work)

    def graph(self) -> dict[str, Any]:
        """The picture of the network as data, with the version of its document. Raises Faulty if there is none."""

        def work(workspace: Workspace) -> dict[str, Any]:
            picture = workspace.picture(self.path)
            if picture is None:
                raise Faulty(workspace.analysis.diagnostics, workspace.documents_read)
            geometry = screen_geometry(picture, self._cells)
            self._cells = {**self._cells, **geometry.cells}  # what is added again is where it was
            data = picture_data(picture, geometry)
            return {**data, "document": self.path, "version": self._editor.version(self.path)}

        return self.with_workspace(work)

    def plan(self, names: Sequence[str], action: str) -> dict[str, Any]:
        """What an operation would do. Raises Faulty and Refused."""
        deployment = self._deployment(lenient=action == "down")
        if action == "down":
            stopping = deployment.stopping(*names)
            return {"stop": stopping, "diagnostics": [as_data(one) for one in deployment.diagnostics]}
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
        diagnostics = deployment.diagnostics
        return {**data, "ok": not any(one.severity == ERROR for one in diagnostics),
                "diagnostics": [as_data(one) for one in diagnostics]}  # fmt: skip

    def logs(self, names: Sequence[str], last: int, since: str, pattern: str) -> list[dict[str, str]]:
        deployment = self._deployment(lenient=True)
        found = deployment.logs(*names, last=last, since=since, pattern=pattern)
        return [json_data.line_data(line) for line in found]

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
            if isinstance(change, ComponentChange) and not document:
                raise Refused("a change of a component names its document")
            revision = self._editor.revise(self._own(workspace, document or self.path), change, based_on, workspace)
            self._own(workspace, revision.path)
            if write:
                self._editor.write(revision, force=force)
            return revision

        return self.with_workspace(work)

    def undo(self, document: str, *, again: bool) -> Revision:
        """Undoes the last change of a document, or makes it `again`. Raises Refused."""

        def work(workspace: Workspace) -> Revision:
            path = self._own(workspace, document or self.path)
            return self._editor.redo(path) if again else self._editor.undo(path)

        return self.with_workspace(work)

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


def _state(path: str) -> tuple[int, int, int] | None:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
