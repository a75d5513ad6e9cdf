"""The application: commands as JSON, events, the description of both, and the files of the page."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Collection, Mapping
from contextlib import asynccontextmanager
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route

from robocomp_yaml import __version__
from robocomp_yaml.api.editing.editor import EditConflict
from robocomp_yaml.diag.errors import Faulty, NoAnswer, Refused
from robocomp_yaml.diag.render.json import as_data, plain
from robocomp_yaml.manager import commands
from robocomp_yaml.manager.access import API, READ, SAFE_METHODS, AccessRules, Guard
from robocomp_yaml.manager.commands import Command, Served
from robocomp_yaml.manager.description import described
from robocomp_yaml.manager.events import ServerEvent
from robocomp_yaml.manager.requests import Unknown
from robocomp_yaml.manager.table import COMMANDS
from robocomp_yaml.manager.watching import Watcher

_CONFLICT, _WRONG, _FAULTY, _LARGE, _SILENT = 409, 400, 422, 413, 502


def application(watchers: Mapping[str, Watcher], rules: AccessRules, page: Mapping[str, str] | None = None) -> Guard:
    """The manager of these deployments, by the names that addresses have. `page` are the paths of the page's files by
    their names, None if there is none."""
    served = Served(watchers, rules.rights)

    @asynccontextmanager
    async def watching(app: Starlette) -> AsyncIterator[None]:
        for one in watchers.values():
            await one.begin()
        tasks = [asyncio.create_task(one.run()) for one in watchers.values()]
        try:
            yield
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    description = described(COMMANDS, API, __version__)

    async def openapi(request: Request) -> Response:
        return JSONResponse(description)

    async def files(request: Request) -> Response:
        name = request.path_params["name"] or "index.html"
        if page is None:
            text = f"the page of the manager is not installed; its commands are described at {API}/openapi.json\n"
            return PlainTextResponse(text, 200 if name == "index.html" else 404)
        path = page.get(name)
        return FileResponse(path) if path is not None else PlainTextResponse("there is no such file\n", 404)

    routes = [
        *(Route(API + one.path, _handler(one, served, rules.rights), methods=[one.method]) for one in COMMANDS),
        Route(f"{API}/deployments/{{deployment}}/events", _streaming(served, _events), methods=["GET"]),
        Route(f"{API}/deployments/{{deployment}}/log-events", _streaming(served, _log_events), methods=["GET"]),
        Route(f"{API}/deployments/{{deployment}}/topic", _streaming(served, _topic), methods=["GET"]),
        Route(f"{API}/openapi.json", openapi, methods=["GET"]),
        Route("/{name:path}", files, methods=["GET"]),
    ]
    return Guard(Starlette(routes=routes, lifespan=watching), rules)


def _handler(
    command: Command, served: Served, rights: Collection[str]
) -> Callable[[Request], Awaitable[Response]]:  # fmt: skip
    async def handle(request: Request) -> Response:
        if command.right not in rights:
            return _error(403, f"this manager may only {' and '.join(rights)}")
        assert command.right == READ or request.method not in SAFE_METHODS
        try:
            return JSONResponse(plain(await command.run(served, request)))
        except EditConflict as conflict:
            return _error(
                _CONFLICT, str(conflict), theirs=conflict.theirs, ours=conflict.ours, version=conflict.version
            )
        except (Refused, Faulty, NoAnswer) as error:
            return _failed(error)
        except RecursionError:
            return _error(_WRONG, "the request, or a document, is nested too deeply")

    return handle


def _failed(error: Refused | Faulty | NoAnswer) -> JSONResponse:
    if isinstance(error, Faulty):
        return _error(_FAULTY, str(error), diagnostics=[as_data(one) for one in error.diagnostics])
    if isinstance(error, NoAnswer):
        return _error(_SILENT, error.message, hint=error.hint)
    if isinstance(error, commands.TooLarge):
        return _error(_LARGE, str(error))
    return _error(404 if isinstance(error, Unknown) else _WRONG, str(error))


def _error(status: int, text: str, **more: Any) -> JSONResponse:
    return JSONResponse(plain({"error": text, **more}), status)


def _streaming(
    served: Served, texts_of: Callable[[Watcher, Request], Awaitable[AsyncIterator[str]]]
) -> Callable[[Request], Awaitable[Response]]:  # fmt: skip
    async def handle(request: Request) -> Response:
        try:
            texts = await texts_of(served.watcher(request), request)
        except (Refused, Faulty, NoAnswer) as error:
            return _failed(error)
        return StreamingResponse(texts, media_type="text/event-stream")

    return handle


async def _events(watcher: Watcher, request: Request) -> AsyncIterator[str]:
    return watcher.events.listen(*watcher.first)


async def _log_events(watcher: Watcher, request: Request) -> AsyncIterator[str]:
    names = watcher.chosen(request.query_params.getlist("name"))
    lines = watcher.log_lines(names, commands.number(request.query_params, "last", 20))
    return (ServerEvent("line", line).text async for line in lines)


async def _topic(watcher: Watcher, request: Request) -> AsyncIterator[str]:
    found = await watcher.topics.find(request.query_params.get("topic", ""))
    return watcher.topics.texts(*await watcher.topics.open(*found))
