"""Builds C++ components: one run of CMake and Ninja for all components of a workspace, one tree for each build type.

The tree is `build/TYPE/` in the workspace. Its CMakeLists.txt adds the folder of each component. A component has a tree
of its own below it if CMake cannot configure it together with the others, or if its CMakeLists.txt refers to itself as
the top-level one: what CMake can build alone can be built here. A component outside of a workspace is built in its own
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
from robocomp_yaml.building.job import ComponentBuild, Job
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.languages.cpp import workspace_tree
from robocomp_yaml.languages.cpp.tree import BuildTree, Failure, source_of
from robocomp_yaml.languages.cpp.workspace_tree import WorkspaceTree
from robocomp_yaml.source.regular import regular, whole
from robocomp_yaml.transactions import whole_file

_COMMANDS = "compile_commands.json"


def build(job: Job, units: list[Unit]) -> dict[Unit, ComponentBuild]:
    """Builds the units, and returns the result of each."""
    done: dict[Unit, ComponentBuild] = {}
    for unit in units:
        _outdate(unit, job.type)
    for root in dict.fromkeys(unit.root for unit in units):
        group = [unit for unit in units if unit.root == root]
        try:
            done |= _alone(job, group[0]) if group[0].is_alone else _together(job, root, group)
        except OSError as error:
            reason, hint = _why_not(error)
            for unit in group:
                job.add_failure(unit, reason, hint=hint)
                done[unit] = ComponentBuild(False)
    return {unit: done[unit] for unit in units}


def clean(units: Sequence[Unit], everything: bool, type_: str | None) -> list[str]:
    """Deletes the build trees of the units, or with `everything` all trees of their workspaces; returns their folders.

    Raises OSError if a folder cannot be deleted.
    """
    deleted: list[str] = []
    for root in dict.fromkeys(unit.root for unit in units):
        group = [unit for unit in units if unit.root == root]
        if group[0].is_alone:
            folders = [BuildTree.own_of(group[0]).folder]
        elif everything:
            folders = workspace_tree.folders(root, type_)
        else:
            folders = [folder for unit in group for folder in workspace_tree.parts(root, type_, unit.name)]
            workspace_tree.forget_configuration(root, type_)
        for folder in folders:
            if os.path.isdir(folder):
                shutil.rmtree(folder)
                deleted.append(folder)
    return deleted


def _why_not(error: OSError) -> tuple[str, str]:
    """Why the build cannot run, and a hint: a program is not installed, or a folder is not writable."""
    if isinstance(error, FileNotFoundError) and error.filename in ("cmake", "ninja", "make"):
        return f"the program '{error.filename}' is missing", "`sudo apt install cmake ninja-build g++`"
    return f"{error.filename or 'the build tree'}: {reason_of(error)}", ""


def _outdate(unit: Unit, type_: str) -> None:
    """Makes the program look old if this tree did not link it, so that it is linked again: Ninja and make compare only
    times."""
    stamp, program = stamps.load(unit), state(unit.program)
    if program is not None and (stamp is None or stamp.program != program or stamp.type != type_):
        if os.path.isfile(unit.program) and not os.path.islink(unit.program):
            with suppress(OSError):
                os.utime(unit.program, (0, 0))


def _together(job: Job, root: str, units: list[Unit]) -> dict[Unit, ComponentBuild]:
    with WorkspaceTree.locked(root, job) as whole:
        if whole is None:
            path = workspace_tree.folder_of(root, job.type)
            for unit in units:
                job.add_failure(unit, f"{path} was not created by rcyaml", hint="move it away")
            return dict.fromkeys(units, ComponentBuild(False))
        done: dict[Unit, ComponentBuild] = {}
        whole.admit(units)
        while whole.members:
            failure = whole.tree.configure(job) if whole.must_configure(job) else None
            made = failure or whole.tree.make(job, {unit: whole.part(unit) for unit in whole.members})
            if not isinstance(made, Failure):
                done |= made
                break
            if made.is_of_all or not whole.exclude(made):
                for unit in whole.members:
                    made.report(job, unit)
                    done[unit] = ComponentBuild(False)
                break
        for unit in [unit for unit in units if unit not in done]:
            made_alone = _in_own_tree(job, unit, BuildTree(source_of(unit), whole.own(unit), unit.root))
            whole.remember(unit, is_fit=made_alone is not None)
            done[unit] = made_alone or ComponentBuild(False)
        whole.save()
        _write_commands(root, [whole.folder, *whole.own_folders()])
    return done


def _alone(job: Job, unit: Unit) -> dict[Unit, ComponentBuild]:
    tree = BuildTree.own_of(unit)
    made = _in_own_tree(job, unit, tree)
    _write_commands(unit.folder, [tree.folder])
    return {unit: made or ComponentBuild(False)}


def _in_own_tree(job: Job, unit: Unit, tree: BuildTree) -> ComponentBuild | None:
    """The result; None if CMake cannot configure the component."""
    failure = tree.configure(job)
    if failure is None:
        made = tree.make(job, {unit: ""})
        if not isinstance(made, Failure):
            return made[unit]
        failure = made
    failure.report(job, unit)
    return None


def _write_commands(root: str, trees: Iterable[str]) -> None:
    """Writes `compile_commands.json` with the commands of these trees, unless the file is the user's."""
    path = os.path.join(root, _COMMANDS)
    entries = [entry for tree in trees for entry in _entries(os.path.join(tree, _COMMANDS))]
    if os.path.lexists(path) and (os.path.islink(path) or not _is_of_builds(path, root)):
        return
    text = json.dumps(entries, indent=1, ensure_ascii=False).encode("utf-8", "surrogateescape") + b"\n"
    with suppress(OSError):
        if not os.path.exists(path) or whole(path)[0] != text:
            whole_file.put(path, text)


def _is_of_builds(path: str, root: str) -> bool:
    """Whether each command in the file belongs to a tree in `build/`."""
    built = os.path.join(os.path.abspath(root), "build", "")
    return all(os.path.join(str(entry.get("directory", "")), "").startswith(built) for entry in _entries(path))


def _entries(path: str) -> list[dict[str, object]]:
    try:
        with open(path, encoding="utf-8", errors="surrogateescape", opener=regular) as file:
            entries = json.load(file)
    except (OSError, ValueError):
        return []
    return [entry for entry in entries if isinstance(entry, dict)] if isinstance(entries, list) else []
