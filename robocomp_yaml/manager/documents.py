"""The commands of the manager about documents: their texts, while a person types them, and where the boxes are."""

from __future__ import annotations

import asyncio
from typing import Any

import msgspec
from starlette.requests import Request

from robocomp_yaml.api.completing.items import choices
from robocomp_yaml.api.editing.editor import new_errors
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.manager.access import EDIT, READ
from robocomp_yaml.manager.commands import ONE, Command, Served, body_of, reading, revised
from robocomp_yaml.manager.events import DOCUMENTS
from robocomp_yaml.manager.managed import ManagedDeployment
from robocomp_yaml.manager.requests import CompletionRequest, DiagnoseRequest, PositionsRequest, WriteRequest

_MOST = 1000  # diagnostics that a person could read


async def _diagnose(served: Served, request: Request) -> Any:
    wanted, managed = await body_of(request, DiagnoseRequest), served.watcher(request).managed

    def work(before: Workspace, now: Workspace, path: str) -> dict[str, Any]:
        analysis = now.analysis
        caused = new_errors(before.analysis.diagnostics, analysis.diagnostics)
        return {
            "diagnostics": [as_data(one) for one in analysis.diagnostics if one.span.file == path][:_MOST],
            "elsewhere": [as_data(one) for one in caused if one.span.file != path][:_MOST],
            **({"graph": managed.drawn(now, wanted.closed, wanted.of)} if wanted.graph else {}),
        }

    return await asyncio.to_thread(managed.with_text, wanted.path, wanted.text, work)


async def _complete(served: Served, request: Request) -> Any:
    wanted, managed = await body_of(request, CompletionRequest), served.watcher(request).managed
    return {"items": await asyncio.to_thread(_items, managed, wanted)}


def _items(managed: ManagedDeployment, wanted: CompletionRequest) -> list[dict[str, Any]]:
    def work(before: Workspace, now: Workspace, path: str) -> list[dict[str, Any]]:
        own = [one for one in now.analysis.diagnostics if one.span.file == path]
        names = managed.names(before)  # what is typed now is often too broken to have any
        found = choices(before.analysis, names, path, wanted.text, wanted.line, wanted.column, own)
        return [
            {
                "label": one.label, "detail": one.detail, "insert": one.insert, "start": one.start, "end": one.end,
                "doc": one.doc,
                "edits": [{"line": edit.span.line, "column": edit.span.column, "end_line": edit.span.end_line,
                           "end_column": edit.span.end_column, "insert": edit.text} for edit in one.edits],
            }
            for one in found
        ]  # fmt: skip

    return managed.with_text(wanted.path, wanted.text, work)


async def _write(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, WriteRequest), served.watcher(request)
    revision = await asyncio.to_thread(
        watcher.managed.rewrite, wanted.path, wanted.text, wanted.based_on, write=wanted.write, force=wanted.force
    )
    is_written = wanted.write and not revision.is_empty
    if is_written:
        watcher.events.happened("", f"wrote {revision.path}")
    return {**revised(revision), "written": is_written}


async def _move(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, PositionsRequest), served.watcher(request)
    now = await asyncio.to_thread(watcher.managed.move, wanted.positions)
    watcher.events.send(DOCUMENTS, {"problem": watcher.problem})
    return {"positions": msgspec.to_builtins(now)}


COMMANDS = (
    Command("GET", f"{ONE}/component", READ, "What a component implements, requires, publishes and subscribes to.",
            reading(lambda managed, query: managed.component(query.get("name", ""))),
            query=(("name", "The component's name, its folder or its document."),)),
    Command("GET", f"{ONE}/positions", READ, "Where a person put nodes of the picture, in pixels.",
            reading(lambda managed, query: {"positions": msgspec.to_builtins(managed.positions())})),
    Command("POST", f"{ONE}/positions", EDIT, "Keep positions of nodes, or forget them.", _move, PositionsRequest),
    Command("POST", f"{ONE}/completion", READ, "What can be typed at a position of an unsaved text.", _complete,
            CompletionRequest),
    Command("POST", f"{ONE}/diagnose", READ, "The diagnostics of an unsaved text, and those that it causes in other "
            "documents (`elsewhere`), and with `graph` the picture.", _diagnose, DiagnoseRequest),
    Command("POST", f"{ONE}/write", EDIT, "Replace the text of a document, as a change does.", _write, WriteRequest),
)  # fmt: skip
