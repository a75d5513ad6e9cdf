"""Services for docker compose, in the network of their host. If there are several hosts, each has a folder.

The programs are those of the host: the image (`RCYAML_IMAGE`) has the libraries that they need, and their folders are
mounted at the same paths. A service is healthy when its process is ready; services that depend on it wait for that.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._commands import by_host, configs, file_name, with_files
from robocomp_yaml.model.deployment import ResourceLimits
from robocomp_yaml.network import limit_words
from robocomp_yaml.network.files import home_of, shared_folders
from robocomp_yaml.network.network import ALWAYS, ICESTORM, NEVER, Network, Process
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.source.yaml_text import quoted

_IMAGE = "${RCYAML_IMAGE:-debian:bookworm}"
_INSIDE = "/run/rcyaml"
_SYSTEM = re.compile(r"/(?:(?:usr|bin|s?bin|lib\w*|etc|proc|sys|dev|run|tmp)(?:/(?!local/\w)|$)|$)")
"""Folders of the image, which are not mounted."""


def export(network: Network) -> dict[str, str]:
    files: dict[str, str] = {}
    for folder, processes in by_host(network):
        by_name = {process.name: process for process in processes}
        lines = [f"name: {quoted(_project(network.name))}", "services:"]
        for process in processes:
            with _unwritable.of(process):
                lines += [f"  {line}" for line in _service(process, by_name)]
        files[f"{folder}compose.yaml"] = "\n".join(lines) + "\n"
        files |= configs(folder, processes)
    return files


def _service(process: Process, by_name: dict[str, Process]) -> list[str]:
    inside = f"{_INSIDE}/{os.path.basename(process.config.path)}" if process.config else ""
    priority = {key: getattr(process.limits, key) for key in ("nice", "realtime")}
    program, *arguments = with_files(process, [*limit_words.words(priority), *process.words(inside)])
    lines = [
        f"{quoted(file_name(process.name))}:", f"  image: {quoted(_IMAGE)}", '  network_mode: "host"', "  init: true",
        *_list("entrypoint", [program]), *_list("command", arguments), f"  restart: {quoted(_restart(process))}",
    ]  # fmt: skip
    lines += _limits(process.limits)
    if _folder(process):
        lines.append(f"  working_dir: {_text(process.cwd)}")
    if not process.enabled:
        lines.append('  profiles: ["disabled"]')
    variables = [item for item in process.env if not item.file]
    if variables:
        lines.append("  environment:")
        for item in variables:
            value = quoted(f"${{{item.source}}}") if item.source else _text(item.value)
            lines.append(f"    {quoted(item.name)}: {value}")
    lines += _volumes(process, inside)
    check = _health(process)
    if check:
        tries = max(int(process.ready.within), 1)
        more = ["    interval: 1s", "    timeout: 1s", f"    retries: {tries}"]
        lines += ["  healthcheck:", *(f"  {line}" for line in _list("test", ["CMD", *check])), *more]
    needed = [by_name[name] for name in process.after if name in by_name and by_name[name].enabled]
    if needed:
        lines.append("  depends_on:")
        for other in needed:
            condition = "service_healthy" if _health(other) else "service_started"
            lines.append(f"    {quoted(file_name(other.name))}: {{condition: {condition}}}")
    return lines


def _limits(limits: ResourceLimits) -> list[str]:
    """What docker itself limits. Priorities are set by programs of the image, as without docker."""
    lines = []
    if limits.cores is not None:
        lines.append(f"  cpuset: {quoted(limits.cores)}")
    if (limits.nice is not None and limits.nice < 0) or limits.realtime is not None:
        lines.append('  cap_add: ["SYS_NICE"]')
    sizes = {"core": limits.core, "nofile": limits.files}
    if any(size is not None for size in sizes.values()):
        lines += ["  ulimits:", *(f"    {key}: {size}" for key, size in sizes.items() if size is not None)]
    most = {
        "cpus": None if limits.cpu is None else quoted(f"{limits.cpu / 100:g}"),
        "memory": None if limits.memory is None else quoted(f"{limits.memory}b"),
    }
    if any(most.values()):
        lines += ["  deploy:", "    resources:", "      limits:"]
        lines += [f"        {key}: {value}" for key, value in most.items() if value]
    return lines


def _volumes(process: Process, inside: str) -> list[str]:
    """The mounts: the folders of the program, its configuration, and files with variables."""
    home = home_of(process)
    read = dict.fromkeys((home, _folder(process), *shared_folders(home)))
    mounts = [(folder, folder, False) for folder in read if folder and not _SYSTEM.match(folder)]
    mounts += [(folder, folder, True) for folder in process.folders]
    if process.config is not None:
        mounts.append((f"./{process.config.path}", inside, False))
    lines = [_mount(source, target, _WRITTEN if is_written else _READ) for source, target, is_written in mounts]
    lines += [_mount(path, path, _FILE) for path in _files(process)]
    return ["  volumes:", *lines] if lines else []


_READ, _WRITTEN = "read_only: true", "bind: {create_host_path: true}"
_FILE = f"{_READ}, bind: {{create_host_path: false}}"


def _mount(source: str, target: str, rights: str) -> str:
    return f"    - {{type: bind, source: {_text(source)}, target: {_text(target)}, {rights}}}"


def _files(process: Process) -> list[str]:
    """The files with variables. Raises Unwritable for one below `~`, because a container has no known home."""
    for one in process.env:
        if one.file.startswith("~/"):
            raise _unwritable.Unwritable(f"a container has no home for {one.file}: set another path for {one.name}")
    return list(dict.fromkeys(one.file for one in process.env if one.file))


def _folder(process: Process) -> str:
    """The working folder of a process; IceStorm needs none."""
    return "" if process.kind == ICESTORM else process.cwd


def _health(process: Process) -> list[str]:
    """The command that checks whether a process is ready: its own, or a connection to its port; empty for none."""
    if process.ready.command:
        return with_files(process, process.ready.command)
    listening = [endpoint.port for endpoint in process.endpoints if endpoint.port and endpoint.protocol == "tcp"]
    found = [one.port for proxy in map(proxy_at, process.ready.pings) if proxy for one in proxy.endpoints if one.port]
    pinged = found if not process.component else []
    port = process.ready.port or next(iter(pinged or ([] if process.ready.log else listening)), 0)
    return ["bash", "-c", f"</dev/tcp/127.0.0.1/{port}"] if port else []


def _restart(process: Process) -> str:
    if process.restart.policy in (NEVER, ALWAYS):
        return process.restart.policy
    return f"on-failure:{process.restart.tries}"


def _list(key: str, items: Iterable[str]) -> list[str]:
    return [f"  {key}: [{', '.join(map(_text, items))}]"]


def _text(text: str) -> str:
    """A text in quotes, in which compose detects no variable."""
    return quoted(text.replace("$", "$$"))


def _project(name: str) -> str:
    """The name of a project: lower-case letters, digits, `_` and `-`, and no `_` or `-` at the beginning."""
    return file_name(name).lower().replace(".", "_").lstrip("_-") or "deployment"
