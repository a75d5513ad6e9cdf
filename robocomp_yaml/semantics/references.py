# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Values by reference: `${env:NAME}` and `${file:PATH}` in properties, `{"env": NAME}` and `{"file": PATH}` in data.

They are followed when a component starts, where it runs.
"""

from __future__ import annotations

import os
import re
import stat
from typing import Any

ENV, FILE = "env", "file"
KINDS = (ENV, FILE)
_VARIABLE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
LARGEST = 1 << 20  # bytes of a file that holds one value


class Unresolved:
    """A reference that is not followed, such as the compiler's: `{"env": NAME}` or `{"file": PATH}` is its `data`."""

    __slots__ = ("data",)

    def __init__(self, data: dict[str, str]) -> None:
        self.data = data

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Unresolved) and other.data == self.data

    def __hash__(self) -> int:
        return hash(tuple(self.data.items()))


class Referred(str):
    """A text that a reference gave; what is shown of it is the reference alone."""

    reference: str


class Missing:
    """What stands for the value of a reference that leads nowhere; `why` says where it comes from, and what is wrong
    there."""

    def __init__(self, why: str) -> None:
        self.why = why


class _Unusable(Exception):
    """Says of a file why it gives no value."""


def is_reference(data: object) -> bool:
    """Whether plain data, where a plain value is expected, refers to one that is not known yet."""
    return isinstance(data, dict) and len(data) == 1 and next(iter(data)) in KINDS


def is_sound(data: object) -> bool:
    """Whether it is a reference that can be followed."""
    if not isinstance(data, dict) or not is_reference(data):
        return False
    kind, name = next(iter(data.items()))
    return isinstance(name, str) and not problem(kind, name)


def problem(kind: str, name: object) -> str:
    """What is wrong with the name or path of a reference, or ''."""
    if kind == ENV:
        return "" if isinstance(name, str) and _VARIABLE.match(name) else "names no variable of the environment"
    if not isinstance(name, str) or not name or name[-1] in " \t/":
        return "names no file"
    return "has a path that no file has" if any(char in name for char in "\r\n\0") else ""


def spelled(kind: str, name: str) -> str:
    """The reference as properties have it."""
    return f"${{{kind}:{name}}}"


def read(text: str) -> dict[str, str] | None:
    """The reference that the text of a property is, or None."""
    if not (text.startswith("${") and text.endswith("}")):
        return None
    kind, colon, name = text[2:-1].partition(":")
    return {kind: name} if colon and kind in KINDS and not problem(kind, name) else None


def unresolved(text: str) -> Any:
    """The text itself, or the reference that it is."""
    found = read(text)
    return text if found is None else Unresolved(found)


def resolved(text: str, folder: str = "") -> Any:
    """The text itself, or what the reference stands for that it is; a relative path is one from the folder."""
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
    """What the data `{"env": NAME}` or `{"file": PATH}` stands for; other data as it is."""
    return resolved(spelled(*next(iter(raw.items())))) if is_sound(raw) else raw


def referring(text: str, reference: str) -> Referred:
    made = Referred(text)
    made.reference = reference
    return made


def _contents(path: str) -> str:
    """The text of a file, without one line end at its end."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)  # what is no file could block
        try:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):
                raise _Unusable("which is no regular file")
            with open(descriptor, "rb", closefd=False) as file:
                raw = file.read(LARGEST + 1)
        finally:
            os.close(descriptor)
    except OSError as error:
        raise _Unusable(f"which cannot be read: {error.strerror}") from None
    if len(raw) > LARGEST:
        raise _Unusable("which is larger than 1 MiB")
    if b"\0" in raw:
        raise _Unusable("which holds a NUL")
    if raw.endswith(b"\n"):
        raw = raw[: -2 if raw.endswith(b"\r\n") else -1]
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        raise _Unusable("which is not in UTF-8") from None
