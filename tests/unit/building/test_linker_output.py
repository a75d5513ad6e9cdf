"""The output of the linker, as diagnostics at the user's source."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.building import linker_output

OBJECT = "components/ArmComp/CMakeFiles/ArmComp.dir"
CODE = """// helper() is elsewhere
#include "arm.h"
void Arm::initialize() { compute(); }
void Arm::compute()
{
    helper();
    other::get<int>(3);
}
int twice() { return count; }
"""


@pytest.fixture
def parse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.cpp").write_text(CODE, encoding="utf-8")

    def read(text: str) -> list[tuple[int, str, str]]:
        users = {"src/arm.cpp": "arm.cpp"}
        found = list(linker_output.diagnostics(text.splitlines(), users.get))
        assert {one.span.file for one in found} <= {"arm.cpp"} and {one.code for one in found} <= {"RC8001"}
        lines = CODE.splitlines()
        marked = [lines[one.span.line - 1][one.span.column - 1 : one.span.end_column - 1] for one in found]
        texts = [one.message.removeprefix("the linker rejects this: ") for one in found]
        return [(one.span.line, mark, text) for one, mark, text in zip(found, marked, texts, strict=True)]

    return read


def test_without_debug_information(parse) -> None:
    """The object tells the source, and the function with the symbol the line; each symbol is reported once."""
    found = parse(
        f"/usr/bin/ld: {OBJECT}/src/arm.cpp.o: warning: relocation against `_ZN3Arm5countE' in section `.text'\n"
        f"/usr/bin/ld: {OBJECT}/src/arm.cpp.o: in function `Arm::compute()':\n"
        "arm.cpp:(.text+0x5): undefined reference to `Arm::helper()'\n"
        "/usr/bin/ld: arm.cpp:(.text+0xf): undefined reference to `int other::get<int>(int)'\n"
        "/usr/bin/ld: arm.cpp:(.text+0xf): undefined reference to `Arm::helper()'\n"
        f"/usr/bin/ld: {OBJECT}/src/arm.cpp.o: in function `twice()':\n"
        "arm.cpp:(.text+0x1f): undefined reference to `count'\n"
        "/usr/bin/ld: warning: creating DT_TEXTREL in a PIE\n"
        "collect2: error: ld returned 1 exit status\n"
    )
    assert found == [
        (6, "helper", "undefined reference to 'Arm::helper()'"),
        (7, "get", "undefined reference to 'int other::get<int>(int)'"),
        (9, "count", "undefined reference to 'count'"),
    ]


def test_with_debug_information(parse) -> None:
    found = parse(
        f"/usr/bin/ld: {OBJECT}/src/arm.cpp.o: in function `Arm::compute()':\n"
        "/home/me/arm/src/arm.cpp:5: undefined reference to `vtable for Arm'\n"
        "/usr/bin/ld: /home/me/arm/src/arm.cpp:6: undefined reference to `Arm::helper()'\n"
    )
    assert found == [
        (5, "{", "undefined reference to 'vtable for Arm'"),
        (6, "helper", "undefined reference to 'Arm::helper()'"),
    ]


def test_a_second_definition(parse) -> None:
    found = parse(
        f"ld: {OBJECT}/src/arm.cpp.o: in function `twice()':\n"
        f"arm.cpp:(.text+0x0): multiple definition of `twice()'; {OBJECT}/src/b.cpp.o:b.cpp:(.text+0x0): first defined"
        " here\n"
    )
    assert found == [(9, "twice", "multiple definition of 'twice()'")]


@pytest.mark.parametrize(
    "text",
    [
        "/usr/bin/ld: cannot find -lnothing: No such file or directory",
        f"ld: {OBJECT}/generated/main.cpp.o: in function `main':\nmain.cpp:(.text+0x1): undefined reference to `f()'",
        f"ld: {OBJECT}/src/arm.cpp.o: in function `f':\nother.h:3: undefined reference to `g()'",
        "ld: libarm.a(arm.cpp.o): in function `f':\narm.cpp:(.text+0x1): undefined reference to `g()'",
        "arm.cpp:3: undefined reference to `g()'",
        "ld: Scrt1.o: in function `_start':\n(.text+0x17): undefined reference to `main'",
    ],
)
def test_what_is_not_in_the_users_sources(parse, text: str) -> None:
    assert parse(text) == []
