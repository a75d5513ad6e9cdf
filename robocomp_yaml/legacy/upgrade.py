"""Upgrade documents of earlier versions: rename the keys that `migrate/upgrades.yaml` lists, and nothing else."""

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
    """A renamed key. `at` is the path of the mappings that have it, in which `*` is any key or item."""

    kind: str
    at: tuple[str, ...]
    old: str
    new: str
    reason: str


class Upgraded(msgspec.Struct):
    text: str
    diagnostics: list[Diagnostic] = []


@cache
def key_renames() -> tuple[KeyRename, ...]:
    """Return all renamed keys, the oldest change first. Raises ValueError if `migrate/upgrades.yaml` is broken."""
    tree, diagnostics = parse(_FILE, resources.text(f"migrate/{_FILE}"))
    if tree is None or not isinstance(tree.data, list):
        raise ValueError(f"migrate/{_FILE} is broken: {diagnostics}")
    return tuple(
        KeyRename(entry["kind"], tuple(entry["at"]), old, new, entry["reason"])
        for entry in tree.data for old, new in entry["rename"].items()
    )  # fmt: skip


def upgraded(path: str, kind: str, text: str, renames: Iterable[KeyRename] | None = None) -> Upgraded:
    """Return the text with all old keys renamed. Everything else, such as comments, is kept."""
    result = Upgraded(text)
    for rename in key_renames() if renames is None else renames:
        if rename.kind == kind:
            _apply(rename, path, result)
    return result


def _apply(rename: KeyRename, path: str, result: Upgraded) -> None:
    tree, diagnostics = parse(path, result.text)
    if tree is None or any(diagnostic.severity == "error" for diagnostic in diagnostics):
        return  # `check` reports what is wrong with it
    for parent in reversed(_mappings(tree, rename.at)):  # from the end, so that earlier locations remain valid
        entry = parent.entries.get(rename.old)
        if entry is None:
            continue
        key = entry[0]
        if rename.new in parent.entries:
            result.diagnostics.append(codes.BOTH_KEYS.at(key.span, old=rename.old, new=rename.new))
            continue
        renamed = _renamed(result.text, key, rename)
        if renamed is not None:
            result.text = renamed
            what = f"'{rename.old}' is now '{rename.new}': {rename.reason}"
            result.diagnostics.append(codes.UPGRADED.at(key.span, what=what))


def _mappings(root: Node, path: Sequence[str]) -> list[Mapping]:
    """Return the mappings at a path, in which `*` is any key or item."""
    nodes: list[Node | None] = [root]
    for step in path:
        parents = [node for node in nodes if node is not None]
        nodes = [child for node in parents for child in (node.children() if step == "*" else [node.get(step)])]
    return [node for node in nodes if isinstance(node, Mapping)]


def _renamed(text: str, key: Scalar, rename: KeyRename) -> str | None:
    """Return the text with a key renamed; None where the text at the key's location differs from the key."""
    lines = text.split("\n")
    line, start = lines[key.span.line - 1], key.span.column - 1
    start += line[start : start + 1] in ("'", '"')
    if not line.startswith(rename.old, start):
        return None
    lines[key.span.line - 1] = line[:start] + rename.new + line[start + len(rename.old) :]
    return "\n".join(lines)


def upgrade(run: MigrationRun, paths: Sequence[str]) -> None:
    """Plan the upgrade of the documents that `paths` name, and of those below. Documents that the run writes are
    skipped."""
    outputs = [(root.root.real, output.path) for root in run.roots.values() for output in root.outputs]
    written = {os.path.realpath(os.path.join(*parts)) for parts in outputs}
    seen = set[str]()
    for path in paths:
        for document in documents_below(path) if os.path.isdir(path) else [os.path.normpath(path)]:
            real = os.path.realpath(document)
            if kind_of(document) is not None and real not in written and real not in seen:
                seen.add(real)
                _plan(run, document)


def _plan(run: MigrationRun, document: str) -> None:
    raw, _ = read_bytes(document, MAX_DOCUMENT)
    kind = kind_of(document)
    if raw is None or kind is None or not any(rename.old.encode() in raw for rename in key_renames()):
        return
    try:
        whole = raw.decode("utf-8")
    except UnicodeDecodeError:
        return  # `check` reports it
    text = whole.removeprefix("\ufeff")
    mark = whole[: len(whole) - len(text)]
    result = upgraded(document, kind, text)
    run.general += result.diagnostics
    if mark + result.text != whole:
        root = run.root(root_for(document))
        relative = os.path.relpath(os.path.realpath(document), root.root.real)
        output = Output(relative, mark + result.text, UPGRADED, whole)
        root.outputs.append(output)
        run.upgrades.append((document, output))
