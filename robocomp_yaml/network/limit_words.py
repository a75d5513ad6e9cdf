"""Limits of processes, by small programs that set them and then become the process. The supervisor imports this, which
is why limits are data here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

_UNLIMITED = -1
# `nice` would add to the niceness of the supervisor.
_RENICE = 'renice -n "$0" -p $$ >/dev/null; exec "$@"'


def words(limits: Mapping[str, Any]) -> list[str]:
    """The words that precede the command of a process with these limits."""
    return [word for _, own in by_key(limits) for word in own]


def by_key(limits: Mapping[str, Any]) -> Iterator[tuple[str, list[str]]]:
    """The words for each limit, which are also a test of it: with the command `true` they fail where it is denied."""
    one = {key: value for key, value in limits.items() if value is not None}
    if "nice" in one:
        yield "nice", ["sh", "-c", _RENICE, str(one["nice"])]
    if "realtime" in one:
        yield "realtime", ["chrt", "--fifo", str(one["realtime"])]
    if "cores" in one:
        yield "cores", ["taskset", "--cpu-list", str(one["cores"])]
    # What a process allocates. The size of its address space is something else: each thread reserves much more.
    for key, resource in (("memory", "data"), ("core", "core"), ("files", "nofile")):
        if key in one:
            size = "unlimited" if one[key] == _UNLIMITED else one[key]
            yield key, ["prlimit", f"--{resource}={size}", "--"]
