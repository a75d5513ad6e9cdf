"""Where a person moved the boxes of a picture: `.rcyaml/layout/` of the workspace, a file for each deployment.

Positions are pixels from the upper left corner, by the names of the picture's nodes.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import TypeVar

import msgspec

from robocomp_yaml.api.refusals import cannot_write
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.model.deployment import INDEX
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.regular import whole
from robocomp_yaml.transactions import whole_file

FOLDER = ".rcyaml/layout"
FARTHEST = 100_000.0  # pixels
MOST = 20_000  # nodes
_LONGEST = 1000  # characters of a name
_SUFFIX = ".ddsl.yaml"

T = TypeVar("T")
Position = tuple[float, float]


class Layout(msgspec.Struct):
    positions: dict[str, Position] = {}


def read(document: str) -> dict[str, Position]:
    """The positions of a deployment; none if there is no file that can be read."""
    try:
        return msgspec.json.decode(whole(path_of(document))[0], type=Layout).positions
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError):
        return {}


def move(document: str, positions: Mapping[str, Position | None]) -> dict[str, Position]:
    """Keeps positions; None forgets one. Returns all positions. Raises Refused if one is too far, or the file cannot be
    written."""
    now = read(document)
    for name, position in positions.items():
        if position is None:
            now.pop(name, None)
            continue
        if not all(0 <= part <= FARTHEST for part in position):
            raise Refused(f"the position of '{name[:100]}' is not between 0 and {FARTHEST:.0f}")
        now[name] = (round(position[0], 1), round(position[1], 1))
    if len(now) > MOST or any(len(name) > _LONGEST for name in now):
        raise Refused("these are too many positions, or too long names")
    _write(document, now)
    return now


def rename(document: str, old: str, new: str) -> None:
    """An entry has another name; its processes keep their positions. `{i}` is the number of a process."""
    now = read(document)
    made = renamed(now, old, new)
    if made != now:
        _write(document, made)


def renamed(of_processes: Mapping[str, T], old: str, new: str) -> dict[str, T]:
    """What is kept of processes, by the names that they have after their entry got another one."""
    pattern = re.compile(re.escape(old).replace(re.escape(INDEX), r"(\d+)"))
    made: dict[str, T] = {}
    for name, value in of_processes.items():
        found = pattern.fullmatch(name)
        number = found[1] if found is not None and INDEX in old else "0"
        is_lost = found is not None and INDEX not in new and number != "0"
        made[new.replace(INDEX, number) if found is not None and not is_lost else name] = value
    return made


def _write(document: str, positions: Mapping[str, Position]) -> None:
    path = path_of(document)
    text = msgspec.json.format(msgspec.json.encode(Layout(dict(sorted(positions.items())))), indent=1)
    root, folder = path.split(f"/{FOLDER}/")[0], os.path.dirname(path)
    if not stays_inside(root, os.path.realpath(folder)):
        raise Refused(f"cannot write {path}: a link leads out of the workspace")
    try:
        os.makedirs(folder, exist_ok=True)
        whole_file.put(path, text + b"\n")
    except OSError as error:
        raise cannot_write(path, error) from None


def path_of(document: str) -> str:
    """The path of the file for a deployment."""
    real = os.path.realpath(document)
    folder = os.path.dirname(real)
    root = root_above(folder) or folder
    name = os.path.relpath(real, root).removesuffix(_SUFFIX)
    return os.path.join(root, FOLDER, f"{name}.json")
