"""Units for systemd: a service for each process, and a target that starts all of them. If there are several hosts, each
has a folder.

Configurations are read below %E/NAME: /etc/NAME, or ~/.config/NAME for the systemd of a user.
"""

from __future__ import annotations

import re

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._commands import by_host, configs, file_name, with_files
from robocomp_yaml.emit.exports._unwritable import Unwritable
from robocomp_yaml.model.deployment import UNLIMITED, ResourceLimits
from robocomp_yaml.network.network import ICESTORM, Network, Process
from robocomp_yaml.source.text import OF_NO_LINE

_SPECIAL = "-@:+!|"
_LIMITS = {
    "memory": "MemoryMax", "cpu": "CPUQuota", "cores": "CPUAffinity", "nice": "Nice",
    "realtime": "CPUSchedulingPriority", "core": "LimitCORE", "files": "LimitNOFILE",
}  # fmt: skip
_UNIT_NAME = re.compile(r"[^A-Za-z0-9:_.-]")
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def export(network: Network) -> dict[str, str]:
    files: dict[str, str] = {}
    for below, processes in by_host(network):
        names = {process.name for process in processes}
        for process in processes:
            with _unwritable.of(process):
                files[f"{below}{_service(network, process.name)}"] = _unit(network, process, names)
        files[f"{below}{_target(network)}"] = _all(network, processes)
        files |= configs(below, processes)
    return files


def _unit(network: Network, process: Process, names: set[str]) -> str:
    restart, unit = process.restart, UnitFile()
    unit.section("Unit")
    unit.put("Description", plain(f"{process.name} of {network.name}"))
    unit.put("PartOf", _target(network))
    unit.put("After", "network-online.target")
    unit.put("Wants", "network-online.target")
    for name in (_service(network, name) for name in process.after if name in names):
        unit.put("After", name)
        unit.put("Wants", name)
    unit.put("StartLimitIntervalSec", f"{restart.window:g}")
    unit.put("StartLimitBurst", f"{restart.tries + 1}")  # systemd counts starts
    unit.section("Service")
    unit.put("Type", "exec")
    if process.cwd and process.kind != ICESTORM:
        unit.put("WorkingDirectory", folder(process.cwd))
    _environment(unit, network, process)
    config = f"{_home(network)}/{process.config.path}" if process.config else ""
    if process.folders:
        folders = " ".join(quoted(path, doubled="$") for path in process.folders)
        unit.put("ExecStartPre", f"mkdir -p -- {folders}")
    unit.put("ExecStart", _command(process, config))
    unit.put("Restart", restart.policy)
    unit.put("RestartSec", f"{restart.delay:g}")
    unit.put("TimeoutStopSec", "10")
    _limits(unit, process.limits)
    unit.section("Install")
    unit.put("WantedBy", _target(network))
    return unit.text


def _limits(unit: UnitFile, limits: ResourceLimits) -> None:
    for key, setting in _LIMITS.items():
        value = getattr(limits, key)
        if key == "realtime" and value is not None:
            unit.put("CPUSchedulingPolicy", "fifo")
        if value is not None:
            shown = "infinity" if value == UNLIMITED and key == "core" else value
            unit.put(setting, f"{shown}%" if key == "cpu" else f"{shown}")


def _environment(unit: UnitFile, network: Network, process: Process) -> None:
    for item in process.env:
        if not item.source and not item.file:
            unit.put("Environment", quoted(f"{item.name}={item.value}"))
    inherited = [item for item in process.env if item.source]
    if inherited:
        unit.comment("Variables of the machine that runs this, one NAME=VALUE per line: " + ", ".join(
            f"{item.name} (here called {item.source})" if item.source != item.name else item.name for item in inherited
        ))  # fmt: skip
        unit.put("EnvironmentFile", f"-{_home(network)}/{file_name(process.name)}.env")


def _all(network: Network, processes: list[Process]) -> str:
    unit = UnitFile()
    if any(process.config for process in processes):
        unit.comment(f"The folder config/ beside this file belongs to {_home(network)} (%E is /etc, or ~/.config).")
    unit.section("Unit")
    unit.put("Description", plain(network.name))
    for process in processes:
        if process.enabled:
            unit.put("Wants", _service(network, process.name))
    unit.section("Install")
    unit.put("WantedBy", "default.target")
    return unit.text


def _command(process: Process, config: str) -> str:
    """The command, escaped for systemd. Only the path of the configuration contains a specifier."""
    mark = "\ue000"  # a private character, which stands for this path
    program, *arguments = with_files(process, process.words(mark))
    if program[0] in _SPECIAL:  # a prefix with a meaning for systemd
        program, arguments = "/bin/sh", ["-c", 'exec "$@"', "sh", program, *arguments]
    # `$$` is a `$`; in the path of the program `$` cannot be escaped, so that replacement is switched off (`:`)
    doubled, prefix = ("", ":") if "$" in program else ("$", "")
    words = [prefix + quoted(program, doubled=doubled)]
    words += [r"\;" if word == ";" else quoted(word, doubled=doubled) for word in arguments]
    return " ".join(words).replace(mark, config)


def _service(network: Network, name: str) -> str:
    return f"{_UNIT_NAME.sub('_', network.name)}-{_UNIT_NAME.sub('_', name)}.service"


def _target(network: Network) -> str:
    return f"{_UNIT_NAME.sub('_', network.name)}.target"


def _home(network: Network) -> str:
    return f"%E/{file_name(network.name)}"


class UnitFile:
    """The text of a unit: comments, sections and settings. It checks every line, so that no value can become a second
    line. A value is text of one line: words in quotes (`quoted`), a folder (`folder`), or names that need neither."""

    def __init__(self) -> None:
        self._lines: list[str] = []

    @property
    def text(self) -> str:
        return "".join(f"{line}\n" for line in self._lines)

    def section(self, name: str) -> None:
        self._lines += ["", f"[{name}]"] if any(line.startswith("[") for line in self._lines) else [f"[{name}]"]

    def put(self, key: str, value: str) -> None:
        self._add(f"{key}={value}")

    def comment(self, text: str) -> None:
        self._add(f"# {text}")

    def _add(self, line: str) -> None:
        """Raises Unwritable if the line has a control character, or ends with a backslash, which continues it."""
        match = OF_NO_LINE.search(line)
        if match:
            raise Unwritable(f"a line of a unit cannot contain U+{ord(match[0]):04X}")
        if line.endswith("\\"):
            raise Unwritable("a line of a unit cannot end with a backslash")
        self._lines.append(line)


def quoted(word: str, *, doubled: str = "") -> str:
    """A word in quotes, in which systemd detects no specifier. The characters `doubled` are escaped by doubling. Raises
    Unwritable for a NUL."""
    escaped = OF_NO_LINE.sub(_escape, "".join(_ESCAPES.get(char, char) for char in word)).replace("%", "%%")
    for char in doubled:
        escaped = escaped.replace(char, char * 2)
    return f'"{escaped}"'


def _escape(match: re.Match[str]) -> str:
    number = ord(match[0])
    if not number:
        raise Unwritable("an argument or variable cannot contain a NUL")
    return f"\\x{number:02x}" if number < 0x80 else f"\\u{number:04x}"


def folder(path: str) -> str:
    """A path, which systemd reads without quotes. `/.` is added if its last character would get lost."""
    return percent(f"{path}/." if path.endswith((" ", "\\")) else path)


def percent(text: str) -> str:
    """A text in which systemd detects no specifier."""
    return text.replace("%", "%%")


def plain(text: str) -> str:
    """A text for people."""
    return percent(" ".join(text.split())).rstrip("\\")
