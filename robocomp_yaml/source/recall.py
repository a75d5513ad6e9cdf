"""Results that depend on the disk, kept from one analysis to the next."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TypeVar

from robocomp_yaml.memory import Memory
from robocomp_yaml.source.discover import reads_again
from robocomp_yaml.source.disk import Disk, DiskRecord

_Kept = TypeVar("_Kept")


def recalled(
    memory: Memory, disk: Disk, part: Hashable, causes: tuple[object, ...], make: Callable[[Disk], _Kept]
) -> _Kept:  # fmt: skip
    """The result of `make` for this part of a pass, as `Memory.result`: what `make` requests of the disk that is passed
    to it is a cause, too. A recalled result is recorded as if it had been made."""
    if not memory.is_lasting:
        return make(disk)

    def recorded() -> tuple[_Kept, DiskRecord]:
        own = disk.apart()
        return make(own), own.record()

    causes = disk.version, disk.added, *causes
    made, record = memory.result(part, causes, recorded, lambda kept: reads_again(kept[1], disk))
    disk.recall(record)
    return made
