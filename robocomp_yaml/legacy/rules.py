"""The rules of the legacy formats: `migrate/FORMAT/rules.yaml`, read once."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from robocomp_yaml import resources
from robocomp_yaml.source.tree import parse

Texts = Mapping[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Rules:
    """How one legacy format is read. `migrate/README.md` says what each key of the file means."""

    name: str
    title: str
    kind: str
    document: str
    suffixes: tuple[str, ...]
    rank: int
    signature: re.Pattern[str]
    grammar: str
    converter: str
    names: re.Pattern[str]
    doc_strip: re.Pattern[str]
    doc_drop: str
    words: Texts = field(default_factory=dict)
    places: Texts = field(default_factory=dict)
    repairs: Texts = field(default_factory=dict)
    refusals: Texts = field(default_factory=dict)
    losses: Texts = field(default_factory=dict)
    keys: Texts = field(default_factory=dict)
    values: Mapping[str, Texts] = field(default_factory=dict)
    defaults: Texts = field(default_factory=dict)
    order: tuple[str, ...] = ()


@cache
def formats() -> tuple[Rules, ...]:
    """Every format that `migrate/` describes, by rank."""
    folders = sorted(path.parent.name for path in resources.folder("migrate").glob("*/rules.yaml"))
    return tuple(sorted((_rules(name) for name in folders), key=lambda rules: (rules.rank, rules.name)))


def _rules(name: str) -> Rules:
    data = _data(name)
    doc = data.pop("doc")
    return Rules(
        name=name,
        suffixes=tuple(data.pop("suffixes")),
        signature=re.compile(data.pop("signature")),
        names=re.compile(data.pop("names")),
        doc_strip=re.compile(doc["strip"], re.MULTILINE),
        doc_drop=doc["drop"],
        order=tuple(data.pop("order", ())),
        document=data.pop("document", f".{data['kind']}.yaml"),
        **data,
    )


def _data(name: str) -> dict[str, Any]:
    """The file's content over that of the format which it extends."""
    path = f"{name}/rules.yaml"
    tree, diagnostics = parse(path, resources.text(f"migrate/{path}"))
    if tree is None or not isinstance(tree.data, dict):
        raise ValueError(f"migrate/{path} is broken: {diagnostics}")
    data = dict(tree.data)
    base = data.pop("extends", None)
    return {**(_data(base) if base else {}), **data}
