# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Values by reference: `${env:NAME}` and `${file:PATH}` in properties, `{"env": NAME}` and `{"file": PATH}` in data.

They are resolved when a component starts, on the host where it runs.
"""

from __future__ import annotations

import os
import re
import stat
from typing import Any

ENV, FILE = "env", "file"
KINDS = (ENV, FILE)
_VARIABLE = r"[A-Za-z_][A-Za-z0-9_]*\Z"
LARGEST = 1 << 20  # bytes of a file with one value


class Unresolved:
    """A reference that is not resolved, as in the compiler. `data` is `{"env": NAME}` or `{"file": PATH}`."""

    __slots__ = ("data",)

    def __init__(self, data: dict[str, str]) -> None:
        self.data = data

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Unresolved) and other.data == self.data

    def __hash__(self) -> int:
        return hash(tuple(self.data.items()))


class Referred(str):
    """The text of a resolved reference. Messages show only the reference."""

    reference: str


class Missing:
    """The value of a reference that cannot be resolved. `why` names its source and the problem."""

    def __init__(self, why: str) -> None:
        self.why = why


class _Unusable(Exception):
    """A file has no usable value. The message is a relative clause about the file."""


def is_reference(data: object) -> bool:
    """Whether data, where a plain value is expected, is a reference."""
    return isinstance(data, dict) and len(data) == 1 and next(iter(data)) in KINDS


def is_sound(data: object) -> bool:
    """Whether data is a reference with a valid name or path."""
    if not isinstance(data, dict) or not is_reference(data):
        return False
    kind, name = next(iter(data.items()))
    return isinstance(name, str) and not problem(kind, name)


def problem(kind: str, name: object) -> str:
    """The problem of the name or path of a reference, or ''."""
    if kind == ENV:
        return "" if isinstance(name, str) and re.match(_VARIABLE, name) else "does not name an environment variable"
    if not isinstance(name, str) or not name or name[-1] in " \t/":
        return "does not name a file"
    return "has a path that no file can have" if any(char in name for char in "\r\n\0") else ""


def spelled(kind: str, name: str) -> str:
    """The reference as properties spell it."""
    return f"${{{kind}:{name}}}"


def read(text: str) -> dict[str, str] | None:
    """The reference that a property's text spells, or None."""
    if not (text.startswith("${") and text.endswith("}")):
        return None
    kind, colon, name = text[2:-1].partition(":")
    return {kind: name} if colon and kind in KINDS and not problem(kind, name) else None


def unresolved(text: str) -> Any:
    """The text itself, or the reference that it spells."""
    found = read(text)
    return text if found is None else Unresolved(found)


def resolved(text: str, folder: str = "") -> Any:
    """The text itself, or the value of the reference that it spells. A relative path starts at the folder."""
    found = read(text)
    if found is None:
        return text
    if ENV in found:
        value = os.environ.get(found[ENV])
        if value is None:
            return Missing(f"comes from the environment variable {found[ENV]}, which is not set")
        return referring(value, text)
    path = os.path.normpath(os.path.join(folder, os.path.expanduser(found[FILE])))
    try:
        return referring(_contents(path), text)
    except _Unusable as fault:
        return Missing(f"comes from the file {path}, {fault}")


def referred(raw: Any) -> Any:
    """The value of the reference `{"env": NAME}` or `{"file": PATH}`; other data unchanged."""
    return resolved(spelled(*next(iter(raw.items())))) if is_sound(raw) else raw


def referring(text: str, reference: str) -> Referred:
    made = Referred(text)
    made.reference = reference
    return made


def _contents(path: str) -> str:
    """The text of a file without its last line end. Raises _Unusable."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)  # a pipe would block
        try:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):
                raise _Unusable("which is not a regular file")
            with open(descriptor, "rb", closefd=False) as file:
                raw = file.read(LARGEST + 1)
        finally:
            os.close(descriptor)
    except OSError as error:
        raise _Unusable(f"which cannot be read: {error.strerror}") from None
    if len(raw) > LARGEST:
        raise _Unusable("which is larger than 1 MiB")
    if b"\0" in raw:
        raise _Unusable("which contains a NUL character")
    if raw.endswith(b"\n"):
        raw = raw[: -2 if raw.endswith(b"\r\n") else -1]
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        raise _Unusable("which is not in UTF-8") from None
