"""Plans of a component's parameters, with the values in each of the component's configs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from robocomp_yaml.legacy.reading import SourceText
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.legacy.settings.entries import Item, Setting
from robocomp_yaml.legacy.settings.headers import Column
from robocomp_yaml.legacy.settings.shapes import Shape
from robocomp_yaml.legacy.settings.sorting import SortedSettings
from robocomp_yaml.semantics.spellings import Spelling

Path = tuple[str, ...]


class Corrections(msgspec.Struct, frozen=True):
    """The user's corrections (`--names`, `--rules`): columns by the key of their rows, types by parameter, and keys
    whose values are plain text instead of lists."""

    names: Mapping[str, Sequence[str]] = {}
    types: Mapping[str, str] = {}
    text: frozenset[str] = frozenset()


class Config(msgspec.Struct, frozen=True):
    """One config of a component. A setting that becomes part of a plan is removed from `sorted`."""

    name: str
    source: SourceText
    rules: Rules
    sorted: SortedSettings

    @property
    def parameters(self) -> list[Setting]:
        return self.sorted.parameters


class PlannedValue(msgspec.Struct, frozen=True):
    """A parameter's value in one config, and the settings that contain it."""

    item: Item
    settings: list[Setting] = []

    @property
    def line(self) -> int:
        return min((setting.span.line for setting in self.settings), default=0)


class ParameterPlan(msgspec.Struct):
    """A parameter, with its values by config. `built_in`: every component has it, so that no PDSL defines it. `guessed`
    is a message about what was guessed."""

    path: Path
    values: dict[str, PlannedValue] = {}
    spelled: Spelling | None = None
    shape: Shape | None = None
    docs: tuple[Column, ...] = ()
    built_in: bool = False
    guessed: str = ""
    is_unnamed: bool = False
    optional: bool = False
