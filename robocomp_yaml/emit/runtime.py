"""The run time of a language: the files that all of its components share.

Its version is a digest of all its files. Generated code names the version that it needs.
"""

from __future__ import annotations

import os
import re
from functools import cache
from importlib import import_module

from robocomp_yaml import resources
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.lowering.component import BEHAVIOR, COMMON
from robocomp_yaml.languages import language
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions.plan import FilePlan

_COMMENT = pattern(r"//[^\n]*|/\*.*?\*/|\s+", re.DOTALL)
OWN = "RcYaml.ice"
"""The Slice of the facet with which components describe themselves."""

VERSION = "@RUNTIME_VERSION@"
"""The placeholder for the version in files of the run time."""


@cache
def files(name: str) -> tuple[FilePlan, ...]:
    """The files of the run time of a language, below the folder of the run time."""
    version_ = version(name)
    return tuple(
        FilePlan(path, text.replace(VERSION, version_) if VERSION in text else text) for path, text in _texts(name)
    )


@cache
def version(name: str) -> str:
    """The version of the run time of a language."""
    return digest("\0".join(part for file in _texts(name) for part in file).encode())[:12]


@cache
def _texts(name: str) -> tuple[tuple[str, str], ...]:
    target = language(name)
    texts = []
    for folder in target.runtime:
        package, _, last = folder.rpartition(".")
        source = os.path.dirname(import_module(folder).__file__ or "") if package else f"{target.templates}/{folder}"
        target_folder = f"runtime/{last}" if package else folder
        texts += [(f"{target_folder}/{file}", text) for file, text in resources.files(source)]
    return (*texts, *((f"slice/{file}", resources.text(f"templates/slice/{file}")) for file in (COMMON, OWN)))


def has_common(linked: LinkedComponent) -> bool:
    """Whether the component can use the CommonBehavior of the run time: it names none itself, or one with the same
    meaning."""
    return all(
        slice_target.file_name(scope) == COMMON and _meaning(slice_target.text(scope)) == _meaning(_common())
        for scope in linked.modules()
        if scope.module.name == BEHAVIOR
    )


@cache
def _common() -> str:
    return resources.text(f"templates/slice/{COMMON}")


def _meaning(text: str) -> str:
    """Slice without comments, blanks and include guards."""
    return _COMMENT.sub("", re.sub(r"^\s*#.*$", "", text, flags=re.MULTILINE))
