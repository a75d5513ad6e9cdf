"""The rules of the legacy formats: `migrate/FORMAT/rules.yaml`, read once."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.plugins import FORMATS, Plugin, Plugins
from robocomp_yaml.source.tree import parse

_CONVERTERS = "robocomp_yaml.legacy.converters"

Texts = Mapping[str, str]


class FilePatterns(msgspec.Struct, frozen=True, eq=False):
    """Which files of a folder have a format by their names: certainly, or only if their content has its signature."""

    certain: re.Pattern[str]
    folder: str
    other: re.Pattern[str]

    def fit(self, path: str) -> str:
        """Return `certain`, `perhaps`, or ''."""
        name = os.path.basename(path)
        if self.other.search(name):
            return ""
        if self.certain.search(name):
            return "certain"
        return "perhaps" if os.path.basename(os.path.dirname(os.path.abspath(path))) == self.folder else ""


class ForeignMark(msgspec.Struct, frozen=True, eq=False):
    """A mark of another program's files, and the reason to reject them."""

    pattern: re.Pattern[str]
    reason: str


class DocMarkup(msgspec.Struct, frozen=True):
    """Parts of doc comments that are not documentation: `strip` is markup, `drop` are whole lines."""

    strip: str
    drop: str


class Rules(msgspec.Struct, frozen=True, eq=False, forbid_unknown_fields=True):
    """How one legacy format is read. `migrate/README.md` documents the keys. `grammar` is the text of the grammar,
    `converter` the name of a module, `plugin` the plug-in that defines the format."""

    name: str
    title: str
    kind: str
    document: str
    suffixes: tuple[str, ...]
    rank: int
    signature: re.Pattern[str]
    converter: str
    names: re.Pattern[str]
    doc: DocMarkup
    plugin: Plugin | None = None
    grammar: str = ""
    words: Texts = {}
    places: Texts = {}
    repairs: Texts = {}
    refusals: Texts = {}
    losses: Texts = {}
    keys: Texts = {}
    values: Mapping[str, Texts] = {}
    defaults: Texts = {}
    code: Texts = {}
    order: tuple[str, ...] = ()
    is_made: bool = False
    weak: bool = False
    keep_suffix: bool = False
    by_content: bool = False
    files: FilePatterns | None = None
    foreign: tuple[ForeignMark, ...] = ()
    invalid: Mapping[str, Any] = {}
    sections: Mapping[str, re.Pattern[str]] = {}
    records: tuple[Mapping[str, Any], ...] = ()
    counts: re.Pattern[str] | None = None
    stop: frozenset[str] = frozenset()


Formats = tuple[Rules, ...]


def built_in() -> list[str]:
    folder = resources.folder("migrate")
    return [name for name in resources.names("migrate") if os.path.isfile(os.path.join(folder, name, "rules.yaml"))]


@cache
def formats() -> Formats:
    """Return every format that `migrate/` describes, by rank."""
    return _by_rank(_rules(name, _data(name), f"{_CONVERTERS}.{{}}") for name in built_in())


def with_plugins(plugins: Plugins) -> Formats:
    """Return the built-in formats and those of plug-ins. A plug-in's format is a module with `RULES` (as `rules.yaml`),
    optionally `GRAMMAR`, and `convert`. Raises Faulty where one of them is not valid."""
    added: list[Rules] = []
    for name, (plugin, module) in plugins.of(FORMATS).items():
        with plugin.guarded(f"legacy format '{name}'"):
            data = _read("RULES", module.RULES)
            if hasattr(module, "GRAMMAR"):
                data["grammar"] = module.GRAMMAR
            added.append(_rules(name, _over_base(data), module.__name__, plugin))
    return _by_rank((*formats(), *added)) if added else formats()


def _by_rank(rules: Iterable[Rules]) -> Formats:
    return tuple(sorted(rules, key=lambda each: (each.rank, each.name)))


def _rules(name: str, data: dict[str, Any], converters: str, plugin: Plugin | None = None) -> Rules:
    """`converters` is the pattern of the converters' module names."""
    data["converter"] = converters.format(data.get("converter", ""))
    data.setdefault("document", f".{data['kind']}.yaml")
    return msgspec.convert({**data, "name": name, "plugin": plugin}, Rules, dec_hook=lambda _, text: re.compile(text))


def _data(name: str) -> dict[str, Any]:
    path = f"{name}/rules.yaml"
    data = _read(path, resources.text(f"migrate/{path}"))
    if "grammar" in data:
        data["grammar"] = resources.text(f"migrate/{data['grammar']}")
    return _over_base(data)


def _read(path: str, text: str) -> dict[str, Any]:
    tree, diagnostics = parse(path, text)
    if tree is None or not isinstance(tree.data, dict):
        raise ValueError(f"{path} is broken: {'; '.join(one.message for one in diagnostics)}")
    return dict(tree.data)


def _over_base(data: dict[str, Any]) -> dict[str, Any]:
    """Return the rules merged over those of the format that they extend."""
    base = data.pop("extends", None)
    return {**(_data(base) if base else {}), **data}
