"""The sources and libraries of the user that a component needs, as a file for CMake that looks them up."""

from __future__ import annotations

import os
from collections.abc import Sequence

from robocomp_yaml.emit.render import render
from robocomp_yaml.emit.uses import constraints
from robocomp_yaml.model.component import CMAKE, LINK, PKG_CONFIG, Component, Library, Source
from robocomp_yaml.transactions.plan import FilePlan

COMPILED = (".cpp", ".cc", ".cxx", ".c")
_MACROS = {CMAKE: "package", PKG_CONFIG: "module", LINK: "library"}
_COMPARED = frozenset((">=", "<=", ">", "<", "==", "="))  # the operators of versions that CMake has


def plan(
    component: Component, sources: Sequence[Source], native: Sequence[Library], folders: Sequence[str]
) -> list[FilePlan]:
    """`generated/uses.cmake`."""
    files = [source.path for source in sources if not source.is_class]
    made = render(
        "cpp/uses.cmake.j2",
        source=os.path.basename(component.path),
        name=component.name,
        # to search, relative to the folder of the component
        folders=[f"/{folder}" if folder != "." else "" for folder in folders],
        uses=[
            *(f'rcyaml_use_file("{path}" {"ON" if path.endswith(COMPILED) else "OFF"})' for path in files),
            *(f'rcyaml_use_class("{source.path}")' for source in sources if source.is_class),
            *map(_used, native),
        ],
    )
    return [FilePlan("generated/uses.cmake", made)]


def _used(library: Library) -> str:
    ranges = [f'"{operator}{number}"' for operator, number in constraints(library.version) if operator in _COMPARED]
    return f"rcyaml_use_{_MACROS[library.kind]}({' '.join([library.name, *ranges])})"
