"""IceGrid's daemons: the registry and the nodes of a deployment.

A node is started by a script, which bash runs on the node's host: for another host over SSH, or by hand with a command
that the user is shown. The script contains all that the node needs, including the deployment's key, and does nothing if
the node already runs.
"""

from __future__ import annotations

import getpass
import os
import shlex
import signal
import socket
import subprocess
from collections.abc import Collection, Mapping, Sequence

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import ssh
from robocomp_yaml.deploy.icegrid import settings
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles, Registry
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.own_address import own_address
from robocomp_yaml.deploy.time_limit import until
from robocomp_yaml.network.network import LOOPBACK, NetworkHost
from robocomp_yaml.source.properties import config_option, entry_line
from robocomp_yaml.transactions import whole_file

_BEGINS_WITHIN = 5.0  # seconds


def as_text(properties: Mapping[str, str]) -> str:
    return "".join(entry_line(key, value) + "\n" for key, value in properties.items())


def start_registry(files: GridFiles, registry: Registry) -> None:
    """Starts the registry under its guard, which restarts it after a crash. Raises OSError."""
    own = files.registry_folder
    for path in (own, f"{own}/data"):
        os.makedirs(path, mode=0o700, exist_ok=True)
    text = as_text(settings.of_registry(files, registry))
    own_folder.write(files.folder, "state/icegrid/registry/settings", text)
    own_folder.write(files.folder, "state/icegrid/registry/guard", resources.text("templates/icegrid/guard"))
    start_detached(["bash", f"{own}/guard", *_registry_program(files)], files.folder)


def succeed_guard(files: GridFiles) -> None:
    """Starts a successor of the registry's guard, if that was killed. Returns when it runs. Raises OSError."""
    own = files.registry_folder
    pid = pid_in(own, "pid")
    if pid is not None and f"{own}/guard" not in procfs.command(pid):
        command = ["bash", f"{own}/guard", "--watch", "killed", *_registry_program(files)]
        start_detached(command, files.folder)
        until(lambda: pid_in(own, "pid") != pid, _BEGINS_WITHIN)


def _registry_program(files: GridFiles) -> list[str]:
    """The folder and the command that the registry's guard is given."""
    return [files.registry_folder, "icegridregistry", _option(files.registry_folder)]


def _option(folder: str) -> str:
    """The option with which the daemon of this folder reads its settings."""
    return config_option(f"{folder}/settings")


def start_detached(command: Sequence[str], folder: str, **environment: str) -> int:
    """Starts a process of the deployment in a folder that goes on when this process ends. Returns its pid. Raises
    OSError."""
    started = subprocess.Popen(
        command, env={**os.environ, procfs.MARK: f"{folder}:", **environment}, stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True, cwd="/",
    )  # fmt: skip
    started.returncode = 0  # nobody waits for it
    return started.pid


def end(folder: str) -> None:
    """Sends SIGTERM to the guard of the daemon of this folder, which ends the daemon."""
    _signal(folder, "pid", f"{folder}/guard", signal.SIGTERM)


def kill(folder: str) -> None:
    """Kills the daemon of this folder and its guard."""
    _signal(folder, "pid", f"{folder}/guard", signal.SIGKILL)
    end_hung(folder)


def end_hung(folder: str) -> None:
    """Kills the daemon of this folder, which does not answer. Its guard starts it again."""
    _signal(folder, "program", _option(folder), signal.SIGKILL)


def _signal(folder: str, file_name: str, word: str, number: int) -> None:
    """Sends a signal to the process whose pid is in the file, if this word is in its command: a pid can be reused."""
    pid = pid_in(folder, file_name)
    if pid is not None and word in procfs.command(pid):
        procfs.send(pid, number)


def pid_in(folder: str, file_name: str) -> int | None:
    """The pid in the file, None without one."""
    try:
        return int(_text(f"{folder}/{file_name}"))
    except (OSError, ValueError):
        return None


def last_words(folder: str) -> str:
    """The last line of a daemon's log, or ''."""
    try:
        with open(f"{folder}/log", encoding="utf-8", errors="replace") as file:
            return next((line.strip() for line in reversed(file.readlines()) if line.strip()), "")
    except OSError:
        return ""


def write_script(files: GridFiles, host: NetworkHost, hosts: Collection[NetworkHost], registry: Registry) -> str:
    """The path of the script that starts the node of a host, one of the `hosts`."""
    address = "127.0.0.1" if host.address == LOOPBACK else own_address(host, hosts) or host.address
    who = f"{getpass.getuser()}@{socket.gethostname()}"
    facts = {
        "folder": files.on(host.name).folder,
        "host": host.name,
        "config": _option(f"{files.on(host.name).root}/nodes/{host.name}"),
        "owner": f"{who} {files.folder}, registry {registry.address}:{registry.port}",
        "certificate": _text(files.certificate),
        "key": _text(files.key),
        "settings": as_text(settings.of_node(files.on(host.name), host.name, address, registry)),
        **{name: resources.text(f"templates/icegrid/{name}") for name in ("run", "guard", "watch")},
    }
    head = "".join(f"{name}={shlex.quote(text.rstrip())}\n" for name, text in facts.items())
    path = f"state/icegrid/hosts/{host.name}.sh"
    own_folder.write(files.folder, path, head + resources.text("templates/icegrid/node"))
    return f"{files.folder}/{path}"


class NodeStart(msgspec.Struct, frozen=True):
    """The result of starting a node. `reason` is why that failed, or ''. `was_running` is True if it already ran.
    `hint` suggests what to do about the reason, or is ''."""

    reason: str = ""
    was_running: bool = False
    hint: str = ""


def outcome(code: int | None, output: str, errors: str) -> NodeStart:
    """The result of a node's script, from its exit code and its output."""
    reason = (errors.strip() or "the script that starts it failed") if code else ""
    return NodeStart(reason, output.rstrip().endswith("already"))


def start_local_node(script: str) -> NodeStart:
    """Starts a node on this machine."""
    with open(script, "rb") as file:
        done = subprocess.run(["bash", "-s"], stdin=file, capture_output=True, text=True, check=False, cwd="/")
    return outcome(done.returncode, done.stdout, done.stderr)


def by_hand(script: str, host: NetworkHost) -> str:
    """The command that starts a node on another host."""
    return f"{ssh.typed(host)} bash -s < {shlex.quote(script)}"


def _text(path: str) -> str:
    with open(path, encoding="ascii") as file:
        return file.read()


def is_alive(folder: str) -> bool:
    """Whether the daemon of this folder, or its guard, runs on this machine."""
    try:
        lock = os.open(f"{folder}/lock", os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        return not whole_file.lock(lock)
    finally:
        os.close(lock)
