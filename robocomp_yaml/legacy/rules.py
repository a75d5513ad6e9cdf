"""The rules of the legacy formats: `migrate/FORMAT/rules.yaml`, read once."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.source.tree import parse

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
    """How one legacy format is read. `migrate/README.md` says what each key of the file means."""

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
    """The file's content over that of the format which it extends."""
    path = f"{name}/rules.yaml"
    tree, diagnostics = parse(path, resources.text(f"migrate/{path}"))
    if tree is None or not isinstance(tree.data, dict):
        raise ValueError(f"migrate/{path} is broken: {diagnostics}")
    data = dict(tree.data)
    base = data.pop("extends", None)
    return {**(_data(base) if base else {}), **data}
