"""Reads a component's flat `etc/config`, and finds out who wrote it."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import partial

from robocomp_yaml.link.flat_configs import EARLIER, FLAT, FlatConfig
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import properties
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.properties import FIRST_HEAD, VALUES_HEAD
from robocomp_yaml.source.text import MAX_DOCUMENT
from robocomp_yaml.transactions import manifest, settings
from robocomp_yaml.transactions.manifest import Manifest

_HEAD = pattern(rf"# Configuration of [^\n]*({re.escape(FIRST_HEAD)}|{re.escape(VALUES_HEAD)})")


def config(path: str, raw: bytes, disk: Disk) -> FlatConfig:
    """The flat config of this content."""
    text = raw.decode("utf-8", "replace")
    entries = list(manifest.entries_of(disk.real(path), partial(_manifest, disk)))
    head = _HEAD.match(text)
    is_from_values = head is not None and head[1] == VALUES_HEAD
    is_unchanged = any(entry.hash == digest(raw) for entry in entries) if entries else is_from_values
    last = properties.read(text).last
    values = settings.read(path, text)
    first = {} if is_from_values else values
    before = first if is_unchanged else _base(path, disk, is_first=not is_from_values)
    return FlatConfig(path, text, last, values, before, bool(entries) or head is not None, is_unchanged)


def _manifest(disk: Disk, folder: str) -> Manifest:
    """The manifest of a folder. What rcyaml wrote last is not part of any stamp: only rcyaml changes it."""
    raw = disk.peek(os.path.join(folder, manifest.PATH), MAX_DOCUMENT)
    return disk.once(("manifest", folder), lambda: manifest.usable(raw or None))


def _base(path: str, disk: Disk, *, is_first: bool) -> Mapping[str, str]:
    """The properties of an `etc/config` as rcyaml wrote it, without those that a values document states."""
    root = os.path.dirname(os.path.dirname(path))
    relative = os.path.relpath(path, root)
    raw = disk.peek(os.path.join(root, manifest.BASE, relative), MAX_DOCUMENT)
    return {**(EARLIER if is_first and relative == FLAT else {}), **settings.read(path, raw.decode("utf-8", "replace"))}
