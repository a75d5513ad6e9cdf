"""Topics of a network as server-sent events: what `rcyaml topic echo` prints, for any number of listeners.

A topic has one subscription, whatever the number of its listeners. It ends with the last of them. Messages are sent in
batches, and not all of them if they come too fast for a page.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Mapping
from typing import TYPE_CHECKING, Any

from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.render.json import plain
from robocomp_yaml.manager.events import ServerEvent

if TYPE_CHECKING:
    from robocomp_yaml.api.topics import KnownTopic, Message, StormChange, Topics

MESSAGE, STORM = "message", "storm"
_EVERY = 0.1  # seconds between two batches
_MOST = 50  # messages in a batch: the last ones
_LARGEST = 100_000  # characters of a value
_PULSE = 15.0
_WINDOW = 3.0  # seconds over which a rate is measured
_LISTENERS = 64  # of one deployment


class TopicFeed:
    """The subscription to one topic. `arrived` are the times of the last messages; `storm` is the last change of its
    IceStorm, which went away or came back."""

    def __init__(self, topics: Topics, topic: KnownTopic) -> None:
        self.topic, self.arrived = topic, deque[float](maxlen=20_000)
        self.queues: list[deque[Message]] = []
        self.storm: StormChange | None = None
        self._topics = topics
        self._context: contextlib.AbstractContextManager[None] | None = None

    def open(self) -> None:
        """Blocks. Raises NoAnswer."""
        context = self._topics.listening([self.topic], self._add, self._change)
        context.__enter__()
        self._context = context

    def close(self) -> None:
        """Blocks."""
        context, self._context = self._context, None
        if context is not None:
            context.__exit__(None, None, None)

    def _add(self, message: Message) -> None:
        """In a thread of Ice."""
        self.arrived.append(message.clock)
        for queue in tuple(self.queues):
            queue.append(message)

    def _change(self, change: StormChange) -> None:
        """In a thread."""
        self.storm = change

    @property
    def rate(self) -> float:
        """Messages per second."""
        since = time.monotonic() - _WINDOW
        return round(sum(1 for clock in tuple(self.arrived) if clock > since) / _WINDOW, 1)


class TopicFeeds:
    """The topics of one deployment to which somebody listens."""

    def __init__(self, make: Callable[[], Topics]) -> None:
        self._make = make
        self._feeds: dict[str, TopicFeed] = {}
        self._lock = asyncio.Lock()

    @property
    def is_full(self) -> bool:
        return sum(len(feed.queues) for feed in self._feeds.values()) >= _LISTENERS

    @property
    def rates(self) -> Mapping[str, dict[str, float]]:
        return {name: {"rate": feed.rate} for name, feed in self._feeds.items()}

    async def find(self, text: str) -> tuple[Topics, KnownTopic, str]:
        """The topic that a text means, and the name of a message or ''. Raises Refused and Faulty."""

        def work() -> tuple[Topics, KnownTopic, str]:
            topics = self._make()
            return topics, *topics.find(text)

        return await asyncio.to_thread(work)

    async def open(self, topics: Topics, topic: KnownTopic, method: str) -> tuple[TopicFeed, deque[Message], str]:
        """The feed of a topic, with a queue of its own. Raises NoAnswer, and Refused if there are too many."""
        if self.is_full:
            raise Refused(f"there are {_LISTENERS} listeners to topics already")
        queue: deque[Message] = deque(maxlen=_MOST)
        async with self._lock:
            feed = self._feeds.get(topic.name)
            if feed is None:
                feed = TopicFeed(topics, topic)
                await asyncio.to_thread(feed.open)
                self._feeds[topic.name] = feed
            feed.queues.append(queue)
        return feed, queue, method

    async def leave(self, feed: TopicFeed, queue: deque[Message]) -> None:
        async with self._lock:
            feed.queues = [one for one in feed.queues if one is not queue]
            if not feed.queues:
                self._feeds.pop(feed.topic.name, None)
                with contextlib.suppress(Exception):
                    await asyncio.to_thread(feed.close)

    async def texts(self, feed: TopicFeed, queue: deque[Message], method: str) -> AsyncIterator[str]:
        """The events for one listener, until it leaves. `method` is the only message that is sent, '' for all."""
        quiet = 0.0
        storm = feed.storm if feed.storm is not None and feed.storm.error is None else None  # that is over
        try:
            yield ": listening\n\n"
            while True:
                await asyncio.sleep(_EVERY)
                found = [queue.popleft() for _ in range(len(queue))]
                wanted = [one for one in found if method in ("", one.operation.name)]
                quiet = 0.0 if wanted else quiet + _EVERY
                if wanted:
                    yield await asyncio.to_thread(_as_text, wanted)
                if feed.storm is not None and feed.storm is not storm:
                    storm = feed.storm
                    yield ServerEvent(STORM, {"text": storm.text}).text
                elif quiet > _PULSE:
                    quiet = 0.0
                    yield ": still here\n\n"
        finally:
            await asyncio.shield(self.leave(feed, queue))


def _as_text(messages: list[Message]) -> str:
    return "".join(ServerEvent(MESSAGE, _as_data(one)).text for one in messages)


def _as_data(message: Message) -> dict[str, Any]:
    data = message.data
    made = {"topic": data["topic"], "time": data["time"], "method": data["method"], "value": plain(data["arguments"])}
    size = len(str(made["value"]))
    return made if size <= _LARGEST else {**made, "value": None, "size": size}
