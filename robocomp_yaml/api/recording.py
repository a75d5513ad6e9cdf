"""Messages of topics in files: recorded as MCAP with Protobuf, shown, and published again.

A file is complete, with its index, after each checkpoint: if the recorder is killed, what came since the last one is
missing, and every reader of MCAP reads the rest. https://mcap.dev/spec
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Collection, Generator, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from typing import TYPE_CHECKING, Any

import msgspec

from robocomp_yaml import __version__
from robocomp_yaml.api.refusals import cannot_write
from robocomp_yaml.diag import extras
from robocomp_yaml.diag.errors import Refused, reason_of

if TYPE_CHECKING:
    from robocomp_yaml.api.topics import KnownTopic, Message, Publisher, Topics
    from robocomp_yaml.wire.protobuf import MessageType

OURS, DROPPED = "rcyaml", "rcyaml.dropped"
"""Metadata of a file: who recorded it, and the number of messages that were dropped, by topic."""

_SHORTEST, _LONGEST = 1.0, 10.0  # seconds between checkpoints
_MOST_UNWRITTEN = 8 << 20  # bytes
_CHUNK = 1 << 20  # bytes of messages that are compressed together
_HEAD = 47  # bytes of a message in a file, besides its data: 31, and 16 in the index of its chunk
_ROOM, _OF_TOPIC = 256, 32  # bytes for what is written at the end: in all, and for a topic besides its name
_OF_CHUNK, _OF_CHANNEL = 160, 40  # bytes of a chunk and its index: in all, and for a channel


def _require() -> None:
    from importlib.util import find_spec

    if find_spec("mcap") is None or find_spec("google.protobuf") is None:
        raise Refused(f"recording needs MCAP and Protobuf: {extras.command('record')}")


class Recorder:
    """Writes the messages of topics to a new file, which will have at most `max_size` bytes. Raises Refused if the file
    exists, or cannot be created, or would be too large without messages; later, methods raise OSError if it cannot be
    written."""

    def __init__(
        self, path: str, topics: Sequence[KnownTopic], deployment: str = "", max_size: int | None = None
    ) -> None:
        _require()
        from mcap.writer import Writer

        self.path, self.messages, self._max_size = path, 0, max_size
        self._pending = self._index = 0  # bytes: of messages that are in no chunk yet, and of the index
        try:
            self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        except FileExistsError:
            raise Refused(f"{path} exists already, and is kept as it is: name another file with -o") from None
        except OSError as error:
            raise cannot_write(path, error) from None
        self._stream = _Stream(self._file)
        self._writer = Writer(self._stream, chunk_size=_CHUNK, use_summary_offsets=False)
        self._writer.start("", f"rcyaml {__version__}")
        self._writer.add_metadata(OURS, {"version": __version__, "deployment": deployment})
        self._types: dict[tuple[str, str, str], tuple[int, MessageType]] = {}
        self._began = self._written = time.monotonic()
        for topic in topics:
            self._register(topic)
        self._at_end = _ROOM + sum(_OF_TOPIC + len(one.name.encode()) for one in topics)
        self.checkpoint()
        if max_size is not None and (least := self._longest(0)) > max_size:
            os.close(self._file)
            os.unlink(path)
            raise Refused(f"a file of these topics has at least {least} bytes: --max-size must be larger")

    def _register(self, topic: KnownTopic) -> None:
        from robocomp_yaml.api.topics import wire_interface
        from robocomp_yaml.wire.protobuf import MessageType

        interface = wire_interface(topic)
        for operation in interface.operations.values():
            made = MessageType(interface, operation)
            schema = self._writer.register_schema(made.name, "protobuf", made.schema)
            about = {"topic": topic.name, "method": operation.name, "carries": topic.type, "storm": topic.storm}
            channel = self._writer.register_channel(f"{topic.name}/{operation.name}", "protobuf", schema, about)
            self._types[topic.storm, topic.name, operation.name] = channel, made

    @property
    def size(self) -> int:
        """The size of the file at the last checkpoint, in bytes."""
        return self._stream.end - self._stream.unwritten + self._index

    def add(self, message: Message) -> bool:
        """Adds a message; False if the file would be too large with it."""
        channel, type_ = self._types[message.topic.storm, message.topic.name, message.operation.name]
        at, data = int(message.time * 1e9), type_.encode(message.values)
        if self._max_size is not None and not self._fits(len(data) + _HEAD, self._max_size):
            return False
        self._writer.add_message(channel, at, data, at, self.messages & 0xFFFFFFFF)
        self._pending += len(data) + _HEAD
        self.messages += 1
        return True

    def _fits(self, more: int, most: int) -> bool:
        """Whether there is room for more bytes. How small the compressor makes them is known after a checkpoint."""
        if self._longest(more) <= most:
            return True
        if not self.messages or self._pending < most // 100:
            return False
        self.checkpoint()
        return self._fits(more, most)

    def _longest(self, more: int) -> int:
        """The largest size that the file can have after `close`, with so many more bytes of messages."""
        pending = self._pending + more
        chunks = (pending // _CHUNK + 1) * (_OF_CHUNK + _OF_CHANNEL * len(self._types))
        return self._stream.end + self._index + pending + chunks + self._at_end

    def checkpoint_if_due(self) -> None:
        """Writes a checkpoint each second, in long recordings less often, because each one contains the index."""
        now = time.monotonic()
        due = self._written + min(_LONGEST, max(_SHORTEST, (now - self._began) / 100))
        if now >= due or self._stream.unwritten > _MOST_UNWRITTEN:
            self.checkpoint()

    def checkpoint(self) -> None:
        """Completes the file on the disk. Raises OSError if it cannot be written; what it contained before stays."""
        self._writer.flush()
        end = self._stream.end
        self._writer.finish()
        self._index = self._stream.end - end
        # the first chunk also has the types, as the index does; MCAP writes no chunk before the first message
        self._pending = 0 if self.messages else self._index
        self._stream.write_out(end)
        self._written = time.monotonic()

    def close(self, dropped: Mapping[str, int]) -> None:
        """Completes the file, with the numbers of dropped messages by topic. Raises OSError."""
        try:
            self._writer.add_metadata(DROPPED, {name: str(number) for name, number in sorted(dropped.items())})
            self.checkpoint()
        finally:
            os.close(self._file)


class _Stream:
    """A file as MCAP's writer uses it: what is written is collected, and written out in one step."""

    def __init__(self, file: int) -> None:
        self._file, self._start, self._buffer = file, 0, bytearray()
        self._index = b""  # the end of the file, from `_start` on

    def write(self, data: bytes) -> int:
        self._buffer += data
        return len(data)

    def tell(self) -> int:
        return self.end

    def flush(self) -> None:
        """Nothing is written out before a checkpoint."""

    @property
    def end(self) -> int:
        return self._start + len(self._buffer)

    @property
    def unwritten(self) -> int:
        return len(self._buffer)

    def write_out(self, end: int) -> None:
        """Writes everything. What is after `end`, the index, will be replaced by what is written next. Raises OSError
        if that is not possible; the file is as before then."""
        data, at = bytes(self._buffer), self._start
        index = data[end - at :]
        try:
            self._put(data, at)
        except OSError:
            self._put(self._index, at)  # its space is there
            raise
        self._start, self._buffer, self._index = end, bytearray(), index

    def _put(self, data: bytes, at: int) -> None:
        rest = memoryview(data)
        while rest:
            number = os.pwrite(self._file, rest, at)
            rest, at = rest[number:], at + number
        os.ftruncate(self._file, at)


