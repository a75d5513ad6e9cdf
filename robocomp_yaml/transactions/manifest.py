"""The manifest of an output root: which files rcyaml wrote there, for which documents, and what it wrote."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress

import msgspec

from robocomp_yaml.source.regular import regular
from robocomp_yaml.transactions.output_root import STATE

PATH = f"{STATE}/manifest.json"
BASE = f"{STATE}/base"
VERSION = 1


class Unusable(Exception):
    """The manifest cannot be understood; the text says why."""


class Newer(Unusable):
    """A later version of rcyaml wrote it."""


class ManifestEntry(msgspec.Struct, frozen=True, omit_defaults=True):
    """A file that rcyaml wrote: the digest of what it put there last (see `ownership`), the documents it was written
    for (paths relative to the root), and whether it was written once, as the user's."""

    hash: str
    owners: tuple[str, ...]
    once: bool = False


class Manifest(msgspec.Struct, frozen=True):
    files: Mapping[str, ManifestEntry] = {}

    def text(self) -> str:
        """One line a file, so that versions compare well."""
        lines = [
            f"    {_json(path)}: {_json(msgspec.to_builtins(entry))}" for path, entry in sorted(self.files.items())
        ]
        return f'{{\n  "version": {VERSION},\n  "files": {{\n' + ",\n".join(lines) + "\n  }\n}\n"


def read(data: bytes | None) -> Manifest:
    """The manifest of a root; an empty one where there is none. Raises Unusable."""
    if data is None:
        return Manifest()
    try:
        raw = json.loads(data)
        version = raw["version"]
        if isinstance(version, int) and version > VERSION:
            raise Newer("a newer rcyaml wrote it")
        if version == VERSION and "files" in raw:
            return msgspec.convert(raw, Manifest)
    except (ValueError, LookupError, TypeError, RecursionError):
        pass
    raise Unusable("it is damaged")


def any_has(file: str, hash_: str) -> bool:
    """Whether a manifest in a folder above the file says that rcyaml wrote it with this digest."""
    above, path = os.path.split(file)
    while path:
        with suppress(OSError, Unusable), open(os.path.join(above, PATH), "rb", opener=regular) as stream:
            entry = read(stream.read()).files.get(path)
            if entry and not entry.once and entry.hash == hash_:
                return True
        above, name = os.path.split(above)
        path = f"{name}/{path}" if name else ""
    return False


def _json(value: object) -> str:
    """As UTF-8, whatever the names of files are: bytes in them that are no text are escaped."""
    return json.dumps(value, ensure_ascii=False).encode("utf-8", "backslashreplace").decode()
