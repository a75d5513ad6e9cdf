"""The commands of the manager: a table, from which its routes and their description are made.

Each does what a command of the command line does, by the same functions of the library.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable, Collection, Mapping, Sequence
from typing import Any

import msgspec
from starlette.datastructures import QueryParams
from starlette.requests import Request

from robocomp_yaml.api.editing.editor import Revision
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.manager import requests
from robocomp_yaml.manager.access import EDIT, OPERATE, READ
from robocomp_yaml.manager.events import PROGRESS
from robocomp_yaml.manager.managed import NETWORK, ManagedDeployment
from robocomp_yaml.manager.requests import (
    CallRequest,
    EditRequest,
    OperationRequest,
    ParameterRequest,
    PushRequest,
    UndoRequest,
    Unknown,
)
from robocomp_yaml.manager.watching import Watcher

_LARGEST = 1 << 20  # bytes of a body
_MOST_LINES = 10_000


class TooLarge(Refused):
    """A body is larger than any request."""


class Served:
    """The deployments that are served, by the names that addresses have."""

    def __init__(self, watchers: Mapping[str, Watcher], rights: Collection[str]) -> None:
        self.watchers, self.rights = watchers, rights

    def watcher(self, request: Request) -> Watcher:
        name = request.path_params["deployment"]
        if name not in self.watchers:
            raise Unknown(f"there is no deployment '{name}'{meant(name, self.watchers)}")
        return self.watchers[name]


class Command(msgspec.Struct, frozen=True):
    """A command of the manager: what it `does` in a sentence, the request in its body, and its parameters with what
    they mean."""

    method: str
    path: str
    right: str
    does: str
    run: Callable[[Served, Request], Awaitable[Any]]
    body: type[msgspec.Struct] | None = None
    query: tuple[tuple[str, str], ...] = ()


def number_in(text: str) -> int:
    """The number that a text spells, 0 if it spells none."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 19 else 0


def number(query: QueryParams, name: str, default: int) -> int:
    text = query.get(name, "")
    if text and not (text.isascii() and text.isdigit() and len(text) < 9):
        raise Refused(f"{name} is '{text}', and must be a number")
    return min(int(text), _MOST_LINES) if text else default


def reading(work: Callable[[ManagedDeployment, QueryParams], Any]) -> Callable[[Served, Request], Awaitable[Any]]:
    """A command that asks a deployment, in a thread, what its query says."""

    async def run(served: Served, request: Request) -> Any:
        return await asyncio.to_thread(work, served.watcher(request).managed, request.query_params)

    return run


async def body_of(request: Request, type_: type[requests.T]) -> requests.T:
    """The request in the body. It is refused before it is read, if it says that it is too large."""
    if number_in(request.headers.get("content-length", "0")) > _LARGEST:
        raise TooLarge("the request is too large")
    content = b""
    async for part in request.stream():
        content += part
        if len(content) > _LARGEST:
            raise TooLarge("the request is too large")
    return requests.read(content, type_)


async def _list(served: Served, request: Request) -> Any:
    return {
        "rights": list(served.rights),
        "deployments": [
            {"id": name, "document": one.managed.path, "problem": one.problem}
            for name, one in served.watchers.items()
        ],
    }  # fmt: skip


def _graph(managed: ManagedDeployment, query: QueryParams) -> Any:
    return managed.graph(frozenset(query.getlist("closed")), query.get("of", NETWORK))


async def _status(served: Served, request: Request) -> Any:
    watcher = served.watcher(request)
    return {"processes": list(watcher.states.values()), "problem": watcher.problem}


async def _history(served: Served, request: Request) -> Any:
    return {"happened": list(served.watcher(request).events.past)}


def _plan(managed: ManagedDeployment, query: QueryParams) -> Any:
    action = query.get("action", "up")
    if action not in ("up", "restart", "down"):
        raise Refused(f"there is no plan of '{action}': up, restart or down")
    return managed.plan(query.getlist("name"), action)


