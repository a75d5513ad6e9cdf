"""What a component's parameters will be: one plan for each, with its values in each of the component's configs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from robocomp_yaml.legacy.reading import Source
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.legacy.settings.entries import Item, Setting
from robocomp_yaml.legacy.settings.headers import Column
from robocomp_yaml.legacy.settings.shapes import Shape
from robocomp_yaml.legacy.settings.sorting import Sorted

Path = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Guesses:
    """What the user knows better (`--names`, `--rules`): columns by the key of their rows, types by parameter, and
    keys whose values are plain text, no lists."""

    names: Mapping[str, Sequence[str]] = field(default_factory=dict)
    types: Mapping[str, str] = field(default_factory=dict)
    text: frozenset[str] = frozenset()


@dataclass(slots=True)
class Config:
    """One config of a component. `sorted` loses what becomes part of a plan."""

    name: str
    source: Source
    rules: Rules
    sorted: Sorted

    @property
    def parameters(self) -> list[Setting]:
        return self.sorted.parameters


@dataclass(slots=True)
class Given:
    """A parameter's value in one config, and the settings that hold it there."""

    item: Item
    settings: list[Setting] = field(default_factory=list)

    @property
    def line(self) -> int:
        return min((setting.span.line for setting in self.settings), default=0)


@dataclass(slots=True)
class Spelled:
    """How a flat file spells a parameter: an entry of the PDSL's legacy table."""

    key: str = ""
    fields: dict[str, str] = field(default_factory=dict)
    first: int = 0
    columns: list[str] = field(default_factory=list)
    separator: str = ","
    separators: list[str] = field(default_factory=list)
    trailing: bool = False


@dataclass(slots=True)
class Plan:
    """A parameter. `built_in`: every component has it, so that no PDSL has to define it. `guessed` says what."""

    path: Path
    given: dict[str, Given] = field(default_factory=dict)
    spelled: Spelled | None = None
    shape: Shape | None = None
    docs: tuple[Column, ...] = ()
    built_in: bool = False
    guessed: str = ""
    is_unnamed: bool = False
    optional: bool = False
