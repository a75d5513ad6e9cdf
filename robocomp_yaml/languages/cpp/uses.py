"""The sources and libraries of the user that a component needs, as a file for CMake that looks them up."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence

import msgspec

from robocomp_yaml.emit.render import render
from robocomp_yaml.emit.uses import constraints
from robocomp_yaml.model.component import CMAKE, LINK, PKG_CONFIG, Component, Library, Source
from robocomp_yaml.transactions.plan import FilePlan

COMPILED = (".cpp", ".cc", ".cxx", ".c")
_OPERATORS = {
    ">=": "VERSION_GREATER_EQUAL", "<=": "VERSION_LESS_EQUAL", ">": "VERSION_GREATER", "<": "VERSION_LESS",
    "==": "VERSION_EQUAL", "=": "VERSION_EQUAL",
}  # fmt: skip


class UsedFile(msgspec.Struct, frozen=True):
    """A source file of the repository. A file that is not compiled is a header: its folder is a search path."""

    path: str
    is_compiled: bool


class UsesView(msgspec.Struct, frozen=True):
    """`folders` are the folders to search, relative to the component's; `libraries` are commands of CMake."""

    source: str
    name: str
    folders: list[str]
    files: list[UsedFile]
    classes: list[str]
    libraries: list[str]


def plan(
    component: Component, sources: Sequence[Source], native: Sequence[Library], folders: Sequence[str]
) -> list[FilePlan]:
    """`generated/uses.cmake`."""
    view = _view(component, sources, native, folders)
    return [FilePlan("generated/uses.cmake", render("cpp/uses.cmake.j2", view))]


def _view(
    component: Component, sources: Sequence[Source], native: Sequence[Library], folders: Sequence[str]
) -> UsesView:
    paths = [source.path for source in sources if not source.is_class]
    return UsesView(
        source=os.path.basename(component.path),
        name=component.name,
        folders=[f"/{folder}" if folder != "." else "" for folder in folders],
        files=[UsedFile(path, path.endswith(COMPILED)) for path in paths],
        classes=[source.path for source in sources if source.is_class],
        libraries=[_COMMANDS[library.kind](library) for library in native],
    )


def _package(library: Library) -> str:
    name = library.name
    return "\n".join([
        "get_property(component_before DIRECTORY PROPERTY IMPORTED_TARGETS)",
        f"find_package({name} QUIET)",
        f"if(NOT {name}_FOUND)",
        f'  list(APPEND component_missing "the CMake package {name}: find_package cannot find it. If it is installed, '
        f'say where: cmake -D{name}_DIR=FOLDER ...")',
        "else()",
        *_versions(library, name, f"the CMake package {name}"),
        "  get_property(component_after DIRECTORY PROPERTY IMPORTED_TARGETS)",
        "  list(REMOVE_ITEM component_after ${component_before})",
        f"  list(APPEND component_included ${{{name}_INCLUDE_DIRS}})",
        f"  if({name}_LIBRARIES OR {name}_LIBS)",
        f"    list(APPEND component_linked ${{{name}_LIBRARIES}} ${{{name}_LIBS}})",
        "  else()",
        "    foreach(target IN LISTS component_after)",
        "      get_target_property(component_type ${target} TYPE)",
        '      if(NOT component_type STREQUAL "EXECUTABLE")',
        "        list(APPEND component_linked ${target})",
        "      endif()",
        "    endforeach()",
        "  endif()",
        "endif()",
    ])  # fmt: skip


def _module(library: Library) -> str:
    name = library.name
    variable = f"component_{_plain(name)}"
    return "\n".join([
        "find_package(PkgConfig QUIET)",
        "if(PKG_CONFIG_FOUND)",
        f"  pkg_check_modules({variable} QUIET IMPORTED_TARGET {name})",
        "endif()",
        f"if(NOT {variable}_FOUND)",
        f'  list(APPEND component_missing "the library {name}: it is unknown to pkg-config")',
        "else()",
        *_versions(library, variable, f"the library {name}"),
        f"  list(APPEND component_linked PkgConfig::{variable})",
        "endif()",
    ])  # fmt: skip


def _library(library: Library) -> str:
    name = library.name
    variable = f"component_{_plain(name)}_library"
    return "\n".join([
        f"find_library({variable} NAMES {name})",
        f"if(NOT {variable})",
        f'  list(APPEND component_missing "the library {name}: the linker has no lib{name}. If it is installed, set '
        'where: cmake -DCMAKE_LIBRARY_PATH=FOLDER ...")',
        "else()",
        f"  list(APPEND component_linked ${{{variable}}})",
        "endif()",
    ])  # fmt: skip


def _versions(library: Library, prefix: str, what: str) -> Iterator[str]:
    for operator, number in constraints(library.version):
        if operator in _OPERATORS:
            yield f'  component_check_version("{what}" {prefix} {_OPERATORS[operator]} "{number}" "{operator}{number}")'


def _plain(name: str) -> str:
    return re.sub(r"\W", "_", name)


_COMMANDS = {CMAKE: _package, PKG_CONFIG: _module, LINK: _library}
