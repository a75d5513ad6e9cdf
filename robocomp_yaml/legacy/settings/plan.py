"""What a component's parameters will be: one plan for each, with its values in each of the component's configs."""

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
    """What the user knows better (`--names`, `--rules`): columns by the key of their rows, types by parameter, and
    keys whose values are plain text, no lists."""

    names: Mapping[str, Sequence[str]] = {}
    types: Mapping[str, str] = {}
    text: frozenset[str] = frozenset()


class Config(msgspec.Struct, frozen=True):
    """One config of a component. `sorted` loses what becomes part of a plan."""

    name: str
    source: SourceText
    rules: Rules
    sorted: SortedSettings

    @property
    def parameters(self) -> list[Setting]:
        return self.sorted.parameters


class PlannedValue(msgspec.Struct, frozen=True):
    """A parameter's value in one config, and the settings that hold it there."""

    item: Item
    settings: list[Setting] = []

    @property
    def line(self) -> int:
        return min((setting.span.line for setting in self.settings), default=0)


class ParameterPlan(msgspec.Struct):
    """A parameter. `built_in`: every component has it, so that no PDSL has to define it. `guessed` says what."""

    path: Path
    given: dict[str, PlannedValue] = {}
    spelled: Spelling | None = None
    shape: Shape | None = None
    docs: tuple[Column, ...] = ()
    built_in: bool = False
    guessed: str = ""
    is_unnamed: bool = False
    optional: bool = False
