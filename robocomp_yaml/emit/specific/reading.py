"""Reads the user's source code: with the reader of the file's language, which its suffix determines. Also finds the
code beside the files with skeletons, which may contain parts of the class."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from typing import Any

from robocomp_yaml import languages
from robocomp_yaml.emit.specific.code import CLASS, SourceCode
from robocomp_yaml.languages.record import MERGING, TargetLanguage
from robocomp_yaml.transactions.output_root import Root

_LARGEST = 1_000_000  # bytes; a larger file is data, not code that somebody wrote


def read(path: str, text: str) -> SourceCode | None:
    """The code of a file; None if no language with merging has its suffix."""
    language = _language(path)
    return language.part("code").read(path, text) if language else None


def is_code(path: str) -> bool:
    """Whether `read` can read a file with this name."""
    return _language(path) is not None


def comment_mark(path: str) -> str:
    """What begins a line comment."""
    language = _language(path)
    return language.comment if language else "#"


def signature_types(path: str) -> Any:
    """What compares types of the file's language (`SignatureTypes`), None if nothing does."""
    language = _language(path)
    return getattr(language.part("code"), "SignatureTypes", None) if language else None


def compiles(code: SourceCode) -> bool:
    """Whether the code compiles, as far as the reader of its language can check that."""
    language = _language(code.path)
    return language is None or bool(language.part("code").compiles(code))


def unmerged(path: str) -> TargetLanguage | None:
    """The language of a file of code, if that language has no merging."""
    language = _of_suffix(path)
    return language if language and MERGING not in language.has else None


def _language(path: str) -> TargetLanguage | None:
    language = _of_suffix(path)
    return language if language and MERGING in language.has else None


def _of_suffix(path: str) -> TargetLanguage | None:
    suffix = path.rpartition(".")[2]
    return next((one for one in languages.known().values() if suffix in one.suffixes), None)


def names(root: Root, folder: str) -> list[str]:
    """All names in a folder, sorted."""
    return sorted(os.listdir(f"{root.real}/{folder}"))


def code_in(root: Root, folder: str) -> Iterator[tuple[str, bytes]]:
    """The path and content of each file of code in a folder."""
    for path in (f"{folder}/{name}" for name in names(root, folder)):
        if is_code(path):
            status = root.status(path)
            if not status.problem and status.data is not None and len(status.data) <= _LARGEST:
                yield path, status.data


def others(root: Root, known: Collection[str]) -> list[SourceCode]:
    """The code of files beside these that mentions the specific class, or defines a class that it may inherit from."""
    codes = []
    for folder in sorted({path.rpartition("/")[0] for path in known}):
        for path, data in code_in(root, folder):
            text = data.decode(errors="replace")
            if path not in known and (CLASS in text or "class " in text) and (code := read(path, text)):
                codes.append(code)
    return codes
