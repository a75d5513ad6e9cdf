"""Exported files on the disk: an export overwrites only what an export wrote, which a record beside the files says."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping

from robocomp_yaml.deploy import folder
from robocomp_yaml.diag.codes import emitting
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit import exports
from robocomp_yaml.network.network import Network
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import regular

RECORD = ".rcyaml/exports.json"


def files(
    network: Network, form: str, plugins: Plugins, *, reveal: bool
) -> tuple[dict[str, str], list[Diagnostic]]:  # fmt: skip
    """The files of an export, and what it says otherwise than the network; an error, and no files, where it cannot say
    it at all. Unless `reveal`, secrets are hidden."""
    from robocomp_yaml.network.hidden import hidden

    try:
        with exports.noted() as notes:
            made = exports.export(network if reveal else hidden(network), form, plugins)
    except exports.Unwritable as refused:
        return {}, [_told(refused, form).as_severity(ERROR)]
    return made, list(dict.fromkeys(_told(note, form) for note in notes))


def _told(found: exports.Unwritable, form: str) -> Diagnostic:
    return codes.NOT_IN_THIS_FORM.at(found.span, name=found.name, form=form, reason=found)


def in_the_way(output: str, files: Mapping[str, str]) -> list[Diagnostic]:
    """What stands where a file is to be written, and no export wrote it. Raises OSError."""
    written = _record(output)
    found = {path: _read(os.path.join(output, path)) for path in files}
    hint = "or it was edited since; move it away, or export to another folder"
    return [
        emitting.NOT_GENERATED.at(Span(os.path.join(output, path)), path=path, hint=hint)
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
