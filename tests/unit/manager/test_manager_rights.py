"""What each command of the manager needs: a right that `--read-only` and `--operate` have or not."""

from __future__ import annotations

import asyncio
import json
from functools import cache
from typing import Any

import pytest

pytest.importorskip("starlette", reason="pip install rcyaml[manager]")

from starlette.types import Message

from robocomp_yaml.manager.access import API, EDIT, OPERATE, READ, AccessRules, Guard
from robocomp_yaml.manager.app import application
from robocomp_yaml.manager.commands import Command
from robocomp_yaml.manager.table import COMMANDS

CHANGING = {"up", "restart", "down", "rollback", "call", "parameters", "push"}
EDITING = {"edit", "undo", "redo", "write", "positions"}
ONLY_ASKING = {"diagnose", "completion"}  # POST, because an unsaved text does not fit into an address


@cache
def manager(rights: tuple[str, ...]) -> Guard:
    return application({}, AccessRules("t", rights=rights))


def ask(app: Guard, command: Command) -> tuple[int, dict[str, Any]]:
    path = API + command.path.replace("{deployment}", "Robot")
    scope: dict[str, Any] = {
        "type": "http", "method": command.method, "path": path, "raw_path": path.encode(), "query_string": b"",
        "scheme": "http", "http_version": "1.1", "server": ("127.0.0.1", 7410), "root_path": "",
        "headers": [(b"host", b"127.0.0.1:7410"), (b"authorization", b"Bearer t")],
    }  # fmt: skip
    messages: list[Message] = []

    async def receive() -> Message:
        return {"type": "http.request", "body": b"not JSON"}

    async def send(message: Message) -> None:
        messages.append(message)

    asyncio.run(app(scope, receive, send))
    return messages[0]["status"], json.loads(b"".join(one.get("body", b"") for one in messages[1:]))


@pytest.mark.parametrize("rights", [(READ,), (READ, OPERATE), (READ, OPERATE, EDIT)], ids=len)
@pytest.mark.parametrize("command", COMMANDS, ids=lambda one: f"{one.method}-{one.path.rpartition('/')[2]}")
def test_a_command_needs_its_right(command: Command, rights: tuple[str, ...]) -> None:
    """What is let through gets to the body, or to the name of the deployment, which are wrong."""
    status, answer = ask(manager(rights), command)
    expected = {403} if command.right not in rights else {200} if command.path == "/deployments" else {400, 404}
    assert status in expected, answer


def test_each_command_that_changes_something_needs_more_than_looking() -> None:
    found = {
        right: {one.path.rpartition("/")[2] for one in COMMANDS if one.right == right and one.method == "POST"}
        for right in (READ, OPERATE, EDIT)
    }
    assert found == {READ: ONLY_ASKING, OPERATE: CHANGING, EDIT: EDITING}
    assert {one.right for one in COMMANDS if one.method == "GET"} == {READ}
