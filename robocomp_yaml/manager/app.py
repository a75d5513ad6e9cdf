"""The application: commands as JSON, events, the description of both, and the files of the page."""

from __future__ import annotations

import asyncio
import math
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
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.manager import commands
from robocomp_yaml.manager.access import READ, SAFE_METHODS, AccessRules, Guard
from robocomp_yaml.manager.commands import Command, Served
from robocomp_yaml.manager.description import described
from robocomp_yaml.manager.events import ServerEvent
from robocomp_yaml.manager.watching import Watcher

API = "/api"
_CONFLICT, _WRONG, _FAULTY, _SILENT = 409, 400, 422, 502


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

    description = described(commands.COMMANDS, API, __version__)

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
        *(
            Route(API + one.path, _handler(one, served, rules.rights), methods=[one.method])
            for one in commands.COMMANDS
        ),
        Route(f"{API}/deployments/{{deployment}}/events", _events(served), methods=["GET"]),
        Route(f"{API}/deployments/{{deployment}}/log-events", _log_events(served), methods=["GET"]),
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
            return JSONResponse(_plain(await command.run(served, request)))
        except EditConflict as conflict:
            return _error(_CONFLICT, str(conflict), theirs=conflict.theirs, ours=conflict.ours)
        except Refused as refused:
            return _error(404 if isinstance(refused, commands.Unknown) else _WRONG, str(refused))
        except Faulty as faulty:
            return _error(_FAULTY, str(faulty), diagnostics=[as_data(one) for one in faulty.diagnostics])
        except NoAnswer as error:
            return _error(_SILENT, error.message, hint=error.hint)

    return handle


def _error(status: int, text: str, **more: Any) -> JSONResponse:
    return JSONResponse(_plain({"error": text, **more}), status)


def _plain(data: Any) -> Any:
    """Data that JSON can spell: bytes of names that are not UTF-8, and numbers that are none, are texts."""
    if isinstance(data, str):
        return data.encode("utf-8", "backslashreplace").decode()
    if isinstance(data, Mapping):
        return {_plain(key): _plain(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_plain(item) for item in data]
    if isinstance(data, float) and not math.isfinite(data):
        return str(data)
    return data


def _events(served: Served) -> Callable[[Request], Awaitable[Response]]:
    async def handle(request: Request) -> Response:
        try:
            watcher = served.watcher(request)
        except Refused as refused:
            return _error(404, str(refused))
        return _stream(watcher.events.listen(*watcher.first))

    return handle


def _log_events(served: Served) -> Callable[[Request], Awaitable[Response]]:
    async def handle(request: Request) -> Response:
        try:
            watcher = served.watcher(request)
            names = watcher.chosen(request.query_params.getlist("name"))
        except Refused as refused:
            return _error(404, str(refused))

        async def texts() -> AsyncIterator[str]:
            async for line in watcher.log_lines(names, commands.number(request, "last", 20)):
                yield ServerEvent("line", line).text

        return _stream(texts())

    return handle


def _stream(texts: AsyncIterator[str]) -> StreamingResponse:
    return StreamingResponse(texts, media_type="text/event-stream")