def _operation(action: str) -> Callable[[Served, Request], Awaitable[Any]]:
    async def run(served: Served, request: Request) -> Any:
        wanted, watcher = await body_of(request, OperationRequest), served.watcher(request)
        return await _carried_out(watcher, action, wanted.names, lambda report: watcher.managed.operate(
            action, wanted.names, wanted.on_failure, wanted.timeout, lambda event: report(msgspec.to_builtins(event)),
        ))  # fmt: skip

    return run


async def _carried_out(
    watcher: Watcher, action: str, names: Sequence[str], work: Callable[[Callable[[dict[str, Any]], None]], Any]
) -> Any:
    """Does what takes a while in a thread, and tells all pages of its beginning, its progress and its end."""
    events, loop = watcher.events, asyncio.get_running_loop()

    def report(data: dict[str, Any]) -> None:
        loop.call_soon_threadsafe(events.send, PROGRESS, {"action": action, **data})

    events.happened("", f"{action} {' '.join(names)}".rstrip())
    done = await asyncio.to_thread(work, report)
    events.happened("", f"{action}: {'done' if done['ok'] else 'failed'}")
    return done


def _logs(managed: ManagedDeployment, query: QueryParams) -> Any:
    last = number(query, "last", 20)
    return {"lines": managed.logs(query.getlist("name"), last, query.get("since", ""), query.get("grep", ""))}


def _documents(managed: ManagedDeployment, query: QueryParams) -> Any:
    return {"documents": managed.documents()}


def _document(managed: ManagedDeployment, query: QueryParams) -> Any:
    return managed.document(query.get("path") or managed.path)


async def _edit(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, EditRequest), served.watcher(request)
    revision = await asyncio.to_thread(
        watcher.managed.revise, wanted.change, wanted.document, wanted.based_on, write=wanted.write, force=wanted.force
    )
    if wanted.write and not revision.is_empty:
        watcher.events.happened("", revision.what)
    return {**revised(revision), "written": wanted.write and not revision.is_empty}


def _back(*, again: bool) -> Callable[[Served, Request], Awaitable[Any]]:
    async def run(served: Served, request: Request) -> Any:
        wanted, watcher = await body_of(request, UndoRequest), served.watcher(request)
        revision = await asyncio.to_thread(watcher.managed.undo, wanted.document, again=again)
        watcher.events.happened("", revision.what)
        return {**revised(revision), "written": True}

    return run


def revised(revision: Revision) -> dict[str, Any]:
    return {
        "document": revision.path, "change": revision.what, "version": revision.version,
        "based_on": revision.based_on, "diff": revision.diff,
        "text": revision.after.decode("utf-8-sig", "replace"),
        "errors": [as_data(one) for one in revision.new_errors],
        "diagnostics": [as_data(one) for one in revision.diagnostics],
    }  # fmt: skip


async def _call(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, CallRequest), served.watcher(request)
    managed = watcher.managed

    def work() -> Any:
        from robocomp_yaml.api.calling import RemoteMethod

        words = [json.dumps(wanted.arguments)] if wanted.arguments else []
        return RemoteMethod(managed.addresses(), wanted.method).call(words, timeout=wanted.timeout).data

    done = await asyncio.to_thread(work)
    watcher.events.happened("", f"call {wanted.method}")
    return done


def _parameters(managed: ManagedDeployment, query: QueryParams) -> Any:
    from robocomp_yaml.api.running_parameters import RunningParameters

    with RunningParameters(managed.addresses(), query.get("process", "")).connected() as session:
        return {"parameters": [msgspec.to_builtins(row) for row in session.values()]}


async def _set_parameter(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, ParameterRequest), served.watcher(request)

    def work() -> Any:
        from robocomp_yaml.api.running_parameters import RunningParameters

        with RunningParameters(watcher.managed.addresses(), wanted.process).connected() as session:
            was, now = session.set(wanted.parameter, wanted.value)
            return {"path": wanted.parameter, "value": now, "was": was}

    done = await asyncio.to_thread(work)
    watcher.events.happened(wanted.process, f"set {wanted.parameter}")
    return done


