"""Which words Slice and Ice's Python mapping reserve: our tables against the real compilers."""

from __future__ import annotations

import builtins
import keyword
from pathlib import Path

from robocomp_yaml.check.idsl.names import RESERVED, UNESCAPED_IN_PYTHON, fault_of
from slice_compilers import complaints, needs_compilers

pytestmark = needs_compilers

OTHERS = (
    "self object super property tuple print exec current context Struct Module native tag array nonmutating value "
    "linux unix NULL defined EOF std namespace template delete new operator virtual Prx2 aprx nice Disp clone A"
).split()


def _files(folder: Path, words: list[str]) -> dict[str, str]:
    """A file for each word, with the word as every kind of name; file name to word."""
    files = {}
    for number, word in enumerate(words):
        files[f"Word{number}.ice"] = word
        (folder / f"Word{number}.ice").write_text(
            f"module A{number}Struct {{ struct {word} {{ int x; }}; struct Use {{ {word} y; }}; }};\n"
            f"module A{number}Enum {{ enum {word} {{ red, {word} }}; }};\n"
            f"module A{number}Exception {{ exception {word} {{ int {word}; }}; }};\n"
            f"module A{number}Throws {{ exception {word} {{ }}; interface I {{ void f() throws {word}; }}; }};\n"
            f"module A{number}Interface {{ interface {word} {{ int g(int {word}); int h(out int {word}); }}; }};\n"
            f"module A{number}Method {{ interface I {{ int {word}(); }}; const int {word} = 1; }};\n",
            encoding="utf-8",
        )
    return files


def test_words_that_are_rejected(tmp_path: Path) -> None:
    files = _files(tmp_path, sorted(RESERVED | UNESCAPED_IN_PYTHON))
    for name, word in files.items():
        assert complaints(tmp_path, [name]), f"no compiler refuses '{word}'"


def test_words_that_are_accepted(tmp_path: Path) -> None:
    words = [
        *keyword.kwlist,
        *keyword.softkwlist,
        *OTHERS,
        *(set(dir(builtins)) - {"staticmethod"}),
    ]  # which no method can be
    words = [word for word in dict.fromkeys(words) if word.strip("_") == word and fault_of(word) is None]
    assert len(words) > 50
    files = _files(tmp_path, words)
    assert {files.get(name, name): said for name, said in complaints(tmp_path, files).items()} == {}
