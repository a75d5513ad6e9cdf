"""The description of the commands, and the text of events."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest

pytest.importorskip("starlette", reason="pip install rcyaml[manager]")

from robocomp_yaml.api.editing import changes
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.manager import requests
from robocomp_yaml.manager.description import described
from robocomp_yaml.manager.events import Events, ServerEvent
from robocomp_yaml.manager.table import COMMANDS

DESCRIPTION = described(COMMANDS, "/api", "1")


def test_every_command_is_described_once() -> None:
    operations = [one for path in DESCRIPTION["paths"].values() for one in path.values()]
    assert len(operations) == len(COMMANDS) + 3  # and the streams
    assert len({one["operationId"] for one in operations}) == len(operations)
    json.dumps(DESCRIPTION)


def test_all_references_lead_somewhere() -> None:
    def references(data: Any) -> list[str]:
        if isinstance(data, dict):
            own = [data["$ref"]] if "$ref" in data else []
            return own + [found for value in data.values() for found in references(value)]
        return [found for item in data for found in references(item)] if isinstance(data, list) else []

    found = references(DESCRIPTION)
    assert found
    for reference in found:
        assert reference.rpartition("/")[2] in DESCRIPTION["components"]["schemas"], reference


def test_all_changes_are_described() -> None:
    schema = DESCRIPTION["components"]["schemas"]["EditRequest"]["properties"]["change"]
    named = {one["$ref"].rpartition("/")[2] for one in schema["anyOf"]}
    assert named == {type_.__name__ for type_ in changes.DocumentChange.__args__}
    assert DESCRIPTION["components"]["schemas"]["Connect"]["properties"]["change"] == {"enum": ["connect"]}
    assert {"interface", "component", "change"} == DESCRIPTION["components"]["schemas"]["Require"]["properties"].keys()


def test_requests_that_mean_nothing_are_refused() -> None:
    assert requests.read(b"", requests.OperationRequest) == requests.OperationRequest()
    for body in (b"[]", b"{", b'{"nams": []}', b'{"names": 1}', b"\xff", b'{"on_failure": "explode"}'):
        with pytest.raises(Refused):
            requests.read(body, requests.OperationRequest)


def test_events_are_lines_that_nothing_breaks() -> None:
    text = ServerEvent("line", {"text": "a\nevent: evil\n\r\u2028<b>"}).text
    assert text.splitlines() == ["event: line", 'data: {"text": "a\\nevent: evil\\n\\r\\u2028<b>"}', ""]


def test_listeners_get_what_comes_after_them_until_the_end() -> None:
    async def main() -> list[str]:
        events, found = Events(), list[str]()

        async def listen() -> None:
            async for text in events.listen(ServerEvent("states", 0)):
                found.append(text.splitlines()[1])

        events.send("states", "before")
        listening = asyncio.create_task(listen())
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        events.happened("arm", "ready")
        events.send("states", 1)
        events.end()
        await listening
        assert not events.has_listeners
        assert [one["text"] for one in events.past] == ["ready"]
        return found

    first, happened, last = asyncio.run(main())
    assert (first, last) == ("data: 0", "data: 1")
    assert '"name": "arm", "text": "ready"' in happened


def test_a_listener_that_does_not_read_is_left() -> None:
    async def main() -> int:
        events = Events()
        listening = events.listen(ServerEvent("states", 0))
        await anext(listening)
        waiting = asyncio.create_task(anext(listening))
        await asyncio.sleep(0)
        for number in range(3000):
            events.send("states", number)
        assert not events.has_listeners
        await waiting
        return len([text async for text in listening])

    assert asyncio.run(main()) < 1100