async def _push(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, PushRequest), served.watcher(request)
    return await _carried_out(watcher, "push", wanted.hosts, lambda report: watcher.managed.push(
        wanted.hosts, lambda host, path: report({"host": host, "path": path}),
    ))  # fmt: skip


ONE = "/deployments/{deployment}"
_NAMES = ("name", "A process or group; may be repeated. Without it, all.")
COMMANDS = (
    Command("GET", "/deployments", READ, "The deployments that are served, and what this manager may do.", _list),
    Command("GET", f"{ONE}/graph", READ, "The picture of the network, with its geometry.", reading(_graph),
            query=(("closed", "A box that is drawn as one node: `host NAME` or `group NAME`; may be repeated."),
                   ("of", "network, or components: those of the workspace, with what they are wired to."))),
    Command("GET", f"{ONE}/status", READ, "The state of each process.", _status),
    Command("GET", f"{ONE}/history", READ, "What happened since the manager runs, whoever caused it.", _history),
    Command("GET", f"{ONE}/plan", READ, "What an operation would do, and why.", reading(_plan),
            query=(_NAMES, ("action", "up, restart or down; by default up."))),
    Command("GET", f"{ONE}/logs", READ, "The last lines of the logs.", reading(_logs),
            query=(_NAMES, ("last", "The number of lines of each process; by default 20."),
                   ("since", "A time in UTC, as lines have it."), ("grep", "A regular expression."))),
    Command("GET", f"{ONE}/documents", READ, "The documents of the workspace.", reading(_documents)),
    Command("GET", f"{ONE}/document", READ, "The text of a document, its version and its diagnostics.",
            reading(_document), query=(("path", "The document; by default, that of the deployment."),)),
    Command("GET", f"{ONE}/parameters", READ, "The values that a running component has now.",
            reading(_parameters), query=(("process", "The process."),)),
    Command("GET", f"{ONE}/entries", READ, "The entries with their ports, and what could be added.",
            reading(lambda managed, query: managed.entries())),
    Command("GET", f"{ONE}/process", READ, "The types of a process' parameters and of its methods' arguments.",
            reading(lambda managed, query: managed.process(query.get("name", ""))), query=(("name", "The process."),)),
    Command("GET", f"{ONE}/availability", READ, "Which processes a host could run, and what it lacks for each.",
            reading(lambda managed, query: managed.available(query.get("host", ""))),
            query=(("host", "The name of the host."),)),
    Command("POST", f"{ONE}/push", OPERATE, "Bring to hosts what their processes need.", _push, PushRequest),
    Command("POST", f"{ONE}/up", OPERATE, "Start the network, and apply changes to it.", _operation("up"),
            OperationRequest),
    Command("POST", f"{ONE}/restart", OPERATE, "Stop processes, and start them again.", _operation("restart"),
            OperationRequest),
    Command("POST", f"{ONE}/down", OPERATE, "Stop processes, with all that depend on them.", _operation("down"),
            OperationRequest),
    Command("POST", f"{ONE}/rollback", OPERATE, "Go back to the last up that was all ready.",
            _operation("rollback"), OperationRequest),
    Command("POST", f"{ONE}/call", OPERATE, "Call a method of a running component.", _call, CallRequest),
    Command("POST", f"{ONE}/parameters", OPERATE, "Change a value of a running component, for now.", _set_parameter,
            ParameterRequest),
    Command("POST", f"{ONE}/edit", EDIT, "Make a change in a document.", _edit, EditRequest),
    Command("POST", f"{ONE}/undo", EDIT, "Undo the last change of a document.", _back(again=False), UndoRequest),
    Command("POST", f"{ONE}/redo", EDIT, "Make a change again that was undone.", _back(again=True), UndoRequest),
)  # fmt: skip
