"""Checks whether the libraries and sources of `uses:` exist, with CMake, pkg-config, the records of pip, and the disk.

No name reaches a shell: programs are called with lists of arguments, and the schema allows no character that has a
meaning in CMake.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator
from importlib import metadata

import msgspec

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.emit.uses import constraints
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import WorkspaceSettings
from robocomp_yaml.model.component import CMAKE, LINK, PIP, PKG_CONFIG, Library

_SECONDS = 120
_WORDS = {
    CMAKE: "the CMake package", PKG_CONFIG: "the pkg-config module", LINK: "the library", PIP: "the Python package"
}  # fmt: skip
_CLASSES = ("", "classes", "Classes")


class LibraryStatus(msgspec.Struct, frozen=True):
    """Whether a library is installed. `version` is '' if it is unknown; `why` is the reason why the check failed."""

    is_installed: bool
    version: str = ""
    why: str = ""


def missing(
    components: Iterable[LinkedComponent], workspace_of: Callable[[str], WorkspaceSettings]
) -> Iterator[Diagnostic]:
    """A warning for each file, folder and library that is missing, and for each library with another version."""
    components = list(components)
    native = {
        (library.kind, library.name)
        for linked in components for library in linked.component.libraries
        if library.kind in (CMAKE, LINK) and library.kind in linked.component.language.target.has
    }  # fmt: skip
    answers = _by_cmake(sorted(native)) if native else {}
    for linked in components:
        component = linked.component
        has = component.language.target.has
        for library in component.libraries:
            if library.kind in has:
                key = (library.kind, library.name)
                if key not in answers:
                    answers[key] = (_by_pip if library.kind == PIP else _by_pkg_config)(library.name)
                yield from _about(library, answers[key])
        folders = (os.path.dirname(component.path), workspace_of(component.path).root)
        for source in (source for source in component.sources if source.kind in has):
            prefixes = _CLASSES if source.is_class else ("",)
            paths = (os.path.join(folder, prefix, source.path) for folder in folders for prefix in prefixes)
            if not any(map(os.path.isdir if source.is_class else os.path.isfile, paths)):
                what = "folder of classes" if source.is_class else "source"
                yield codes.NO_SOURCE.at(source.span, what=what, path=source.path)


def _about(library: Library, status: LibraryStatus) -> Iterator[Diagnostic]:
    what = f"{_WORDS[library.kind]} {library.name}"
    if not status.is_installed:
        yield codes.NOT_INSTALLED.at(library.span, what=what, why=f": {status.why}" if status.why else "")
    elif status.version and not _is_accepted(status.version, library.version):
        why = f": version {status.version} is installed"
        yield codes.NOT_INSTALLED.at(library.span, what=f"{what} {library.version.strip()}", why=why)


def _is_accepted(version: str, required: str) -> bool:
    """Whether a version satisfies the constraints. Versions that only pip understands are accepted."""
    installed = _numbers(version)
    for operator, number in constraints(required):
        if re.fullmatch(r"[\d.]+", number):
            limit = _numbers(number)
            width = max(len(installed), len(limit))
            a, b = (tuple(numbers) + (0,) * (width - len(numbers)) for numbers in (installed, limit))
            holds = {">=": a >= b, "<=": a <= b, ">": a > b, "<": a < b, "==": a == b, "=": a == b, "!=": a != b,
                     "~=": a >= b and a[: len(limit) - 1] == b[: len(limit) - 1]}  # fmt: skip
            if not holds[operator]:
                return False
    return True


def _numbers(version: str) -> tuple[int, ...]:
    match = re.match(r"\d+(\.\d+)*", version)
    return tuple(int(part) for part in match[0].split(".")) if match else ()


def _by_pip(name: str) -> LibraryStatus:
    try:
        return LibraryStatus(True, metadata.version(name.partition("[")[0]))
    except metadata.PackageNotFoundError:
        return LibraryStatus(False)


def _by_pkg_config(name: str) -> LibraryStatus:
    program = shutil.which("pkg-config")
    if program is None:
        return LibraryStatus(False, why="pkg-config, which would detect it, is missing, too")
    done = _run([program, "--modversion", name])
    return LibraryStatus(True, done.stdout.strip()) if done and done.returncode == 0 else LibraryStatus(False)


def _by_cmake(libraries: list[tuple[str, str]]) -> dict[tuple[str, str], LibraryStatus]:
    """The status of packages and libraries: from one project for all; from one for each if a package causes an
    error."""
    if shutil.which("cmake") is None:
        return dict.fromkeys(libraries, LibraryStatus(False, why="CMake, which would detect it, is missing, too"))
    answers = _configured(libraries)
    if answers is None and len(libraries) > 1:
        return {one: (_configured([one]) or {one: LibraryStatus(False)})[one] for one in libraries}
    return answers if answers is not None else dict.fromkeys(libraries, LibraryStatus(False))


def _configured(libraries: list[tuple[str, str]]) -> dict[tuple[str, str], LibraryStatus] | None:
    """The status of packages and libraries from one project; None if CMake reports an error."""
    lines = ["cmake_minimum_required(VERSION 3.20)", "project(Look LANGUAGES CXX)"]
    for number, (kind, name) in enumerate(libraries):
        if kind == CMAKE:
            lines.append(f"find_package({name} QUIET)")
            lines.append(f'if(NOT {name}_VERSION)\nset({name}_VERSION "${{{name}_VERSION_STRING}}")\nendif()')
            lines.append(f'message("rcyaml {number} ${{{name}_FOUND}} ${{{name}_VERSION}}")')
        else:
            lines += [f"find_library(l{number} NAMES {name})", f'message("rcyaml {number} ${{l{number}}}")']
    with tempfile.TemporaryDirectory(prefix="rcyaml-") as folder:
        with open(os.path.join(folder, "CMakeLists.txt"), "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        done = _run(["cmake", "-S", folder, "-B", f"{folder}/build"])
    if done is None or done.returncode != 0:
        return None
    answers = dict.fromkeys(libraries, LibraryStatus(False))
    for number, word, version in re.findall(r"^rcyaml (\d+) (\S*) ?(\S*)$", done.stderr, re.MULTILINE):
        there = bool(word) and word.upper() not in ("0", "FALSE", "OFF", "NO") and not word.endswith("-NOTFOUND")
        answers[libraries[int(number)]] = LibraryStatus(there, version)
    return answers


def _run(command: list[str]) -> subprocess.CompletedProcess[str] | None:
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
