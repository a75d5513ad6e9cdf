"""Commands of the editor: compile a workspace, and merge changes into the user's code."""

from __future__ import annotations

import uuid

from lsprotocol import types

from robocomp_yaml import api
from robocomp_yaml.api.outcome import CHANGED
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.lsp.messages import real_path
from robocomp_yaml.lsp.server import Server

COMPILE, MERGE = "rcyaml.compile", "rcyaml.merge"
TITLES = {COMPILE: "Compile this workspace", MERGE: "Compile this workspace, and merge changes into your code"}
SOURCE = types.CodeActionKind.Source


def actions(uri: str) -> list[types.CodeAction]:
    """The commands, as actions of a document."""
    return [
        types.CodeAction(title, SOURCE, command=types.Command(title, command, arguments=[uri]))
        for command, title in TITLES.items()
    ]


def add(server: Server) -> None:
    for name in TITLES:
        _add(server, name)


def _add(server: Server, name: str) -> None:
    @server.command(name)
    async def run(uri: str) -> str:
        path = real_path(uri) or ""
        token = await _begin(server, TITLES[name])
        try:
            kind, text = await server.run(lambda: _run(server, path, merge=name == MERGE))
        except (Refused, Faulty) as refused:
            kind, text = types.MessageType.Error, str(refused)
        finally:
            if token is not None:
                server.work_done_progress.end(token, types.WorkDoneProgressEnd())
        server.window_show_message(types.ShowMessageParams(kind, f"rcyaml: {text}"))
        await server.saved()
        return text


async def _begin(server: Server, title: str) -> str | None:
    """Shows that something is being done, if the editor can."""
    window = server.client_capabilities.window
    if window is None or not window.work_done_progress:
        return None
    token = str(uuid.uuid4())
    await server.work_done_progress.create_async(token)
    server.work_done_progress.begin(token, types.WorkDoneProgressBegin(title))
    return token


def _run(server: Server, path: str, *, merge: bool) -> tuple[types.MessageType, str]:
    """Compiles the workspace of a document, as it is on the disk."""
    session = server.session
    if path not in session.open:
        raise Refused(f"{path or 'the document'} is not open")
    root = session.root_of(path)
    for one in (*session.open.values(), *session.code.values()):
        if session.root_of(one.path) == root and not one.is_saved:
            raise Refused(f"save {one.path} first: files on the disk are compiled")
    compiled = api.load(root, include=session.include).compile(merge=merge)
    errors = [one for one in compiled.diagnostics if one.severity == api.ERROR]
    if compiled.has_errors:
        first = f": {errors[0].message}" if errors else ""
        return types.MessageType.Error, f"nothing was written, because of {len(errors)} errors{first}"
    outcome = compiled.apply()
    if outcome.has_errors:
        return types.MessageType.Error, next(one for one in outcome.diagnostics if one.severity == api.ERROR).message
    count = sum(one.action in CHANGED for one in outcome.files)
    done = f"compiled, {count} file{'' if count == 1 else 's'} written" if count else "compiled, nothing has changed"
    return types.MessageType.Info, done
