"""A network as it may be shown: without the secrets in commands, variables and configurations."""

from __future__ import annotations

from typing import Any

from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.network.network import ConfigFile, Network, Process
from robocomp_yaml.source.properties import without_secret


def hidden(network: Network) -> Network:
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
    """A line is known as one of Ice's, or by the words of any other text."""
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
