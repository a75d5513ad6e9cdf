"""Exported files. An export overwrites only files that an export wrote, which are in a record beside them."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.deploy import folder, interfaces
from robocomp_yaml.diag.codes import emitting
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit import exports
from robocomp_yaml.network.network import ConfigFile, Network, Process
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.properties import without_secret
from robocomp_yaml.source.regular import regular

RECORD = ".rcyaml/exports.json"
_NO_CERTIFICATES = (
    "only `rcyaml deploy up` makes and renews the certificates that `security: tls` needs; with `rcyaml deploy "
    "install`, systemd calls it at boot"
)


def files(
    network: Network, form: str, plugins: Plugins, *, reveal: bool
) -> tuple[dict[str, str], list[Diagnostic]]:  # fmt: skip
    """The texts of an export by path, and warnings for what the form can express only in part. If the form cannot
    express the network, there are no files but an error. Unless `reveal`, secrets are hidden."""
    if network.is_tls:
        refused = exports.Unwritable(_NO_CERTIFICATES, network.name, Span(network.path))
        return {}, [_diagnostic(refused, form).as_severity(ERROR)]
    try:
        with exports.noted() as notes:
            network = interfaces.resolved(network)
            made = exports.export(network if reveal else hidden(network), form, plugins)
    except exports.Unwritable as error:
        return {}, [_diagnostic(error, form).as_severity(ERROR)]
    return made, list(dict.fromkeys(_diagnostic(note, form) for note in notes))


def _diagnostic(note: exports.Unwritable, form: str) -> Diagnostic:
    return codes.CHANGED_BY_EXPORT.at(note.span, name=note.name, form=form, reason=note)


def conflicts(output: str, files: Mapping[str, str]) -> list[Diagnostic]:
    """Files at the paths of exported files that no export wrote, or that were edited. Raises OSError."""
    written = _record(output)
    found = {path: _read(os.path.join(output, path)) for path in files}
    hint = "move it away, or export to another folder; an exported file that was edited is kept too"
    return [
        emitting.NOT_GENERATED.at(Span(os.path.join(output, path)), path=path, hint=hint)
        for path, data in found.items()
        if data is not None and data != _bytes(files[path]) and digest(data) != written.get(path)
    ]


def write(output: str, files: Mapping[str, str]) -> None:
    """Writes the files, which only their owner can read because they may contain secrets, and records them. Raises
    OSError."""
    digests = _record(output) | {path: digest(_bytes(text)) for path, text in files.items()}
    folder.write(output, RECORD, json.dumps(digests, indent=2, sort_keys=True) + "\n")
    for path, text in files.items():
        folder.write(output, path, text)


def _record(output: str) -> dict[str, str]:
    """The digests of exported files by path; empty if there is no valid record."""
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


def hidden(network: Network) -> Network:
    """The network without the secrets in commands, variables and configurations."""
    processes = {name: _process(process) for name, process in network.processes.items()}
    return replace(network, processes=processes, extra=_extra(network.extra))


def _process(process: Process) -> Process:
    names = process.secrets
    return replace(
        process,
        command=tuple(secrets.words(process.command, names)),
        env=tuple(replace(one, value=secrets.value(one.name, one.value, names)) for one in process.env),
        ready=replace(process.ready, command=tuple(secrets.words(process.ready.command, names))),
        config=_config(process.config, names) if process.config else None,
        extra=_extra(process.extra),
    )


def _config(config: ConfigFile, names: tuple[str, ...]) -> ConfigFile:
    """Hides secrets in a configuration: in Ice properties, and in any other text by its words."""
    known = frozenset((*config.secrets, *names))
    lines = [without_secret(line, known) for line in config.text.split("\n")]
    return replace(config, text="".join(secrets.hidden_lines("\n".join(lines), known)))


def _extra(extra: tuple[tuple[str, object], ...]) -> tuple[tuple[str, object], ...]:
    return tuple((name, _below(name, value)) for name, value in extra)


def _below(name: str, value: object) -> Any:
    if isinstance(value, dict):
        return {key: _below(key, item) for key, item in value.items()}
    if isinstance(value, list):
        return [_below(name, item) for item in value]
    return secrets.value(name, value) if isinstance(value, str) else value
