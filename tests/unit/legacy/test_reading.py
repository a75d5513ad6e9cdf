"""Legacy files as bytes: encodings, line ends, and binary files."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from robocomp_yaml.legacy import reading
from robocomp_yaml.legacy.convert import Converted, convert
from robocomp_yaml.legacy.draft import ModuleDraft

TEXT = "// Se\xf1al\nmodule M {\n\tstruct S { int a; };\n};\n"


def _convert(folder: Path, raw: bytes) -> Converted:
    (folder / "M.idsl").write_bytes(raw)
    return convert(str(folder / "M.idsl"))


@pytest.mark.parametrize("raw", [
    TEXT.encode(), b"\xef\xbb\xbf" + TEXT.encode(), TEXT.replace("\n", "\r\n").encode(), TEXT.rstrip("\n").encode(),
], ids=["plain", "byte order mark", "CRLF", "no last line end"])  # fmt: skip
def test_text_is_decoded(tmp_path: Path, raw: bytes) -> None:
    result = _convert(tmp_path, raw)
    assert not result.diagnostics and isinstance(result.draft, ModuleDraft) and result.source is not None
    assert result.draft.around.head == ["Se\xf1al"]
    assert result.source.lines == 4


@pytest.mark.parametrize("encoding", ["latin-1", "cp1252"])
def test_latin_1_is_read_with_a_warning(tmp_path: Path, encoding: str) -> None:
    result = _convert(tmp_path, TEXT.encode(encoding))
    (warning,) = result.diagnostics
    assert (warning.code, warning.severity, warning.span.line, warning.span.column) == ("RC5011", "warning", 1, 6)
    assert isinstance(result.draft, ModuleDraft) and result.draft.around.head == ["Se\xf1al"]


@pytest.mark.parametrize(("raw", "code"), [
    (b"", "RC5002"), (b"\xef\xbb\xbf", "RC5002"), (b"module M {\0};", "RC0003"), (bytes(range(256)), "RC0003"),
    (b"module M { stru", "RC5003"), (b"module M { struct S { int a; // cut in the mid", "RC5003"),
])  # fmt: skip
def test_broken_files_are_rejected(tmp_path: Path, raw: bytes, code: str) -> None:
    result = _convert(tmp_path, raw)
    assert result.refused and result.diagnostics[-1].code == code


def test_a_huge_file_is_rejected_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "M.idsl"
    with path.open("wb") as file:
        file.truncate(100 << 20)
    (error,) = convert(str(path)).diagnostics
    assert error.code == "RC0004" and "4.0 MiB" in error.message


@pytest.mark.parametrize("make", [
    lambda path: path.mkdir(), lambda path: path.symlink_to("nowhere"), lambda path: os.mkfifo(path),
    lambda path: path.symlink_to(path.name),
], ids=["folder", "dangling link", "pipe", "link to itself"])  # fmt: skip
def test_what_is_not_a_file_is_rejected(tmp_path: Path, make: object) -> None:
    make(tmp_path / "M.idsl")  # type: ignore[operator]
    (error,) = convert(str(tmp_path / "M.idsl")).diagnostics
    assert error.code == "RC0001"


def test_control_characters_in_comments_are_escaped(tmp_path: Path) -> None:
    result = _convert(tmp_path, "module M { // a\x07b\u2028c\x85d\n};".encode())
    assert isinstance(result.draft, ModuleDraft)
    assert result.draft.document.entries[0].notes.tail == ["a\\x07b\\u2028c\\x85d"]
    assert [d.code for d in result.diagnostics] == ["RC5005"]


def test_locations_in_a_text() -> None:
    source = reading.SourceText("x", "ab\ncd\n\nñe")
    assert source.lines == 4
    assert [source.line(at) for at in range(9)] == [1, 1, 1, 2, 2, 2, 3, 4, 4]
    span = source.span(4, 7)
    assert (span.line, span.column, span.end_line, span.end_column) == (2, 2, 2, 3)
    assert source.before(8) == "ñ" and source.line_text(2) == "cd" and source.line_text(4) == "ñe"
