"""Which reader a file of source code has: that of the language whose files are called so."""

from __future__ import annotations

from robocomp_yaml import languages
from robocomp_yaml.emit.specific.code import Code
from robocomp_yaml.languages.record import MERGING, TargetLanguage


def read(path: str, text: str) -> Code | None:
    """The code of a file; None where it is in no language that is known here."""
    language = _language(path)
    if language is None:
        return None
    code: Code = language.part("code").read(path, text)
    return code


def is_code(path: str) -> bool:
    return _language(path) is not None


def comment_mark(path: str) -> str:
    """How a line of comment begins."""
    language = _language(path)
    return language.comment if language else "#"


def compiles(code: Code) -> bool:
    """Whether its language takes it, as far as its reader can tell beyond the syntax tree."""
    language = _language(code.path)
    return language is None or bool(language.part("code").compiles(code))


def unmerged(path: str) -> TargetLanguage | None:
    """The language of a file of code, where that cannot be merged."""
    language = _of_suffix(path)
    return language if language and MERGING not in language.has else None


def _language(path: str) -> TargetLanguage | None:
    language = _of_suffix(path)
    return language if language and MERGING in language.has else None


def _of_suffix(path: str) -> TargetLanguage | None:
    suffix = path.rpartition(".")[2]
    return next((one for one in languages.known().values() if suffix in one.suffixes), None)
