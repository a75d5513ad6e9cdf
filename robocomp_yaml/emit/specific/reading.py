"""The user's source code: which reader a file has, which is that of the language whose files are called so, and the
code beside the files that there are skeletons for, in which parts of the class may stand."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator

from robocomp_yaml import languages
from robocomp_yaml.emit.specific.code import CLASS, SourceCode
from robocomp_yaml.languages.record import MERGING, TargetLanguage
from robocomp_yaml.transactions.output_root import Root

_LARGEST = 1_000_000  # bytes; a larger file is data, not the user's code


def read(path: str, text: str) -> SourceCode | None:
    """The code of a file; None where it is in no language that is known here."""
    language = _merged(path)
    return language.part("code").read(path, text) if language else None


def is_code(path: str) -> bool:
    return _merged(path) is not None


def comment_mark(path: str) -> str:
    """How a line of comment begins."""
    language = _merged(path)
    return language.comment if language else "#"


def compiles(code: SourceCode) -> bool:
    """Whether its language takes it, as far as its reader can tell beyond the syntax tree."""
    language = _merged(code.path)
    return language is None or bool(language.part("code").compiles(code))


def unmerged(path: str) -> TargetLanguage | None:
    """The language of a file of code, where that cannot be merged."""
    language = _of_suffix(path)
    return language if language and MERGING not in language.has else None


def _merged(path: str) -> TargetLanguage | None:
    language = _of_suffix(path)
    return language if language and MERGING in language.has else None


def _of_suffix(path: str) -> TargetLanguage | None:
    suffix = path.rpartition(".")[2]
    return next((one for one in languages.known().values() if suffix in one.suffixes), None)


def names(root: Root, folder: str) -> list[str]:
    """All names in a folder, sorted."""
    return sorted(os.listdir(f"{root.real}/{folder}"))


def code_in(root: Root, folder: str) -> Iterator[tuple[str, bytes]]:
    """Each file of a folder that is code by its name, with its contents."""
    for path in (f"{folder}/{name}" for name in names(root, folder)):
        if is_code(path):
            found = root.status(path)
            if not found.problem and found.data is not None and len(found.data) <= _LARGEST:
                yield path, found.data


def others(root: Root, known: Collection[str]) -> list[SourceCode]:
    """The code of other files beside these that speaks of the class, or of what it may inherit from."""
    found = []
    for folder in sorted({path.rpartition("/")[0] for path in known}):
        for path, data in code_in(root, folder):
            text = data.decode(errors="replace")
            if path not in known and (CLASS in text or "class " in text) and (code := read(path, text)):
                found.append(code)
    return found