class RecordedTopic(msgspec.Struct, frozen=True):
    """What a file has of one message of a topic. `channel` is MCAP's name for it; `topic` and `method` are '' in a file
    that rcyaml did not record."""

    channel: str
    type: str
    messages: int
    topic: str = ""
    method: str = ""


class RecordingInfo(msgspec.Struct, frozen=True):
    """What a file contains. Times are in seconds since the epoch. `dropped` are the numbers of messages that were
    dropped, by topic; None if they are unknown, because the recorder still runs, or was killed."""

    path: str
    size: int
    messages: int
    begin: float
    end: float
    topics: tuple[RecordedTopic, ...]
    deployment: str = ""
    dropped: dict[str, int] | None = None


def info(path: str) -> RecordingInfo:
    """What a file contains. Raises Refused if it is not an MCAP file."""
    with _reading(path) as reader:
        summary = reader.get_summary()
        if summary is None or summary.statistics is None:
            raise Refused(f"{path} has no index: it was not recorded by rcyaml, and `mcap recover` may repair it")
        metadata = {one.name: one.metadata for one in reader.iter_metadata()}
        statistics = summary.statistics
        topics = [
            RecordedTopic(
                channel.topic,
                schema.name if (schema := summary.schemas.get(channel.schema_id)) else "",
                statistics.channel_message_counts.get(number, 0),
                channel.metadata.get("topic", ""),
                channel.metadata.get("method", ""),
            )
            for number, channel in sorted(summary.channels.items())
        ]
    dropped = metadata.get(DROPPED)
    return RecordingInfo(
        path, os.path.getsize(path), statistics.message_count, statistics.message_start_time / 1e9,
        statistics.message_end_time / 1e9, tuple(topics), metadata.get(OURS, {}).get("deployment", ""),
        {name: int(number) for name, number in dropped.items()} if dropped is not None else None,
    )  # fmt: skip


