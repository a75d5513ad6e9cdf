"""Older documents of ours, brought up to date in their text: what `migrate/upgrades.yaml` names, nothing else."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from functools import cache

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.outputs import UPGRADED, Output
from robocomp_yaml.legacy.result import MigrationRun
from robocomp_yaml.legacy.sources import root_for
from robocomp_yaml.source.discover import documents_below, kind_of
from robocomp_yaml.source.text import read_bytes
from robocomp_yaml.source.tree import Mapping, Node, Scalar, parse

MAX_DOCUMENT = 4 << 20
_FILE = "upgrades.yaml"


class KeyRename(msgspec.Struct, frozen=True):
    """A key that has another name now."""

    kind: str
    at: tuple[str, ...]
    old: str
    new: str
    reason: str


class Upgraded(msgspec.Struct):
    text: str
    diagnostics: list[Diagnostic] = []


@cache
def changes() -> tuple[KeyRename, ...]:
    tree, said = parse(_FILE, resources.text(f"migrate/{_FILE}"))
    if tree is None or not isinstance(tree.data, list):
        raise ValueError(f"migrate/{_FILE} is broken: {said}")
    return tuple(
        KeyRename(entry["kind"], tuple(entry["at"]), old, new, entry["reason"])
        for entry in tree.data for old, new in entry["rename"].items()
    )  # fmt: skip


def upgraded(path: str, kind: str, text: str, known: Iterable[KeyRename] | None = None) -> Upgraded:
    """The text with every old key under its new name; all else, comments too, stays as it is."""
    result = Upgraded(text)
    for change in changes() if known is None else known:
        if change.kind == kind:
            _apply(change, path, result)
    return result


def _apply(change: KeyRename, path: str, result: Upgraded) -> None:
    tree, said = parse(path, result.text)
    if tree is None or any(fault.severity == "error" for fault in said):
        return  # `check` tells what is wrong with it
    for parent in reversed(_mappings(tree, change.at)):  # from the end, so that places before it stay
        entry = parent.entries.get(change.old)
        if entry is None:
            continue
        key = entry[0]
        if change.new in parent.entries:
            result.diagnostics.append(codes.BOTH_KEYS.at(key.span, old=change.old, new=change.new))
            continue
        renamed = _renamed(result.text, key, change)
        if renamed is not None:
            result.text = renamed
            what = f"'{change.old}' is now '{change.new}': {change.reason}"
            result.diagnostics.append(codes.UPGRADED.at(key.span, what=what))


def _mappings(root: Node, path: Sequence[str]) -> list[Mapping]:
    """The mappings at a path, in which `*` is any key or item."""
    nodes: list[Node | None] = [root]
    for step in path:
        parents = [node for node in nodes if node is not None]
        nodes = [child for node in parents for child in (node.children() if step == "*" else [node.get(step)])]
    return [node for node in nodes if isinstance(node, Mapping)]


def _renamed(text: str, key: Scalar, change: KeyRename) -> str | None:
    """The text with another key in the place of one; None where the key is not spelled out there."""
    lines = text.split("\n")
    line, start = lines[key.span.line - 1], key.span.column - 1
    start += line[start : start + 1] in ("'", '"')
    if not line.startswith(change.old, start):
        return None
    lines[key.span.line - 1] = line[:start] + change.new + line[start + len(change.old) :]
    return "\n".join(lines)


def upgrade(run: MigrationRun, paths: Sequence[str]) -> None:
    """Plans what changes in the documents among, or below, these paths. What the run writes anyway is left alone."""
    outputs = [(root.root.real, output.path) for root in run.roots.values() for output in root.outputs]
    taken = {os.path.realpath(os.path.join(*parts)) for parts in outputs}
    seen = set[str]()
    for path in paths:
        for document in documents_below(path) if os.path.isdir(path) else [os.path.normpath(path)]:
            real = os.path.realpath(document)
            if kind_of(document) is not None and real not in taken and real not in seen:
                seen.add(real)
                _plan(run, document)


def _plan(run: MigrationRun, document: str) -> None:
    raw, _ = read_bytes(document, MAX_DOCUMENT)
    kind = kind_of(document)
    if raw is None or kind is None or not any(change.old.encode() in raw for change in changes()):
        return
    try:
        whole = raw.decode("utf-8")
    except UnicodeDecodeError:
        return  # `check` tells
    text = whole.removeprefix("\ufeff")
    mark = whole[: len(whole) - len(text)]
    made = upgraded(document, kind, text)
    run.general += made.diagnostics
    if mark + made.text != whole:
        root = run.root(root_for(document))
        relative = os.path.relpath(os.path.realpath(document), root.root.real)
        output = Output(relative, mark + made.text, UPGRADED, whole)
        root.outputs.append(output)
        run.upgrades.append((document, output))
