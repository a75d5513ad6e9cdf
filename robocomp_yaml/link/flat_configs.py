"""A component's flat `etc/config`, and who wrote it."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import partial

import msgspec

from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import properties
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.properties import FIRST_HEAD, VALUES_HEAD, IceProperty
from robocomp_yaml.source.text import MAX_DOCUMENT
from robocomp_yaml.transactions import manifest, settings
from robocomp_yaml.transactions.manifest import Manifest

FLAT = os.path.join("etc", "config")

EARLIER = {
    "Ice.Warn.Connections": "0", "Ice.Trace.Network": "0", "Ice.Trace.Protocol": "0", "Ice.MessageSizeMax": "20004800",
}  # fmt: skip
"""What earlier versions of rcyaml wrote in every first `etc/config`: defaults of Ice, and of the run time of today."""

_ADDRESS = pattern(r"\.Endpoints\Z|Proxy\Z")

_HEAD = pattern(rf"# Configuration of [^\n]*({re.escape(FIRST_HEAD)}|{re.escape(VALUES_HEAD)})")


class FlatConfig(msgspec.Struct, frozen=True):
    """A flat config as Ice reads it: its effective `entries`, and their values, `properties`. `is_written`: rcyaml
    wrote the file, and the user may have changed it; `is_unchanged`: nobody did. `base` are the properties as rcyaml
    wrote them, without those that a values document states; empty if they are unknown."""

    path: str
    text: str
    entries: Mapping[str, IceProperty] = {}
    properties: Mapping[str, str] = {}
    base: Mapping[str, str] = {}
    is_written: bool = False
    is_unchanged: bool = False

    def is_as_written(self, key: str) -> bool:
        """Whether a property is still as rcyaml wrote it. The interface of an address may have been renamed."""
        if key not in self.properties:
            return False
        if key not in self.base and (kind := _ADDRESS.search(key)):
            former = (other for other in self.base if other.endswith(kind[0]) and other not in self.properties)
            return any(self.base[other] == self.properties[key] for other in former)
        return self.base.get(key) == self.properties[key]


def flat_config(folder: str, disk: Disk) -> FlatConfig | None:
    """The `etc/config` of the component in a folder; None if there is none that can be read."""
    return flat_at(os.path.normpath(os.path.join(folder, FLAT)), disk)


def flat_at(path: str, disk: Disk) -> FlatConfig | None:
    """The flat config at a path; None if there is none that can be read."""
    raw = disk.read(path)[0] if disk.has_file(path) else None
    if raw is None:
        return None
    return disk.once(("flat config", path, raw), lambda: _read(path, raw, disk))


def _read(path: str, raw: bytes, disk: Disk) -> FlatConfig:
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
