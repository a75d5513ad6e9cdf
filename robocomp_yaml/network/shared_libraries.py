"""The shared libraries of the user that a program loads when it starts, as its ELF file and the paths in it say.

Libraries of the system are not among them: each host has its own. A library that a program opens by itself (`dlopen`)
is unknown.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Iterable, Iterator

import msgspec

from robocomp_yaml.source.regular import regular

_LOAD, _DYNAMIC = 1, 2  # kinds of segments
_NEEDED, _STRINGS, _RPATH, _RUNPATH = 1, 5, 15, 29  # tags of the dynamic section


class LinkedFile(msgspec.Struct, frozen=True):
    """What a program or library names: libraries, and the folders in which they are searched."""

    needed: tuple[str, ...]
    folders: tuple[str, ...]


def of(program: str, is_system: Callable[[str], object], more: Iterable[str] = ()) -> list[str]:
    """The absolute paths of the libraries of a program, also those of its libraries. `more` are folders that are
    searched, too, such as those of LD_LIBRARY_PATH. Libraries for which `is_system` holds are omitted."""
    found: dict[str, None] = {}
    rest, inherited = [program], list(more)
    while rest:
        path = rest.pop()
        linked = read(path)
        if linked is None:
            continue
        home = os.path.dirname(os.path.realpath(path))
        own = [folder.replace("$ORIGIN", home).replace("${ORIGIN}", home) for folder in linked.folders]
        for name in linked.needed:
            places = [name] if "/" in name else [os.path.join(folder, name) for folder in (*own, *inherited)]
            library = next((one for place in places if os.path.isfile(one := os.path.abspath(place))), "")
            if library and library not in found and not is_system(library):
                found[library] = None
                rest.append(library)
        inherited += [folder for folder in own if folder not in inherited]
    return list(found)


def read(path: str) -> LinkedFile | None:
    """What an ELF file names; None for any other file, and for a damaged one."""
    try:
        with open(path, "rb", opener=regular) as file:
            if file.read(4) != b"\x7fELF":
                return None
            file.seek(0)
            data = file.read()
        return _read(data)
    except (OSError, struct.error, IndexError, ValueError):
        return None


def _read(data: bytes) -> LinkedFile:
    is_wide, order = data[4] == 2, "<" if data[5] == 1 else ">"
    at, size, count = (
        (*struct.unpack_from(f"{order}Q", data, 32), *struct.unpack_from(f"{order}HH", data, 54)) if is_wide
        else (*struct.unpack_from(f"{order}I", data, 28), *struct.unpack_from(f"{order}HH", data, 42))
    )  # fmt: skip
    segments = [_segment(data, at + number * size, order, is_wide=is_wide) for number in range(count)]
    dynamic = [one for one in segments if one[0] == _DYNAMIC]
    entries = [entry for _, offset, _, length in dynamic for entry in _entries(data, offset, length, order, is_wide)]
    strings = next((value for tag, value in entries if tag == _STRINGS), 0)
    base = next((offset + strings - address for kind, offset, address, length in segments
                 if kind == _LOAD and address <= strings < address + length), 0)  # fmt: skip

    def text(value: int) -> str:
        return os.fsdecode(data[base + value : data.index(b"\0", base + value)])

    paths = [text(value) for tag, value in entries if tag in (_RPATH, _RUNPATH)]
    return LinkedFile(
        tuple(text(value) for tag, value in entries if tag == _NEEDED),
        tuple(folder for path in paths for folder in path.split(":") if folder),
    )


def _segment(data: bytes, at: int, order: str, *, is_wide: bool) -> tuple[int, int, int, int]:
    """Its kind, its place in the file, its address, and its size in the file."""
    if is_wide:
        kind, _, offset, address, _, length = struct.unpack_from(f"{order}IIQQQQ", data, at)
    else:
        kind, offset, address, _, length = struct.unpack_from(f"{order}IIIII", data, at)
    return kind, offset, address, length


def _entries(data: bytes, at: int, length: int, order: str, is_wide: bool) -> Iterator[tuple[int, int]]:
    form = f"{order}qQ" if is_wide else f"{order}iI"
    for offset in range(at, at + length, struct.calcsize(form)):
        tag, value = struct.unpack_from(form, data, offset)
        if not tag:
            return
        yield tag, value
