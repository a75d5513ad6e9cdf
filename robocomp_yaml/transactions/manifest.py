"""The manifest of an output root: the files that rcyaml wrote, with their digests and owners."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress

import msgspec

from robocomp_yaml.source.regular import content
from robocomp_yaml.transactions.output_root import STATE

PATH = f"{STATE}/manifest.json"
BASE = f"{STATE}/base"
VERSION = 1


class Unusable(Exception):
    """The manifest cannot be used; the text is the reason."""


class Newer(Unusable):
    """A later version of rcyaml wrote the manifest."""


class ManifestEntry(msgspec.Struct, frozen=True, omit_defaults=True):
    """A file that rcyaml wrote: the digest of what rcyaml wrote last, the documents that own the file (paths relative
    to the root), and whether the file was written once and is the user's since."""

    hash: str
    owners: tuple[str, ...]
    once: bool = False


class _Known(msgspec.Struct):
    version: int
    files: dict[str, ManifestEntry]


_decoder = msgspec.json.Decoder(_Known)
_encoder = json.JSONEncoder(ensure_ascii=False)


class Manifest(msgspec.Struct, frozen=True):
    files: Mapping[str, ManifestEntry] = {}

    def text(self) -> str:
        """The text of the manifest, with one line for each file, so that diffs are short."""
        lines = [
            f"    {_json(path)}: {_json(msgspec.to_builtins(entry))}" for path, entry in sorted(self.files.items())
        ]
        return f'{{\n  "version": {VERSION},\n  "files": {{\n' + ",\n".join(lines) + "\n  }\n}\n"


def read(data: bytes | None) -> Manifest:
    """The manifest with this content; an empty one for None. Raises Unusable, or Newer."""
    if data is None:
        return Manifest()
    with suppress(msgspec.DecodeError):
        known = _decoder.decode(data)
        if known.version == VERSION:
            return Manifest(known.files)
    try:
        raw = json.loads(data)  # names that are not UTF-8 text, or a reason why it is unusable
        version = raw["version"]
        if isinstance(version, int) and version > VERSION:
            raise Newer("a later version of rcyaml wrote it")
        if version == VERSION and "files" in raw:
            return msgspec.convert(raw, Manifest)
    except (ValueError, LookupError, TypeError, RecursionError):
        pass
    raise Unusable("it is damaged")


def at(folder: str) -> Manifest:
    """The manifest of a folder; an empty one if there is none, or if it cannot be used."""
    return usable(content(os.path.join(folder, PATH)))


def usable(data: bytes | None) -> Manifest:
    """The manifest with this content; an empty one for None, or if it cannot be used."""
    try:
        return read(data)
    except Unusable:
        return Manifest()


def entries_of(file: str, manifest_of: Callable[[str], Manifest] = at) -> Iterator[ManifestEntry]:
    """The entries that manifests in the folders above a file have for it, the nearest first."""
    above, path = os.path.split(file)
    while path:
        entry = manifest_of(above).files.get(path)
        if entry:
            yield entry
        above, name = os.path.split(above)
        path = f"{name}/{path}" if name else ""


def any_has(file: str, hash_: str) -> bool:
    """Whether a manifest in a folder above the file lists the file as generated with this digest."""
    return any(not entry.once and entry.hash == hash_ for entry in entries_of(file))


def _json(value: object) -> str:
    """The JSON of a value, in which bytes of file names that are not UTF-8 are escaped."""
    text = _encoder.encode(value)
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode()
