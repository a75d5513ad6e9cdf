"""The stamp of a run: what it read, what was missing and what it wrote, so that the same run can be skipped.

A stamp compares contents: every file of the user is hashed again, and modification times are ignored. A stamp that
cannot be verified is stale, which costs only another run. The module imports little, because a run with nothing to do
needs only this module.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping

import msgspec
from msgspec.structs import asdict

import robocomp_yaml
from robocomp_yaml.source.digest import digest, states
from robocomp_yaml.source.discover import documents_below
from robocomp_yaml.source.disk import documents_in, names_in, state_of
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.real_paths import RealPaths
from robocomp_yaml.source.regular import regular, whole
from robocomp_yaml.transactions import whole_file

FOLDER = ".rcyaml/stamps"
_KEPT = 32
_DATA = ("schemas", "templates", "migrate")


class RunStamp(msgspec.Struct, frozen=True):
    """All paths are as the run used them: relative to its working folder, or absolute.

    `inputs`: for each file read, its real path, its digest and who may read it. `states` and `listed`: what else the
    run read of the disk, as `source.disk.Disk` records it. `names`: all names in folders. `walked`: for each folder,
    what `walked` returns. `outputs`: for each file written, its digest and who may read and execute it. `present`: the
    user's files, which must exist. `replay`: the result of the run, in the caller's form. `plugins`: the identity of
    the build of each plug-in that the workspaces name, '' if it is not installed.
    """

    tool: str
    inputs: dict[str, tuple[str, str]]
    states: dict[str, str]
    listed: dict[str, list[str]]
    names: dict[str, list[str]]
    walked: dict[str, list[str]]
    outputs: dict[str, tuple[str, str]]
    present: list[str]
    replay: dict[str, object]
    plugins: dict[str, str] = {}


def key(arguments: Iterable[str]) -> str:
    """The name of the stamp of a run with these arguments, in this working folder and with this search path."""
    return digest(json.dumps([list(arguments), os.getcwd(), os.environ.get("RCYAML_PATH", "")]).encode())


def create(
    *,
    inputs: Mapping[str, bytes],
    real: Callable[[str], str],
    states: Mapping[str, str],
    listed: Mapping[str, list[str]],
    names: Mapping[str, list[str]],
    walked: Mapping[str, list[str]],
    outputs: Mapping[str, str],
    present: Iterable[str],
    replay: Mapping[str, object],
    plugins: Iterable[str] = (),
) -> RunStamp | None:
    """The stamp of a run that has ended; None if one of its files was deleted since. `inputs` are the bytes that were
    read, `real` returns the real path of each, `outputs` are the digests of what was written: the disk may have changed
    since."""
    try:
        return RunStamp(
            own_tool(),
            {path: (real(path), f"{digest(data)} {_readers(os.stat(path)):o}") for path, data in inputs.items()},
            dict(states),
            dict(listed),
            dict(names),
            dict(walked),
            {path: (hash_, _permissions(os.lstat(path))) for path, hash_ in outputs.items()},
            sorted(present),
            dict(replay),
            _builds(plugins),
        )
    except OSError:
        return None


def is_current(stamp: RunStamp) -> bool:
    """Whether the run would read and write the same again."""
    try:
        return (
            all(os.path.lexists(path) for path in stamp.present)
            and reads_the_same(stamp)
            and all(_is_as_written(path, *written) for path, written in stamp.outputs.items())
        )
    except (OSError, ValueError, TypeError):
        return False


def reads_the_same(stamp: RunStamp) -> bool:
    """Whether the run would read the same again, whatever happened to the files that it wrote."""
    return changed_inputs(stamp) == set()


def changed_inputs(stamp: RunStamp) -> set[str] | None:
    """The paths of the inputs whose contents changed since; None if the run might also read other files now."""
    try:
        is_same = (
            all(state_of(path) == state for path, state in stamp.states.items())
            and all(documents_in(names_in(folder)) == recorded for folder, recorded in stamp.listed.items())
            and all(names_in(folder) == recorded for folder, recorded in stamp.names.items())
            and all(walked(folder) == recorded for folder, recorded in stamp.walked.items())
            and list(_real_paths(stamp.inputs)) == [real for real, _ in stamp.inputs.values()]
            and stamp.tool == tool()
            and _builds(stamp.plugins) == stamp.plugins
        )
        return {path for path, (_, state) in stamp.inputs.items() if _state(path) != state} if is_same else None
    except (OSError, ValueError, TypeError):
        return None


def load(folder: str, name: str) -> RunStamp | None:
    """The stamp of this name below a folder; None if it does not exist or cannot be read."""
    try:
        with open(_file(folder, name), "rb", opener=regular) as file:
            return msgspec.convert(json.load(file), RunStamp)
    except (OSError, ValueError, RecursionError):
        return None


def save(folder: str, name: str, stamp: RunStamp) -> None:
    """Saves a stamp below a folder. If that fails, the next run is not skipped."""
    path = _file(folder, name)
    if not stays_inside(folder or ".", os.path.join(FOLDER, f"{name}.json")):
        return
    with contextlib.suppress(OSError):
        os.makedirs(os.path.dirname(path), exist_ok=True)
        whole_file.ignore_all(os.path.dirname(path))
        whole_file.put(path, json.dumps(asdict(stamp), separators=(",", ":")).encode())
        _remove_old(os.path.dirname(path))


@functools.cache
def own_tool() -> str:
    """The identity of the rcyaml that this process runs, which stays the same if another one is installed meanwhile."""
    return tool()


def tool() -> str:
    """The identity of this rcyaml: its version, the RECORD of its installer (with the hashes of all files, which differ
    between two builds of one version), and size and times of each file, which detect later changes and those in a
    checkout."""
    package = os.path.dirname(os.path.abspath(robocomp_yaml.__file__))
    folder = os.path.dirname(package)
    tops = [package]
    if not os.path.isdir(os.path.join(package, "_data")):
        tops += (os.path.join(folder, name) for name in _DATA)
    parts = [robocomp_yaml.__version__, *_records(folder)]
    for top in tops:
        parts += states(top, len(folder))
    return digest("\n".join(parts).encode(errors="surrogateescape"))


def _builds(plugins: Iterable[str]) -> dict[str, str]:
    if not plugins:
        return {}
    from robocomp_yaml.plugins.loading import identity  # most workspaces have no plug-ins

    return {name: identity(name) for name in plugins}


def _records(folder: str) -> Iterator[str]:
    """The RECORD beside an installed package; none in a checkout, and in distributions without RECORD."""
    for name in sorted(os.listdir(folder)):
        if name.startswith("rcyaml-") and name.endswith(".dist-info"):
            with contextlib.suppress(OSError):
                yield f"{name} {_state(os.path.join(folder, name, 'RECORD'))}"


def _real_paths(paths: Iterable[str]) -> Iterator[str]:
    """The real path of each path."""
    yield from map(RealPaths().of, paths)


def walked(folder: str) -> list[str]:
    """The documents below a folder, and the output roots below it."""
    roots: list[str] = []
    return [*documents_below(folder, roots), *roots]


def _is_as_written(path: str, hash_: str, permissions: str) -> bool:
    if os.path.islink(path):
        return False
    data, status = whole(path)
    return _permissions(status) == permissions and digest(data) == hash_


def _permissions(status: os.stat_result) -> str:
    return f"{_readers(status) | status.st_mode & stat.S_IXUSR:o}"


def _readers(status: os.stat_result) -> int:
    """The permissions of group and others to read a file."""
    return status.st_mode & (stat.S_IRGRP | stat.S_IROTH)


def _state(path: str) -> str:
    data, status = whole(path)
    return f"{digest(data)} {_readers(status):o}"


def _file(folder: str, name: str) -> str:
    return os.path.join(folder, FOLDER, f"{name}.json")


def _remove_old(folder: str) -> None:
    stamps = [entry for entry in os.scandir(folder) if entry.name.endswith(".json")]
    for entry in sorted(stamps, key=lambda entry: entry.stat().st_mtime, reverse=True)[_KEPT:]:
        os.unlink(entry.path)
