"""The output of compilers, as diagnostics at lines of the user's code."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.building.compiler_output import CompilerOutput
from robocomp_yaml.diag.diagnostic import Diagnostic

CODE = "#include <x.h>\nint main() {\n\treturn opne(1);\n}\n"


@pytest.fixture
def parse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "arm.cpp").write_text(CODE, encoding="utf-8")

    def read(text: str) -> list[Diagnostic]:
        return list(CompilerOutput("build", "the compiler").diagnostics(text.splitlines()))

    return read


def places(found: list[Diagnostic]) -> list[tuple[object, ...]]:
    return [(one.code, one.span.file, one.span.line, one.span.column, one.span.end_column) for one in found]


def test_gcc(parse) -> None:
    """Columns are those of a terminal, with tabs of eight; the marks give the length."""
    found = parse(
        "In file included from ../arm/arm.cpp:1:\n"
        "../arm/arm.cpp: In function ‘int main()’:\n"
        "../arm/arm.cpp:3:16: error: ‘opne’ was not declared in this scope; did you mean ‘open’?\n"
        "    3 |         return opne(1);\n"
        "      |                ^~~~\n"
        "      |                open\n"
        "../arm/arm.cpp:2:5: note: in here\n"
        "../arm/arm.cpp:2:5: warning: unused [-Wunused]\n"
    )
    assert places(found) == [("RC8001", "arm/arm.cpp", 3, 9, 13), ("RC8002", "arm/arm.cpp", 2, 5, 6)]
    assert found[0].message == (
        "the compiler rejects this: ‘opne’ was not declared in this scope; did you mean ‘open’?"
    )
    assert [(one.message, one.span.line) for one in found[0].related] == [("in here", 2)]


def test_a_missing_header_and_a_repeated_error(parse) -> None:
    line = "../arm/arm.cpp:1:10: fatal error: x.h: No such file or directory\n"
    assert places(parse(line + "compilation terminated.\n" + line)) == [("RC8001", "arm/arm.cpp", 1, 10, 11)]


def test_javac(parse) -> None:
    """javac prints no column; the mark below the line shows it."""
    found = parse("arm/arm.cpp:2: error: cannot find symbol\nint main() {\n    ^\n  symbol: class main\n1 error\n")
    assert [(one.span.line, one.span.column) for one in found] == [(2, 5)]


def test_the_slice_compiler(parse) -> None:
    (slice_,) = parse("../arm/Arm.ice:4: `Pose' is not defined\n")
    assert slice_.message == "the Slice compiler rejects this: `Pose' is not defined"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "ninja: build stopped: subcommand failed.",
        "collect2: error: ld returned 1 exit status",
        "12:13:14 started",
        "a: b: c",
        "arm.cpp:3: undefined reference to `f()'",
    ],
)
def test_lines_without_a_location(parse, text: str) -> None:
    assert parse(text) == []


def test_a_file_outside_has_an_absolute_path(parse) -> None:
    assert parse("/usr/include/c++/12/vector:1:1: error: x")[0].span.file == "/usr/include/c++/12/vector"
