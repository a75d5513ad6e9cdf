"""Messages of topics that arrive while a command runs."""

from __future__ import annotations

import queue
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _signals

if TYPE_CHECKING:
    from robocomp_yaml.api.topics import KnownTopic, Message, StormChange, Topics

MOST_WAITING = 20_000  # messages that arrived and are not handled yet; later ones are dropped, and counted


class Arriving:
    """Messages that arrived. `dropped` are those for which there was no room."""

    def __init__(self, methods: dict[str, set[str]], end: float | None) -> None:
        self._queue: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self._methods, self._end = methods, end
        self.dropped: Counter[str] = Counter()

    def add(self, message: Message) -> None:
        methods = self._methods[message.topic.name]
        if methods and message.operation.name not in methods:
            return
        if self._queue.qsize() >= MOST_WAITING:
            self.dropped[message.topic.name] += 1
        else:
            self._queue.put(message)

    @property
    def may_continue(self) -> bool:
        return self._end is None or time.monotonic() < self._end

    def until(self, end: float | None, most: int | None) -> Iterator[Message]:
        """The messages that arrive until a time."""
        number = 0
        while most is None or number < most:
            ends = [one for one in (end, self._end) if one is not None]
            left = min(ends) - time.monotonic() if ends else None
            try:
                yield self._queue.get(timeout=max(0.0, left) if left is not None else 3600)
            except queue.Empty:
                if ends:
                    return
                continue
            number += 1

    def drain(self, most: int | None) -> Sequence[Message]:
        """What has arrived."""
        number = self._queue.qsize() if most is None else min(most, self._queue.qsize())
        return [self._queue.get() for _ in range(number)]

    def show(self, show: Callable[[Sequence[Message]], None], count: int | None) -> None:
        """Calls a function with what arrives, as much as there is at a time."""
        shown = 0
        while count is None or shown < count:
            most = None if count is None else count - shown
            first = list(self.until(None, 1))
            if not first:
                return
            batch = [*first, *self.drain(1000 if most is None else most - 1)]
            shown += len(batch)
            show(batch)


Chosen = Sequence[tuple["KnownTopic", str]]
"""Topics, each with the name of a message, or '' for all of its messages."""


@contextmanager
def arriving_messages(topics: Topics, chosen: Chosen, duration: float | None) -> Iterator[Arriving]:
    """What arrives while the context lasts. The subscriptions end however it ends. Exit code 1 where an IceStorm does
    not answer at the end."""
    from robocomp_yaml.diag import terminal

    away = set[str]()

    def on_storm(change: StormChange) -> None:
        (away.add if change.error else away.discard)(change.storm)
        terminal.say(change.text, err=True)

    methods: dict[str, set[str]] = {topic.name: set() for topic, _ in chosen}
    whole = {topic.name for topic, method in chosen if not method}
    for topic, method in chosen:
        if topic.name not in whole:
            methods[topic.name].add(method)
    distinct = list({(topic.name, topic.storm): topic for topic, _ in chosen}.values())
    arriving = Arriving(methods, time.monotonic() + duration if duration else None)
    with _signals.hangup_handled(), topics.listening(distinct, arriving.add, on_storm):
        try:
            yield arriving
        finally:
            if number := arriving.dropped.total():
                terminal.say(f"{number} messages were dropped: they came too fast", err=True)
    if away:
        click.get_current_context().exit(1)
