"""Exported files on the disk: an export overwrites only what an export wrote, which a record beside the files says."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping

from robocomp_yaml.deploy import folder
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import regular

RECORD = ".rcyaml/exports.json"


def in_the_way(output: str, files: Mapping[str, str]) -> list[str]:
    """The paths where something else stands than an export wrote. Raises OSError."""
    written = _record(output)
    found = {path: _read(os.path.join(output, path)) for path in files}
    return [
        path
        for path, data in found.items()
        if data is not None and data != _bytes(files[path]) and digest(data) != written.get(path)
    ]


def write(output: str, files: Mapping[str, str]) -> None:
    """Writes the files, which may hold what nobody else should read, and remembers them. Raises OSError."""
    digests = _record(output) | {path: digest(_bytes(text)) for path, text in files.items()}
    folder.write(output, RECORD, json.dumps(digests, indent=2, sort_keys=True) + "\n")
    for path, text in files.items():
        folder.write(output, path, text)


def _record(output: str) -> dict[str, str]:
    """Digests by path; without a record that can be read, nothing counts as ours."""
    try:
        raw = json.loads(_read(os.path.join(output, RECORD)) or b"{}")
    except (ValueError, RecursionError):
        return {}
    return raw if isinstance(raw, dict) else {}


def _read(path: str) -> bytes | None:
    try:
        with open(path, "rb", opener=regular) as file:
            return file.read()
    except FileNotFoundError:
        return None


def _bytes(text: str) -> bytes:
    return text.encode(errors="surrogateescape")
