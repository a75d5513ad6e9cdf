"""C++ components built: all of a workspace by one run of CMake and Ninja, in one tree for each build type.

The tree is `build/TYPE/` in the workspace; its CMakeLists.txt adds the folder of each component. A component that
cannot be configured in the company of others, or whose CMakeLists.txt speaks of itself as the top, has a tree of its
own below it, so that whatever CMake builds by itself is built here, too. A component in no workspace is built in its
`build/`.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterable, Sequence
from contextlib import suppress

from robocomp_yaml.building import stamps
from robocomp_yaml.building.inputs import state
from robocomp_yaml.building.job import Job, Made
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.languages.cpp import whole_tree
from robocomp_yaml.languages.cpp.tree import Failure, Tree, source_of
from robocomp_yaml.languages.cpp.whole_tree import WholeTree
from robocomp_yaml.source.regular import regular, whole
from robocomp_yaml.transactions import whole_file

_COMMANDS = "compile_commands.json"


def build(job: Job, units: list[Unit]) -> dict[Unit, Made]:
    done: dict[Unit, Made] = {}
    for unit in units:
        _outdate(unit, job.type)
    for root in dict.fromkeys(unit.root for unit in units):
        group = [unit for unit in units if unit.root == root]
        try:
            done |= _alone(job, group[0]) if group[0].is_alone else _together(job, root, group)
        except OSError as error:
            reason, hint = _refused(error)
            for unit in group:
                job.failed(unit, reason, hint=hint)
                done[unit] = Made(False)
    return {unit: done[unit] for unit in units}


def clean(units: Sequence[Unit], everything: bool, type_: str | None) -> list[str]:
    """The trees of these; `everything`: of all in their workspaces."""
    gone: list[str] = []
    for root in dict.fromkeys(unit.root for unit in units):
        group = [unit for unit in units if unit.root == root]
        if group[0].is_alone:
            found = [Tree.own_of(group[0]).folder]
        elif everything:
            found = whole_tree.folders(root, type_)
        else:
            found = [folder for unit in group for folder in whole_tree.parts(root, type_, unit.name)]
            whole_tree.forget_configuration(root, type_)
        for folder in found:
            if os.path.isdir(folder):
                shutil.rmtree(folder)
                gone.append(folder)
    return gone


def _refused(error: OSError) -> tuple[str, str]:
    """Why there is no build, and what to do: a program is not installed, or nobody may write here."""
    if isinstance(error, FileNotFoundError) and error.filename in ("cmake", "ninja", "make"):
        return f"there is no program '{error.filename}'", "`sudo apt install cmake ninja-build g++`"
    return f"{error.filename or 'the build tree'}: {(error.strerror or str(error)).lower()}", ""


def _outdate(unit: Unit, type_: str) -> None:
    """A program that is not the last one of this tree is linked again: Ninja and make look at times alone."""
    stamp, program = stamps.load(unit), state(unit.program)
    if program is not None and (stamp is None or stamp.program != program or stamp.type != type_):
        if os.path.isfile(unit.program) and not os.path.islink(unit.program):
            with suppress(OSError):
                os.utime(unit.program, (0, 0))


def _together(job: Job, root: str, units: list[Unit]) -> dict[Unit, Made]:
    with WholeTree.locked(root, job) as whole:
        if whole is None:
            path = whole_tree.folder_of(root, job.type)
            for unit in units:
                job.failed(unit, f"{path} is not of rcyaml", hint="move it away")
            return dict.fromkeys(units, Made(False))
        done: dict[Unit, Made] = {}
        whole.admit(units)
        while whole.members:
            failure = whole.tree.configure(job) if whole.wants_configuring(job) else None
            made = failure or whole.tree.make(job, {unit: whole.part(unit) for unit in whole.members})
            if not isinstance(made, Failure):
                done |= made
                break
            if made.is_of_all or not whole.leave_out(made):
                for unit in whole.members:
                    made.tell(job, unit)
                    done[unit] = Made(False)
                break
        for unit in [unit for unit in units if unit not in done]:
            made_alone = _in_own_tree(job, unit, Tree(source_of(unit), whole.own(unit), unit.root))
            whole.remember(unit, is_fit=made_alone is not None)
            done[unit] = made_alone or Made(False)
        whole.save()
        _write_commands(root, [whole.folder, *whole.own_folders()])
    return done


def _alone(job: Job, unit: Unit) -> dict[Unit, Made]:
    tree = Tree.own_of(unit)
    made = _in_own_tree(job, unit, tree)
    _write_commands(unit.folder, [tree.folder])
    return {unit: made or Made(False)}


def _in_own_tree(job: Job, unit: Unit, tree: Tree) -> Made | None:
    """None where it cannot be configured."""
    failure = tree.configure(job)
    if failure is None:
        made = tree.make(job, {unit: ""})
        if not isinstance(made, Failure):
            return made[unit]
        failure = made
    failure.tell(job, unit)
    return None


def _write_commands(root: str, trees: Iterable[str]) -> None:
    """Joins those of these trees; one that somebody else wrote stays."""
    path = os.path.join(root, _COMMANDS)
    entries = [entry for tree in trees for entry in _entries(os.path.join(tree, _COMMANDS))]
    if os.path.lexists(path) and (os.path.islink(path) or not _is_of_builds(path, root)):
        return
    text = json.dumps(entries, indent=1, ensure_ascii=False).encode("utf-8", "surrogateescape") + b"\n"
    with suppress(OSError):
        if not os.path.exists(path) or whole(path)[0] != text:
            whole_file.put(path, text)


def _is_of_builds(path: str, root: str) -> bool:
    """Whether each command in it is of a tree in `build/`."""
    built = os.path.join(os.path.abspath(root), "build", "")
    return all(os.path.join(str(entry.get("directory", "")), "").startswith(built) for entry in _entries(path))


def _entries(path: str) -> list[dict[str, object]]:
    try:
        with open(path, encoding="utf-8", errors="surrogateescape", opener=regular) as file:
            found = json.load(file)
    except (OSError, ValueError):
        return []
    return [entry for entry in found if isinstance(entry, dict)] if isinstance(found, list) else []
