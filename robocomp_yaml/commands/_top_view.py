"""What `rcyaml top` shows of a sample: a table that fits a terminal, and data."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import msgspec

from robocomp_yaml.commands import _screen
from robocomp_yaml.deploy.sampling import NOT_STARTED, NetworkSample, ProcessSample, TopicUse
from robocomp_yaml.deploy.states import RUNNING
from robocomp_yaml.diag.terminal import Shown, columns, cut, pad, paint, shown

UNKNOWN, NONE = "unknown", "-"
_GAP = 2
_LEAST = 12  # columns of the state and of the last column, which are cut before a column is omitted


class Order(msgspec.Struct, frozen=True):
    """An order of processes: the key that selects it on a terminal, and the compared value, None if it is unknown.
    `largest` is whether the largest value comes first."""

    key: str
    value: Callable[[ProcessSample], Any]
    largest: bool = True


DOCUMENT = "document"
ORDERS = {
    DOCUMENT: Order("d", lambda one: 0, largest=False),
    "name": Order("n", lambda one: one.name, largest=False),
    "state": Order("s", lambda one: (not one.is_fault, one.state), largest=False),
    "cpu": Order("c", lambda one: one.cpu),
    "memory": Order("m", lambda one: one.memory),
    "missed": Order("x", lambda one: one.worker.missed if one.worker else None),
    "calls": Order("l", lambda one: one.calls),
    "slowest": Order("w", lambda one: one.slowest.longest if one.slowest else None),
    "topics": Order("t", lambda one: one.messages),
}
"""By their names for `--sort`."""

REVERSE, QUIT = "r", "q"
_KEYS = {**{one.key: name for name, one in ORDERS.items()}, REVERSE: "reverse", QUIT: "quit"}
_HELP = " ".join(f"({key}){name[1:] if name[0] == key else f' {name}'}" for key, name in _KEYS.items())


def in_order(found: Sequence[ProcessSample], sort: str, *, is_reversed: bool = False) -> list[ProcessSample]:
    """The processes in an order; those whose value is unknown last. Equal ones stay as they are in the document."""
    order = ORDERS[sort]
    known = [one for one in found if order.value(one) is not None]
    known.sort(key=order.value, reverse=order.largest != is_reversed)
    if sort == DOCUMENT and is_reversed:
        known.reverse()
    return [*known, *(one for one in found if order.value(one) is None)]


class TopView:
    """The table of samples of a deployment. On a terminal it scrolls, and keys change its order."""

    def __init__(self, title: str, sort: str, color: bool, *, is_reversed: bool = False) -> None:
        self._title, self._sort, self._color, self._reversed = title, sort, color, is_reversed
        self._first, self._page = 0, 1

    def key(self, key: str) -> None:
        """A typed key; it has a meaning or none."""
        if key == REVERSE:
            self._reversed = not self._reversed
        elif key in _KEYS and key != QUIT:
            self._sort, self._reversed = _KEYS[key], False
        else:
            steps = {_screen.UP: -1, _screen.DOWN: 1, _screen.PAGE_UP: -self._page, _screen.PAGE_DOWN: self._page}
            self._first = {_screen.HOME: 0, _screen.END: 1 << 30}.get(key, self._first + steps.get(key, 0))

    def lines(self, sample: NetworkSample) -> list[Shown]:
        """The whole table."""
        found = in_order(sample.processes, self._sort, is_reversed=self._reversed)
        head, *rows = _table(found, None, self._color)[0]
        return [*self._heading(sample, None), head, *rows]

    def screen(self, sample: NetworkSample | None, width: int, height: int) -> list[Shown]:
        """As many lines as a terminal has, none wider than it is."""
        width = max(1, width - 1)
        if sample is None:
            return [cut(f"{self._title}  …", width)]
        found = in_order(sample.processes, self._sort, is_reversed=self._reversed)
        above = self._heading(sample, width)
        self._page = max(1, height - len(above) - 2)
        self._first = max(0, min(self._first, len(found) - self._page))
        last = self._first + self._page
        (head, *rows), omitted = _table(found, width, self._color)
        notes = []
        if len(found) > self._page:
            notes.append(f"{self._first + 1} to {min(last, len(found))} of {len(found)}: arrows and PageDown scroll")
        if omitted:
            notes.append(f"too narrow for {', '.join(omitted)}")
        foot = paint(cut("   ".join([*notes, _HELP]), width), "2", self._color)
        return [*above, head, *rows[self._first : last], foot][: max(1, height)]

    def _heading(self, sample: NetworkSample, width: int | None) -> list[Shown]:
        faults = sum(one.is_fault for one in sample.processes)
        running = sum(one.pid is not None for one in sample.processes)
        order = self._sort + (", reversed" if self._reversed else "")
        parts = [
            self._title, time.strftime("%H:%M:%S"),
            f"{running} of {len(sample.processes)} processes running",
            *([f"{faults} not as desired"] if faults else []),
            f"sorted by {order}",
        ]  # fmt: skip
        lines = [_fitting("  ".join(parts), width)]
        return [*lines, paint(_fitting(sample.problem, width), "31", self._color)] if sample.problem else lines


def _fitting(text: str, width: int | None) -> Shown:
    return shown(text) if width is None else cut(text, width)


class _Column(msgspec.Struct, frozen=True):
    """A column: its title, the texts of its cells, and how dispensable it is on a narrow terminal."""

    title: str
    cell: Callable[[ProcessSample], str]
    rank: int
    right: bool = False


_COLUMNS = (
    _Column("PROCESS", lambda one: one.name, 0),
    _Column("HOST", lambda one: one.host, 3),
    _Column("STATE", lambda one: one.state, 0),
    _Column("PID", lambda one: str(one.pid) if one.pid else NONE, 11, right=True),
    _Column("UP", lambda one: NONE if one.uptime is None else _uptime(one.uptime), 10, right=True),
    _Column("CPU", lambda one: _of_alive(one, one.cpu, lambda part: f"{100 * part:.0f} %"), 1, right=True),
    _Column(
        "MEMORY", lambda one: _of_alive(one, one.memory, lambda size: f"{size / (1 << 20):.0f} MiB"), 2, right=True
    ),
    _Column("PERIOD", lambda one: _of_component(one, one.worker and one.worker.period, _short), 5, right=True),
    _Column("ACHIEVED", lambda one: _of_component(one, one.worker and one.worker.achieved, _short), 4, right=True),
    _Column("MISSED", lambda one: _of_component(one, one.worker and one.worker.missed, str), 6, right=True),
    _Column("CALLS", lambda one: _of_component(one, one.calls, _per_second), 7, right=True),
    _Column("SLOWEST", lambda one: _slowest(one), 8),
    _Column("TOPICS", lambda one: _topics(one), 9),
)


def _of_alive(one: ProcessSample, value: Any, text: Callable[[Any], str]) -> str:
    return NONE if one.pid is None else UNKNOWN if value is None else text(value)


def _of_component(one: ProcessSample, value: Any, text: Callable[[Any], str]) -> str:
    if value is not None:
        return text(value)
    return UNKNOWN if one.is_component and one.pid is not None else NONE


def _slowest(one: ProcessSample) -> str:
    if one.methods is None:
        return _of_component(one, None, str)
    return f"{one.slowest.method} {_short(one.slowest.longest or 0.0)}" if one.slowest else NONE


def _topics(one: ProcessSample) -> str:
    if one.topics is None:
        return _of_component(one, None, str)
    return ", ".join(f"{topic.topic} {_rate(topic)} {topic.direction}" for topic in one.topics) or NONE


def _rate(topic: TopicUse) -> str:
    return "?/s" if topic.rate is None else _per_second(topic.rate)


def _per_second(rate: float) -> str:
    return f"{rate:.1f}/s" if rate < 99.95 else f"{rate:.0f}/s"


def _short(seconds: float) -> str:
    """A duration of at most some seconds: '50 ms', '0.12 ms', '1.5 s'."""
    if seconds >= 1:
        return f"{seconds:.1f} s"
    return f"{1000 * seconds:.0f} ms" if seconds >= 0.0095 else f"{1000 * seconds:.2g} ms"


def _uptime(seconds: float) -> str:
    from robocomp_yaml.commands._deploy_views import duration

    return duration(seconds)


def _table(found: Sequence[ProcessSample], width: int | None, color: bool) -> tuple[list[Shown], list[str]]:
    """The lines, and the titles of the columns for which there is no room."""
    used = [one for one in _COLUMNS if one.title != "HOST" or len({each.host for each in found}) > 1]
    cells = {one.title: [one.title, *(one.cell(each) for each in found)] for one in used}
    widths = {title: max(map(columns, texts)) for title, texts in cells.items()}
    omitted: list[_Column] = []
    if width is not None:
        while len(used) > 2 and _least(used, widths) > width:
            omitted.append(max(used, key=lambda one: one.rank))
            used = [one for one in used if one is not omitted[-1]]
        used = used if width >= _GAP + 2 else used[:1]
        _squeeze(used, widths, width)
    samples: list[ProcessSample | None] = [None, *found]
    lines = []
    for row, sample in enumerate(samples):
        texts = []
        for one in used:
            text = pad(cut(cells[one.title][row], widths[one.title]), widths[one.title], right=one.right)
            texts.append(paint(text, _tint(sample), color) if sample and one.title == "STATE" else text)
        joined = (" " * _GAP).join(texts)
        lines.append(Shown(joined.rstrip()) if width is None or color else cut(joined.rstrip(), width))
    return lines, [one.title for one in _COLUMNS if one in omitted]


def _flexible(used: Sequence[_Column]) -> list[str]:
    """The columns that may be cut: the last one if it lists things, and the state."""
    return [one.title for one in reversed(used) if one.title in ("SLOWEST", "TOPICS", "STATE", "PROCESS")]


def _least(used: Sequence[_Column], widths: dict[str, int]) -> int:
    flexible = _flexible(used)
    least = [min(widths[one.title], _LEAST) if one.title in flexible else widths[one.title] for one in used]
    return sum(least) + _GAP * (len(used) - 1)


def _squeeze(used: Sequence[_Column], widths: dict[str, int], width: int) -> None:
    """Makes columns narrower until the table fits, but none narrower than it must be; names last."""
    for least in (_LEAST, 1):
        for title in _flexible(used):
            over = sum(widths[one.title] for one in used) + _GAP * (len(used) - 1) - width
            if over > 0:
                widths[title] = max(min(widths[title], least), widths[title] - over)


def _tint(one: ProcessSample) -> str:
    if one.is_fault:
        return "31"
    if one.state == RUNNING:
        return "32"
    return "2" if one.state == NOT_STARTED else "33"


def as_data(name: str, engine: str, sample: NetworkSample) -> dict[str, Any]:
    """A sample as JSON has it. What is unknown is null."""
    return {
        "time": time.time(), "deployment": name, "engine": engine, "problem": sample.problem,
        "processes": [_process_data(one) for one in sample.processes],
    }  # fmt: skip


def _process_data(one: ProcessSample) -> dict[str, Any]:
    slowest = one.slowest
    data = msgspec.to_builtins(one)
    return {
        **data, "calls": one.calls,
        "slowest": {"method": slowest.method, "longest": slowest.longest} if slowest else None,
    }  # fmt: skip
