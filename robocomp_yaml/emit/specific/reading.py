"""Which reader a file of source code has: one module a language."""

from __future__ import annotations

from collections.abc import Callable

from robocomp_yaml.emit.specific.code import Code


def read(path: str, text: str) -> Code | None:
    """The code of a file; None where it is in no language that is known here."""
    reader = _reader(path)
    return reader(path, text) if reader else None


def is_code(path: str) -> bool:
    return _reader(path) is not None


def _reader(path: str) -> Callable[[str, str], Code] | None:
    suffix = path.rpartition(".")[2]
    if suffix == "py":
        from robocomp_yaml.emit.specific.python_code import read as read_python

        return read_python
    if suffix in ("h", "hpp", "cpp"):
        from robocomp_yaml.emit.specific.cpp_code import read as read_cpp

        return read_cpp
    return None
