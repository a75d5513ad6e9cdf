"""The compiler's cache of test builds: a kept object is used only if it is the same."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from kept_objects import compile_or_copy

pytestmark = pytest.mark.skipif(shutil.which("g++") is None, reason="there is no g++ here")


def compiled(root: Path, text: str, *words: str) -> int:
    """Compiles a source below `root` as CMake does; returns the exit code."""
    (root / "include").mkdir(parents=True, exist_ok=True)
    (root / "include" / "x.h").write_text("#pragma once\n")
    (root / "x.cpp").write_text(f'#include "x.h"\n{text}\n')
    options = ["-Wall", "-Werror", f"-I{root}/include", f"-fmacro-prefix-map={root}=.", "-MD", "-MF", f"{root}/x.d"]
    command = ["g++", *words, *options, "-MT", "x.o", "-o", f"{root}/x.o", "-c", f"{root}/x.cpp"]
    return compile_or_copy(root.parent / "kept", command)


def kept(root: Path) -> int:
    return len([path for path in (root / "kept").iterdir() if not path.suffix])


def test_the_same_in_another_folder_is_used(tmp_path: Path) -> None:
    text = "const char* where() { return __FILE__; }"
    assert compiled(tmp_path / "one", text) == 0 == compiled(tmp_path / "two", text)
    assert kept(tmp_path) == 1
    assert (tmp_path / "one" / "x.o").read_bytes() == (tmp_path / "two" / "x.o").read_bytes()
    assert f"{tmp_path}/two/include/x.h" in (tmp_path / "two" / "x.d").read_text()


def test_another_text_or_word_is_compiled(tmp_path: Path) -> None:
    assert compiled(tmp_path / "one", "int f() { return 1; }") == 0
    assert compiled(tmp_path / "two", "int f() { return 2; }") == 0
    assert compiled(tmp_path / "three", "int f() { return 1; }", "-O2") == 0
    assert kept(tmp_path) == 3
    objects = {(tmp_path / name / "x.o").read_bytes() for name in ("one", "two", "three")}
    assert len(objects) == 3


@pytest.mark.parametrize("text", ["int f() { return x; }", "int f() { int unused; return 1; }", '#include "y.h"'])
def test_what_is_wrong_is_wrong_each_time(text: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for name in ("one", "two"):
        assert compiled(tmp_path / name, text) == 1
        assert f"{tmp_path}/{name}/x.cpp:2" in capfd.readouterr().err
    assert not (tmp_path / "kept").exists() or kept(tmp_path) == 0
