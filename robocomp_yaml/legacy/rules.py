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


class Files(msgspec.Struct, frozen=True, eq=False):
    """Which files of a folder may be of a format, by their names: surely, or only if their content says so too."""

    certain: re.Pattern[str]
    folder: str
    other: re.Pattern[str]

    def fit(self, path: str) -> str:
        """`certain`, `perhaps`, or ''."""
        name = os.path.basename(path)
        if self.other.search(name):
            return ""
        if self.certain.search(name):
            return "certain"
        return "perhaps" if os.path.basename(os.path.dirname(os.path.abspath(path))) == self.folder else ""


class Rules(msgspec.Struct, frozen=True, eq=False):
    """How one legacy format is read. `migrate/README.md` says what each key of the file means. `grammar` is its text,
    `converter` the name of a module, `plugin` whose it is."""

    name: str
    title: str
    kind: str
    document: str
    suffixes: tuple[str, ...]
    rank: int
    signature: re.Pattern[str]
    converter: str
    names: re.Pattern[str]
    doc_strip: re.Pattern[str]
    doc_drop: str
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
    files: Files | None = None
    foreign: tuple[tuple[re.Pattern[str], str], ...] = ()
    invalid: Mapping[str, Any] = {}
    sections: Mapping[str, re.Pattern[str]] = {}
    records: tuple[Mapping[str, Any], ...] = ()
    counts: re.Pattern[str] | None = None
    stop: frozenset[str] = frozenset()


Formats = tuple[Rules, ...]


def built_in() -> list[str]:
    folder = resources.folder("migrate")
    return [name for name in sorted(os.listdir(folder)) if os.path.isfile(os.path.join(folder, name, "rules.yaml"))]


@cache
def formats() -> Formats:
    """Every format that `migrate/` describes, by rank."""
    return _by_rank(_rules(name, _data(name), f"{_CONVERTERS}.{{}}") for name in built_in())


def with_plugins(plugins: Plugins) -> Formats:
    """Those, and what plug-ins add: each a module with `RULES` (as `rules.yaml`), `GRAMMAR` (where it has one) and
    `convert`. Raises Faulty where one of them is not as it should be."""
    found: list[Rules] = []
    for name, (plugin, module) in plugins.of(FORMATS).items():
        with plugin.guarded(f"legacy format '{name}'"):
            data = _read("RULES", module.RULES)
            if hasattr(module, "GRAMMAR"):
                data["grammar"] = module.GRAMMAR
            found.append(_rules(name, _over_base(data), module.__name__, plugin))
    return _by_rank((*formats(), *found)) if found else formats()


def _by_rank(rules: Iterable[Rules]) -> Formats:
    return tuple(sorted(rules, key=lambda each: (each.rank, each.name)))


def _rules(name: str, data: dict[str, Any], converters: str, plugin: Plugin | None = None) -> Rules:
    """`converters` says which module a converter is."""
    doc = data.pop("doc")
    return Rules(
        name=name,
        converter=converters.format(data.pop("converter", "")),
        plugin=plugin,
        suffixes=tuple(data.pop("suffixes")),
        signature=re.compile(data.pop("signature")),
        names=re.compile(data.pop("names")),
        doc_strip=re.compile(doc["strip"], re.MULTILINE),
        doc_drop=doc["drop"],
        order=tuple(data.pop("order", ())),
        **_of_lines(data),
        document=data.pop("document", f".{data['kind']}.yaml"),
        **data,
    )


def _of_lines(data: dict[str, Any]) -> dict[str, Any]:
    """What formats of single lines have besides, compiled."""
    files, counts = data.pop("files", None), data.pop("counts", None)
    return {
        "files": Files(re.compile(files["certain"]), files["folder"], re.compile(files["other"])) if files else None,
        "foreign": tuple((re.compile(item["pattern"]), item["reason"]) for item in data.pop("foreign", ())),
        "sections": {name: re.compile(pattern) for name, pattern in data.pop("sections", {}).items()},
        "records": tuple(data.pop("records", ())),
        "counts": re.compile(counts) if counts else None,
        "stop": frozenset(data.pop("stop", ())),
    }


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
    """The rules over those of the format which they extend."""
    base = data.pop("extends", None)
    return {**(_data(base) if base else {}), **data}
