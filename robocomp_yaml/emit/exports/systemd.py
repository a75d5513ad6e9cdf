"""Units for systemd: one service a process, and a target that starts them all. Several hosts have a folder each.

Configurations are looked for below %E/NAME: /etc/NAME, or ~/.config/NAME of a user's own systemd.
"""

from __future__ import annotations

import re

from robocomp_yaml.emit.exports._commands import by_host, configs, file_name, words
from robocomp_yaml.network.network import ICESTORM, Network, Process

_UNIT_NAME = re.compile(r"[^A-Za-z0-9:_.-]")


def export(network: Network) -> dict[str, str]:
    files: dict[str, str] = {}
    for folder, processes in by_host(network):
        here = {process.name for process in processes}
        for process in processes:
            files[f"{folder}{_service(network, process.name)}"] = _unit(network, process, here)
        files[f"{folder}{_target(network)}"] = _all(network, processes)
        files |= configs(folder, processes)
    return files


def _unit(network: Network, process: Process, here: set[str]) -> str:
    needed = [_service(network, name) for name in process.after if name in here]
    restart = process.restart
    lines = [
        "[Unit]", f"Description={_plain(f'{process.name} of {network.name}')}", f"PartOf={_target(network)}",
        "After=network-online.target", "Wants=network-online.target",
        *(line for name in needed for line in (f"After={name}", f"Wants={name}")),
        f"StartLimitIntervalSec={restart.window:g}", f"StartLimitBurst={restart.tries + 1}",  # systemd counts starts
        "", "[Service]", "Type=exec",
    ]  # fmt: skip
    if process.cwd and process.kind != ICESTORM:
        lines.append(f"WorkingDirectory={_percent(process.cwd)}")
    lines += [f"Environment={_quoted(f'{item.name}={item.value}')}" for item in process.env if not item.source]
    given = [item for item in process.env if item.source]
    if given:
        lines.append("# Variables that are given where this runs, one NAME=VALUE a line: " + _plain(", ".join(
            f"{item.name} (here called {item.source})" if item.source != item.name else item.name for item in given
        )))  # fmt: skip
        lines.append(f"EnvironmentFile=-{_home(network)}/{file_name(process.name)}.env")
    config = f"{_home(network)}/{process.config.path}" if process.config else ""
    if process.folders:
        folders = " ".join(_quoted(folder, for_command=True) for folder in process.folders)
        lines.append(f"ExecStartPre=mkdir -p -- {folders}")
    lines += [
        f"ExecStart={_command(process, config)}", f"Restart={restart.policy}", f"RestartSec={restart.delay:g}",
        "TimeoutStopSec=10", "", "[Install]", f"WantedBy={_target(network)}",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _all(network: Network, processes: list[Process]) -> str:
    wanted = [f"Wants={_service(network, process.name)}" for process in processes if process.enabled]
    about = f"# The folder config/ beside this file belongs to {_home(network)} (%E is /etc, or ~/.config)."
    return "\n".join([
        *([about] if any(process.config for process in processes) else []),
        "[Unit]", f"Description={_plain(network.name)}", *wanted, "", "[Install]", "WantedBy=default.target",
    ]) + "\n"  # fmt: skip


def _command(process: Process, config: str) -> str:
    """The words, none of which means anything to systemd. The path of the configuration is the only one with a
    specifier in it."""
    mark = "\0"
    return " ".join(_quoted(word, for_command=True).replace(mark, config) for word in words(process, mark))


def _quoted(word: str, *, for_command: bool = False) -> str:
    """A word in quotes; `$` means something only in commands, and a lone `;` would begin another one."""
    if for_command and word == ";":
        return r"\;"
    escaped = "".join(_ESCAPES.get(char, char) for char in word).replace("%", "%%")
    return '"' + (escaped.replace("$", "$$") if for_command else escaped) + '"'


_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def _percent(text: str) -> str:
    return text.replace("%", "%%")


def _plain(text: str) -> str:
    """A text of one line in which no specifier is found."""
    return _percent(" ".join(text.split())).rstrip("\\")


def _service(network: Network, name: str) -> str:
    return f"{_UNIT_NAME.sub('_', network.name)}-{_UNIT_NAME.sub('_', name)}.service"


def _target(network: Network) -> str:
    return f"{_UNIT_NAME.sub('_', network.name)}.target"


def _home(network: Network) -> str:
    return f"%E/{file_name(network.name)}"
