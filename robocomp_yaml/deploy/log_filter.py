"""A selection of the lines of logs: those since a time, and those that match a regular expression."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Sequence
from contextlib import aclosing

import msgspec

from robocomp_yaml.deploy.engine import Engine, Line
from robocomp_yaml.deploy.patterns import search

_ALL = 1 << 40


class LogFilter(msgspec.Struct, frozen=True):
    """`since` is a time in UTC, as logs have it, or ''. `pattern` is a regular expression, or ''."""

    since: str = ""
    pattern: str = ""

    def accepts(self, line: Line) -> bool:
        """Raises PatternTooSlow."""
        return line.time >= self.since and (not self.pattern or search(self.pattern, line.text))


async def selected(
    engine: Engine, names: Sequence[str], last: int | None, follow: bool, chosen: LogFilter
) -> AsyncGenerator[Line, None]:
    """The `last` accepted lines of each process (None: all of them), and with `follow` all further ones. Raises
    PatternTooSlow."""
    if last is not None and chosen == LogFilter():
        async with aclosing(await engine.lines(names, last, follow)) as lines:
            async for line in lines:
                yield line
        return
    async with aclosing(await engine.lines(names, 0, True)) as further:  # before the others are read: none is missed
        async with aclosing(await engine.lines(names, _ALL, False)) as lines:
            found = [line async for line in lines if chosen.accepts(line)]
        for line in _last(found, last):
            yield line
        if follow:
            seen = set(found)
            async for line in further:
                if line not in seen and chosen.accepts(line):
                    yield line


def _last(lines: list[Line], count: int | None) -> list[Line]:
    """The last lines of each process."""
    if count is None:
        return lines
    kept: list[Line] = []
    left: dict[str, int] = {}
    for line in reversed(lines):
        left[line.name] = left.get(line.name, count) - 1
        if left[line.name] >= 0:
            kept.append(line)
    return kept[::-1]
