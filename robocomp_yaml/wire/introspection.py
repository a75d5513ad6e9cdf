"""The facet with which generated components describe themselves (`templates/slice/RcYaml.ice`), as bytes of Ice.

This needs no Ice: many processes are asked at once, also where Ice is not installed.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from typing import TypeVar

import msgspec

from robocomp_yaml.wire.protocol import size, text

FACET = "rcyaml"
REPORT, HEARTBEAT = "report", "getHeartbeat"
STATE, WORKER, CALLS, TOPICS, BUILD, INTERFACES = "state", "worker", "calls", "topics", "build", "interfaces"

STARTING, WAITING, RUNNING, STOPPING, FAILED = "starting", "waiting", "running", "stopping", "failed"
"""The states of a component."""

Value = TypeVar("Value")


class Facts(msgspec.Struct, frozen=True):
    """What a component knows of one thing. Times are in seconds."""

    name: str
    texts: dict[str, str]
    numbers: dict[str, float]


Sections = dict[str, list[Facts]]


def names(sections: Iterable[str]) -> bytes:
    """The parameter of `report`."""
    texts = [text(section) for section in sections]
    return size(len(texts)) + b"".join(texts)


def sections_of(result: bytes) -> Sections:
    """What `report` returned. Raises ValueError if it is not valid."""
    reader = _Reader(result)
    try:
        return reader.mapping(lambda: reader.sequence(reader.facts))
    except (struct.error, IndexError) as error:
        raise ValueError("the answer is shorter than expected") from error


class _Reader:
    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def mapping(self, value: Callable[[], Value]) -> dict[str, Value]:
        return {self._text(): value() for _ in range(self._size())}

    def sequence(self, element: Callable[[], Value]) -> list[Value]:
        return [element() for _ in range(self._size())]

    def facts(self) -> Facts:
        return Facts(self._text(), self.mapping(self._text), self.mapping(lambda: float(self._unpack("<d"))))

    def _text(self) -> str:
        size = self._size()
        if len(self._data) < self._at + size:
            raise IndexError(size)
        self._at += size
        return self._data[self._at - size : self._at].decode("utf-8", "replace")

    def _size(self) -> int:
        first = self._data[self._at]
        self._at += 1
        size = first if first < 255 else int(self._unpack("<i"))
        if not 0 <= size <= len(self._data):
            raise IndexError(size)
        return size

    def _unpack(self, form: str) -> float:
        (value,) = struct.unpack_from(form, self._data, self._at)
        self._at += struct.calcsize(form)
        return value  # type: ignore[no-any-return]
