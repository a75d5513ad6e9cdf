"""The description of the manager's commands in OpenAPI 3.1 (https://spec.openapis.org/oas/v3.1.1.html)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import msgspec

from robocomp_yaml.manager.access import READ
from robocomp_yaml.manager.commands import Command

_ERRORS = {
    "400": "The request is wrong, or not possible.",
    "403": "The token is missing, or the manager was started without this right.",
    "404": "There is no such deployment.",
    "413": "The request is too large.",
    "409": "The document was changed by somebody else: `theirs` is its text, `ours` what the change would have made.",
    "422": "The documents have errors, or an operation failed: see `diagnostics`.",
    "502": "A component does not answer.",
}
_EVENTS = (
    ("events", "Server-sent events: `states`, with the rates of topics to which somebody listens, "
     "`documents`, `progress` and `happened`.", ()),
    ("log-events", "Server-sent events: the last lines of the logs, and all that follow, as `line`.",
     (("name", "A process or group; may be repeated. Without it, all."),
      ("last", "The number of lines of each process; by default 20."))),
    ("topic", "Server-sent events: each message of a topic as it comes, as `message`; if they come too fast, not all. "
     "`storm`: its IceStorm does not answer, or does again.",
     (("topic", "The topic, or one of its messages after a dot, as for `rcyaml topic echo`."),)),
)  # fmt: skip


def described(commands: Sequence[Command], prefix: str, version: str) -> dict[str, Any]:
    """The description of these commands, whose paths follow the prefix."""
    bodies = [command.body for command in commands if command.body is not None]
    schemas, parts = msgspec.json.schema_components(bodies, ref_template="#/components/schemas/{name}")
    by_type = dict(zip(bodies, schemas, strict=True))
    paths: dict[str, dict[str, Any]] = {}
    for command in commands:
        paths.setdefault(prefix + command.path, {})[command.method.lower()] = _operation(command, by_type)
    for name, does, query in _EVENTS:
        stream = {"200": {"description": does, "content": {"text/event-stream": {"schema": {"type": "string"}}}}}
        path = f"{prefix}/deployments/{{deployment}}/{name}"
        paths[path] = {"get": {"operationId": name.replace("-", "_"), "summary": does,
                               "parameters": _parameters(path, query), "responses": stream}}  # fmt: skip
    return {
        "openapi": "3.1.0",
        "info": {"title": "rcyaml manager", "version": version},
        "paths": paths,
        "components": {
            "schemas": parts,
            "securitySchemes": {"token": {"type": "http", "scheme": "bearer"}},
        },
        "security": [{"token": []}],
    }


def _operation(command: Command, schemas: dict[type[msgspec.Struct], Any]) -> dict[str, Any]:
    """One command. Its name is that of the end of its path, and of the method if it changes something."""
    end = command.path.rpartition("/")[2]
    content = {"application/json": {"schema": {"type": "object"}}}
    made: dict[str, Any] = {
        "operationId": end if command.right == READ else f"{command.method.lower()}_{end}",
        "summary": command.does,
        "tags": [command.right],
        "parameters": _parameters(command.path, command.query),
        "responses": {
            "200": {"description": command.does, "content": content},
            **{status: {"description": text, "content": content} for status, text in _ERRORS.items()},
        },
    }
    if command.body is not None:
        made["requestBody"] = {"content": {"application/json": {"schema": schemas[command.body]}}}
    return made


def _parameters(path: str, query: Sequence[tuple[str, str]]) -> list[dict[str, Any]]:
    text = {"type": "string"}
    return [
        *({"name": name, "in": "path", "required": True, "schema": text} for name in re.findall(r"{(\w+)}", path)),
        *(
            {"name": name, "in": "query", "description": means,
             "schema": {"type": "array", "items": text} if "repeated" in means else text}
            for name, means in query
        ),
    ]  # fmt: skip
