"""The differences between two specs of a process, field by field, in the user's words."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator

import msgspec
from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.model.deployment import UNLIMITED
from robocomp_yaml.network.network import (
    AUTO,
    FOREVER,
    SERVER,
    TASK,
    ConfigFile,
    EnvironmentVariable,
    Process,
)
from robocomp_yaml.source import properties


class Difference(msgspec.Struct, frozen=True):
    """`old` or `new` is '' if the field is absent. `is_live` is True if the new value applies without a restart."""

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


def differences(old: ProcessSpec, new: ProcessSpec) -> list[Difference]:
    """All differences, with secrets hidden."""
    before, after = old.process, new.process
    return [
        *_field("host", old.address, new.address),
        *([Difference("command", _command(old), _command(new))] if old.command != new.command else ()),
        *_field("cwd", before.cwd, after.cwd),
        *_entries("env", _variables(before.env), _variables(after.env), ()),
        *_entries("limits", _limits(before), _limits(after), ()),
        *_config(before.config, after.config, {*before.secrets, *after.secrets}),
        *_files(dict(old.digests), dict(new.digests)),
        *_live(before, after),
    ]


def _field(name: str, old: str, new: str, *, is_live: bool = False) -> Iterator[Difference]:
    if old != new:
        yield Difference(name, secrets.masked(old), secrets.masked(new), is_live)


def _entries(name: str, old: dict[str, str], new: dict[str, str], hidden: Collection[str]) -> Iterator[Difference]:
    """`hidden` are names of secrets, in addition to names that suggest a secret."""
    for key in [*old, *(key for key in new if key not in old)]:
        before, after = old.get(key), new.get(key)
        if before != after:
            yield Difference(f"{name} {key}", _shown(key, before, hidden), _shown(key, after, hidden))


def _shown(key: str, value: str | None, hidden: Collection[str]) -> str:
    """A value, with secrets hidden. An empty value differs from an absent one."""
    return "''" if value == "" else secrets.value(key, value or "", hidden)


def _limits(process: Process) -> dict[str, str]:
    limits = msgspec.to_builtins(process.limits)
    return {key: "any size" if value == UNLIMITED and key == "core" else str(value) for key, value in limits.items()
            if value is not None}  # fmt: skip


def _command(spec: ProcessSpec) -> str:
    return secrets.command(spec.command, spec.process.secrets)


def _variables(variables: tuple[EnvironmentVariable, ...]) -> dict[str, str]:
    return {variable.name: variable.shown for variable in variables}


def _config(old: ConfigFile | None, new: ConfigFile | None, names: set[str]) -> Iterator[Difference]:
    """By property. If no property differs, the text as a whole has changed."""
    if old and new and old.pem != new.pem:
        yield Difference("certificates")
    before, after = old.text if old else "", new.text if new else ""
    if before != after:
        hidden = {*names, *(old.secrets if old else ()), *(new.secrets if new else ())}
        found = list(_entries("config", properties.read(before).values, properties.read(after).values, hidden))
        yield from found or [Difference("config")]


def _files(old: dict[str, str], new: dict[str, str]) -> Iterator[Difference]:
    """Changed files. A file that is watched in one spec only is reported with the field that names it."""
    for path, digest in new.items():
        if path in old and old[path] != digest:
            yield Difference(shown_path(path) if digest else f"{shown_path(path)} (gone)")


def _live(before: Process, after: Process) -> Iterator[Difference]:
    """What applies without a restart. An endpoint that matters to the process itself is also in its configuration."""
    if before.endpoints != after.endpoints:
        served = list(_entries("serves", _served(before), _served(after), ()))
        yield from (replace(one, is_live=True) for one in served or [Difference("endpoints")])
    for name, view in (("ready", _ready), ("restart", _restart), ("alive", _alive)):
        old, new = view(before), view(after)
        for key in dict.fromkeys([*old, *new]):
            yield from _field(f"{name}.{key}", old.get(key, ""), new.get(key, ""), is_live=True)
    yield from _field("role", _role(before), _role(after), is_live=True)
    for name in ("after", "aliases", "groups", "folders"):
        yield from _names(name, getattr(before, name), getattr(after, name))
    if before.ready.pings != after.ready.pings and before.endpoints == after.endpoints:
        yield from _names("ready.pings", before.ready.pings, after.ready.pings)


def _served(process: Process) -> dict[str, str]:
    return {endpoint.interface: endpoint.text for endpoint in process.endpoints}


def _ready(process: Process) -> dict[str, str]:
    """Without the pings, which usually follow from what is served."""
    ready = process.ready
    port = "" if ready.port is None else str(ready.port)
    return {"within": f"{ready.within:g} s", "port": port, "command": " ".join(ready.command), "log": ready.log}


def _role(process: Process) -> str:
    return SERVER if process.is_server else TASK


def _restart(process: Process) -> dict[str, str]:
    restart = process.restart
    times = {"delay": restart.delay, "longest": restart.longest, "within": restart.window}
    return {
        "policy": restart.policy, "tries": str(restart.tries), **{key: f"{time:g} s" for key, time in times.items()}
    }  # fmt: skip


def _alive(process: Process) -> dict[str, str]:
    """Without the proxy, which follows from what is served."""
    alive = process.alive
    if alive is None:
        return {}
    worker = {AUTO: "ten periods", FOREVER: "off"}.get(alive.worker, f"{alive.worker:g} s")
    times = {"every": f"{alive.every:g} s", "within": f"{alive.within:g} s", "misses": str(alive.misses)}
    return {**times, "then": "restart" if alive.restarts else "tell", "worker": worker}


def _names(name: str, old: tuple[str, ...], new: tuple[str, ...]) -> Iterator[Difference]:
    """Names that were removed, and names that were added. Without either, the order has changed."""
    if old != new:
        removed = ", ".join(one for one in old if one not in new)
        yield Difference(name, removed, ", ".join(one for one in new if one not in old), is_live=True)


def shown_path(path: str) -> str:
    """A path relative to the working folder, if that is shorter."""
    short = os.path.relpath(path)
    return path if short.startswith("../..") else short
