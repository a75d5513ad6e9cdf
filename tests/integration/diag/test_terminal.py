"""What a terminal is given: nothing that others wrote commands it, and data stays what it is."""

from __future__ import annotations

import json
import subprocess
import sys
import unicodedata
from pathlib import Path

import pytest

from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.codes import files
from robocomp_yaml.diag.codes.files import SYNTAX
from robocomp_yaml.diag.diagnostic import Related
from robocomp_yaml.diag.render import text as text_format
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import columns, cut, line, pad, paint, shown, typed

INVISIBLE = [
    chr(code) for code in range(sys.maxunicode + 1) if unicodedata.category(chr(code)) in ("Cc", "Cf", "Cs", "Zl", "Zp")
]
NO_CHARACTERS = [
    chr(code) for code in (*range(0xFDD0, 0xFDF0), *(p << 16 | end for p in range(17) for end in (0xFFFE, 0xFFFF)))
]


def test_whatever_is_invisible_or_commands_is_escaped() -> None:
    for c in (*INVISIBLE, *NO_CHARACTERS):
        seen = shown(f"a{c}b")
        assert seen.isascii() and seen.isprintable() and seen.startswith("a\\") and seen.endswith("b"), repr(c)


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("\x1b]0;title\x07", r"\e]0;title\a"),
        ("one\r\ntwo\tthree", r"one\r\ntwo\tthree"),
        ("\x9b31m\x7f\0", r"\u009b31m\x7f\x00"),
        ("\u2066abc\u2069\u200b\ufeff", r"\u2066abc\u2069\u200b\ufeff"),
        ("\udcff\udc9b", r"\xff\x9b"),
        ("\ud800\U000e0041\U0010ffff", r"\ud800\U000e0041\U0010ffff"),
        ("Grüße, 世界 🤖 \\n C:\\dir", "Grüße, 世界 🤖 \\n C:\\dir"),
        ("", ""),
    ],
)
def test_it_can_be_read(text: str, seen: str) -> None:
    assert shown(text) == seen
    assert shown(shown(text)) == seen


def test_tabs_stay_where_they_do_no_harm() -> None:
    assert shown("a\tb\r", tabs=True) == "a\tb\\r"


def test_only_our_own_colours_are_colours() -> None:
    assert line("\x1b[1m", paint("\x1b[2m", "31"), "!") == "\\e[1m\x1b[31m\\e[2m\x1b[0m!"
    assert paint("plain", "31", False) == "plain"


def test_cells_of_a_table_have_the_width_that_is_seen() -> None:
    assert pad("a\nb", 6) == "a\\nb  " and pad("世", 4) == "世  " and pad("7", 3, right=True) == "  7"
    assert columns(cut("世界世界世界", 7)) <= 7 and cut("abc", 3) == "abc" and cut("a\x1bcd", 4) == "a\\e…"


@pytest.mark.parametrize(
    "word", ["plain-1.yaml", "", "two words", "it's", "$HOME;ls", "~x", "a\nb", "\x1b[31m'\\", "café", "x\u202ey", "!!"]
)
def test_a_command_can_be_typed(word: str) -> None:
    command = typed("printf", "%s.", word)
    assert command == shown(command)
    done = subprocess.run(["bash", "-c", command], capture_output=True, check=True, env={"LC_ALL": "C.UTF-8"})
    assert done.stdout.decode() == f"{word}."


@pytest.mark.parametrize("before", ["", "\x1b[31m", "\u202e\u200b", "\t\t", "世界", "e\u0301", "\x9b\x07"])
@pytest.mark.parametrize("fault", ["x", "fault", "\x1b]0;x\x07", "\u2028\u2029", "界"])
def test_marks_stand_below_the_fault(tmp_path: Path, before: str, fault: str) -> None:
    path = tmp_path / "Speech.idsl.yaml"
    path.write_text(f"{before}{fault}, end\n", encoding="utf-8")
    span = Span(str(path), 1, len(before) + 1, 1, len(before) + len(fault) + 1)
    _, _, source, marks = text_format.each([SYNTAX.at(span, problem="m", hint="hint")], False)[0]
    source, marks = source.removeprefix("1 │ "), marks.removeprefix("  │ ")
    under = shown(fault.replace("\t", "    "))
    assert columns(source[: source.index(f"{under}, end")]) == len(marks) - len(marks.lstrip())
    assert marks.strip() == "^" * columns(under) + " hint"


def test_a_diagnostic_has_the_lines_that_are_its_own() -> None:
    evil = "x\nerror[RC9999]: forged\r\x1b[2K"
    told = SYNTAX.at(Span(evil), problem=evil, hint=evil, related=(Related(evil, Span(evil)),), more=f"paste\n\t{evil}")
    lines = text_format.render([told], 1, False)
    assert all(one == shown(one, tabs=True) for one in lines)
    assert [one for one in lines if one.startswith("error[")] == [lines[0]]


class Stream:
    """A standard stream with bytes below it."""

    def __init__(self, is_terminal: bool) -> None:
        self.is_terminal, self.written = is_terminal, b""
        self.buffer = self

    def isatty(self) -> bool:
        return self.is_terminal

    def write(self, text: str | bytes) -> None:
        self.written += text if isinstance(text, bytes) else text.encode("utf-8", "surrogateescape")

    def flush(self) -> None:
        pass


DATA = "a = \x1b[31mred\x1b[0m\r\n\tb = \u202e\u009b\udcff\x00\n"


def test_data_goes_into_a_pipe_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    out = Stream(False)
    monkeypatch.setattr(sys, "stdout", out)
    terminal.data(DATA)
    assert out.written == DATA.encode("utf-8", "surrogateescape")
    out.written = b""
    terminal.data("\ud800")
    assert out.written == rb"\ud800"


def test_data_is_escaped_for_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    out = Stream(True)
    monkeypatch.setattr(sys, "stdout", out)
    terminal.data(DATA)
    assert out.written == b"a = \\e[31mred\\e[0m\\r\n\tb = \\u202e\\u009b\\xff\\x00\n"


def test_json_is_json_on_a_terminal_too(monkeypatch: pytest.MonkeyPatch) -> None:
    out = Stream(True)
    monkeypatch.setattr(sys, "stdout", out)
    held = {"text": "".join(c for c in (*INVISIBLE, *NO_CHARACTERS) if unicodedata.category(c) != "Cs") + "世🤖"}
    terminal.data(json.dumps(held, ensure_ascii=False, indent=2) + "\n", json=True)
    seen = out.written.decode()
    assert json.loads(seen) == held
    assert all(one == shown(one) for one in seen.splitlines())


def test_many_diagnostics_of_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is hidden of a file is found out once: for each of its lines, 4,000 of them would take minutes."""
    looked: list[int] = []
    hidden = text_format.parts_of_lines
    monkeypatch.setattr(text_format, "parts_of_lines", lambda lines: looked.append(len(lines)) or hidden(lines))
    config = tmp_path / "config"
    config.write_text("a=b\npassword=mouth\n" * 50)
    told = [files.UNREADABLE.at(Span(str(config), number, 1, number, 2), reason="x") for number in range(1, 101)]
    shown = "\n".join(map(str, text_format.render(told, 1, False)))
    assert looked == [101] and "mouth" not in shown and shown.count("a=b") == 50
