"""The whole terminal for one command, and the keys that are typed. Whatever ends the command restores the
terminal.

termios is enough for that: curses would wait for keys in a way of its own, beside the event loop.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import shutil
import signal
import sys
import termios
import tty
from collections.abc import Callable, Iterable
from typing import Any, Self

from robocomp_yaml.diag import terminal
from robocomp_yaml.patterns import pattern

UP, DOWN, PAGE_UP, PAGE_DOWN, HOME, END = "up", "down", "page up", "page down", "home", "end"
_SEQUENCES = {
    "[A": UP, "[B": DOWN, "[5~": PAGE_UP, "[6~": PAGE_DOWN, "[H": HOME, "[F": END, "OA": UP, "OB": DOWN, "OH": HOME,
    "OF": END, "[1~": HOME, "[4~": END,
}  # fmt: skip
_KEY = pattern(r"\x1b(\[[0-9;]*[A-Za-z~]|O[A-Z])|.", re.DOTALL)


def keys_in(text: str) -> list[str]:
    """The keys that were typed: characters, and names of those that send a sequence. Unknown ones are ''."""
    return [_SEQUENCES.get(found[1], "") if found[1] else found[0] for found in _KEY.finditer(text)]


def is_screen() -> bool:
    """Whether standard output is a terminal on which can be drawn."""
    return sys.stdout.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


class Screen:
    """A context manager, in an event loop. `on_key` is called with each key, `on_change` when the screen must be drawn
    again: the size of the terminal changed, or the command was stopped by Ctrl-Z and goes on."""

    def __init__(self, on_key: Callable[[str], None], on_change: Callable[[], None]) -> None:
        self._on_key, self._on_change = on_key, on_change
        self._before: list[Any] | None = None

    def __enter__(self) -> Self:
        loop = asyncio.get_running_loop()
        self._begin()
        if self._before is not None:
            loop.add_reader(sys.stdin.fileno(), self._read)
        loop.add_signal_handler(signal.SIGWINCH, self._on_change)
        loop.add_signal_handler(signal.SIGTSTP, self._stop)
        return self

    def __exit__(self, *_: object) -> None:
        loop = asyncio.get_running_loop()
        for number in (signal.SIGWINCH, signal.SIGTSTP):
            loop.remove_signal_handler(number)
        if self._before is not None:
            loop.remove_reader(sys.stdin.fileno())
        self._end()

    @property
    def size(self) -> tuple[int, int]:
        """Columns and lines."""
        try:
            size = os.get_terminal_size(sys.stdout.fileno())
        except OSError:
            return shutil.get_terminal_size()
        return (size.columns, size.lines) if size.columns and size.lines else shutil.get_terminal_size()

    def draw(self, lines: Iterable[str]) -> None:
        terminal.draw_screen(lines)

    def _begin(self) -> None:
        with contextlib.suppress(termios.error, ValueError):
            if sys.stdin.isatty():
                self._before = termios.tcgetattr(sys.stdin.fileno())
                tty.setcbreak(sys.stdin.fileno())
        terminal.enter_screen()

    def _end(self) -> None:
        with contextlib.suppress(OSError):  # the terminal was closed
            terminal.leave_screen()
        with contextlib.suppress(termios.error):
            if self._before is not None:
                termios.tcsetattr(sys.stdin.fileno(), termios.TCSADRAIN, self._before)

    def _stop(self) -> None:
        self._end()
        os.kill(os.getpid(), signal.SIGSTOP)
        self._begin()  # SIGCONT
        self._on_change()

    def _read(self) -> None:
        try:
            typed = os.read(sys.stdin.fileno(), 1024)
        except OSError:
            typed = b""
        if not typed:  # the terminal was closed
            asyncio.get_running_loop().remove_reader(sys.stdin.fileno())
        for key in keys_in(typed.decode("utf-8", "replace")):
            self._on_key(key)