@contextmanager
def _reading(path: str) -> Iterator[Any]:
    """An MCAP reader of a file. Raises Refused if the file is not a whole MCAP file, also while it is read."""
    _require()
    from mcap.reader import make_reader

    try:
        with open(path, "rb") as file:
            yield make_reader(file)
    except OSError as error:
        raise Refused(f"cannot read {path}: {reason_of(error)}") from None
    except (Refused, GeneratorExit):
        raise
    except Exception:  # noqa: BLE001 - the library has another exception for each kind of damage
        raise Refused(f"{path} is not an MCAP file, or not a whole one") from None


def _messages(path: str) -> Generator[tuple[Any, Any, Any]]:
    """The messages of a file, in their order in time. Raises Refused if it is damaged."""
    with _reading(path) as reader:
        yield from reader.iter_messages(log_time_order=True)


class Player:
    """Publishes what a file contains, in a network: the recorded topics with these names, by default all. Raises
    Refused if a topic is unknown there, or carries something else now."""

    def __init__(self, path: str, topics: Topics, names: Collection[str] = ()) -> None:
        self.path, self._topics = path, topics
        self.info = info(path)
        recorded = {one.topic for one in self.info.topics if one.topic}
        for name in names:
            if name not in recorded:
                raise Refused(f"{path} has no topic '{name}'; it has {', '.join(sorted(recorded)) or 'none of rcyaml'}")
        self._chosen = set(names) or recorded
        if not self._chosen:
            raise Refused(f"{path} has no topics that rcyaml recorded")
        self.known: dict[str, KnownTopic] = {}

    def play(self, rate: float, on_message: Callable[[int], None] = lambda number: None) -> int:
        """Publishes in the recorded times, `rate` times as fast; 0 as fast as possible. Returns the number of messages.
        Raises NoAnswer."""
        with ExitStack() as stack, closing(_messages(self.path)) as messages:
            senders: dict[int, tuple[Publisher, MessageType]] = {}
            began, first, sent = time.monotonic(), 0, 0
            for schema, channel, message in messages:
                if channel.metadata.get("topic") not in self._chosen:
                    continue
                if channel.id not in senders:
                    senders[channel.id] = self._sender(stack, channel, schema)
                    if not sent:
                        began = time.monotonic()
                first = first or message.log_time
                if rate:
                    pause = began + (message.log_time - first) / 1e9 / rate - time.monotonic()
                    if pause > 0:
                        time.sleep(pause)
                publisher, type_ = senders[channel.id]
                publisher.publish(type_.operation, type_.decode(message.data))
                sent += 1
                on_message(sent)
            return sent

    def _sender(self, stack: ExitStack, channel: Any, schema: Any) -> tuple[Publisher, MessageType]:
        from robocomp_yaml.api.topics import wire_interface
        from robocomp_yaml.wire.protobuf import MessageType

        name, method = channel.metadata["topic"], channel.metadata["method"]
        if name not in self.known:
            self.known[name], _ = self._topics.find_or(name, channel.metadata.get("carries", ""))
        topic = self.known[name]
        interface = wire_interface(topic)
        operation = interface.operations.get(method)
        type_ = MessageType(interface, operation) if operation is not None else None
        if type_ is None or type_.schema != schema.data:
            raise Refused(f"{self.path} was recorded with another version of {topic.type}: '{method}' differs")
        return stack.enter_context(self._topics.publisher(topic)), type_


def default_path(name: str) -> str:
    """The name of a new file: of the deployment, with the time."""
    return f"{name or 'recording'}-{time.strftime('%Y%m%d-%H%M%S')}.mcap"
