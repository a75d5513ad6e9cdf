"""What tests for all languages need of each: a module per language, with the language's name and `SPOKEN`.

A language that has no module here is not tested by them, and a test says so.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from robocomp_yaml import languages
from robocomp_yaml.parameters.types import Parameters


@dataclass(frozen=True)
class Spoken:
    """`marks` skip where what it needs is absent. `worker` is the file with the methods of the user's class, `build`
    makes the program of a compiled component, `starts` what stands before the program where Python's own is to run it.
    `judge` makes of parameters a program that judges values with the
    generated accessors, as `cpp_accessors.Program`. `parameters` and `paper` are user's classes that `test_parameters.py` explains; what `stubs` gives of a skeleton
    stands behind the latter."""

    name: str
    worker: str
    build: Callable[[Path], None]
    parameters: str
    paper: str
    stubs: Callable[[str], str]
    marks: Sequence[pytest.MarkDecorator] = ()
    starts: tuple[str, ...] = ()
    judge: Callable[[Path, Parameters], Any] | None = None

    def command(self, program: Path) -> list[str | Path]:
        return [*self.starts, program]


@cache
def spoken(name: str) -> Spoken:
    found: Spoken = importlib.import_module(f"{__name__}.{name}").SPOKEN
    return found


def names() -> list[str]:
    return sorted(module.name for module in pkgutil.iter_modules(__path__))


def each() -> list[Any]:
    """Every language, for `pytest.mark.parametrize`."""
    return [pytest.param(name, marks=list(spoken(name).marks)) for name in languages.table() if name in names()]
