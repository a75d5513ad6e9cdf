"""What differs between two specs of a process, field by field, in the user's words."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

import msgspec

from robocomp_yaml.deploy.spec import Spec
from robocomp_yaml.network.network import ConfigFile, Process, Variable
from robocomp_yaml.source import properties

_SECRET = re.compile(r"pass(word|wd|phrase)?|secret|token|credential|api_?key|private", re.IGNORECASE)
HIDDEN = "(hidden)"

_LIVE = ("after", "ready", "restart", "aliases", "groups", "endpoints", "folders")
"""Fields that hold without a restart. Where an endpoint changes what the process does, its configuration changes."""


class Difference(msgspec.Struct, frozen=True):
    """`old` and `new` are '' where there is nothing. `is_live` where it holds without a restart."""

    field: str
    old: str = ""
    new: str = ""
    is_live: bool = False

    def __str__(self) -> str:
        if not self.old and not self.new:
            return f"{self.field} changed"
        if not self.old:
            return f"{self.field}: {self.new} (new)"
        return f"{self.field}: {self.old} → {self.new}" if self.new else f"{self.field}: {self.old} (gone)"


def differences(old: Spec, new: Spec) -> list[Difference]:
    before, after = old.process, new.process
    return [
        *_field("host", old.address, new.address),
        *_field("command", _command(old), _command(new)),
        *_field("cwd", before.cwd, after.cwd),
        *_entries("env", _variables(before.env), _variables(after.env)),
        *_config(before.config, after.config),
        *_files(dict(old.digests), dict(new.digests)),
        *_live(before, after),
    ]


def _field(name: str, old: str, new: str, *, is_live: bool = False) -> Iterator[Difference]:
    if old != new:
        yield Difference(name, old, new, is_live)


def _entries(name: str, old: dict[str, str], new: dict[str, str]) -> Iterator[Difference]:
    for key in [*old, *(key for key in new if key not in old)]:
        before, after = old.get(key), new.get(key)
        if before != after:
            if _SECRET.search(key):
                before, after = before and HIDDEN, after and HIDDEN
            yield Difference(f"{name} {key}", _shown(before), _shown(after))


def _shown(value: str | None) -> str:
    """An empty value is not the same as none."""
    return "''" if value == "" else value or ""


def _command(spec: Spec) -> str:
    return " ".join(spec.command)


def _variables(variables: tuple[Variable, ...]) -> dict[str, str]:
    return {variable.name: f"{{env: {variable.source}}}" if variable.source else variable.value
            for variable in variables}  # fmt: skip


def _config(old: ConfigFile | None, new: ConfigFile | None) -> Iterator[Difference]:
    """By property; a text that differs in nothing else has changed as a whole."""
    before, after = old.text if old else "", new.text if new else ""
    if before != after:
        found = list(_entries("config", properties.read(before).values, properties.read(after).values))
        yield from found or [Difference("config")]


def _files(old: dict[str, str], new: dict[str, str]) -> Iterator[Difference]:
    """A file that was not watched before, or is no longer, is told by the field that names it."""
    for path, digest in new.items():
        if path in old and old[path] != digest:
            yield Difference(shown_path(path) if digest else f"{shown_path(path)} (gone)")


def _live(before: Process, after: Process) -> Iterator[Difference]:
    for name in _LIVE:
        if getattr(before, name) != getattr(after, name):
            yield Difference(name, is_live=True)


def shown_path(path: str) -> str:
    """A path as one would type it from here, where that is shorter."""
    short = os.path.relpath(path)
    return path if short.startswith("../..") else short
