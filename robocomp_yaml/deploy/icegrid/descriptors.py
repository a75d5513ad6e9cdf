"""A network's processes as IceGrid's descriptors.

Each process is a server on the node with the name of its host. The node's `run` script starts it, and only rcyaml
activates it, because IceGrid has no start order. No server enables Ice.Admin: a program that does not use Ice could
not, and a server that is expected to and does not would stay "activating".

IceGrid replaces `${…}` in every string, expands `$NAME` in environment variables, and drops empty arguments: therefore
each argument of `run` begins with a letter, and texts are encoded.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable
from typing import Any

import IceGrid
import msgspec

from robocomp_yaml.deploy import interfaces, liveness
from robocomp_yaml.deploy.engine import STOP_WITHIN
from robocomp_yaml.deploy.icegrid.grid_files import KEEPER, GridFiles
from robocomp_yaml.deploy.local.procfs import MARK
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.network import limit_words
from robocomp_yaml.network.network import Process

LONGEST_CONFIG = 100_000
"""The maximum size in bytes of a configuration for another host: Linux limits a variable to 128 KiB."""

_KEEPER_MODULE = "robocomp_yaml.deploy.icegrid.keeper"
# While a command changes the deployment, the keeper waits for a moment, so that starting processes are faster.
_KEEPER_SCRIPT = 'flock -s -w 10 -- "$1/state" true; shift; exec nice "$@"'
# Ends those children of the node that are `run` scripts of these processes. The node is also the parent of this script.
_ENDER_SCRIPT = """\
folder=$1; shift
for process in /proc/[0-9]*; do
    { read -r stat <"$process/stat" && mapfile -d "" words <"$process/cmdline"; } 2>/dev/null || continue
    read -r _ parent _ <<<"${stat##*) }"
    [[ $parent == "$PPID" && ${words[3]} == "$folder" ]] || continue
    for name; do [[ ${words[2]} == "$name" ]] && kill "${process##*/}"; done
done
exit 0
"""
_AFTER_KILL = 10  # seconds that IceGrid itself waits, after what `run` waits


def server(files: GridFiles, user: str, spec: ProcessSpec, number: int, *, is_local: bool) -> Any:
    """The descriptor of a process. For another host it contains the configuration. `number` is the number of its
    restart rule."""
    process = spec.process
    words = [process.name, files.folder, *(f"f{path}" for path in process.folders)]
    ports = {one.port for one in process.listening if one.port and one.protocol != "udp"}
    environment = [
        f"RCYAML_STOP_WITHIN={STOP_WITHIN:g}", f"RCYAML_RESTART={restart_rule(process, number)}",
        f"RCYAML_ALIVE={alive_rule(process)}", f"RCYAML_PORTS={' '.join(map(str, sorted(ports)))}",
    ]  # fmt: skip
    for place, variable in enumerate(process.env):
        if variable.source:
            words.append(f"s{variable.name}={variable.source}")
        elif variable.file:
            words.append(f"r{variable.name}={variable.file}")
        else:  # in the environment, because the words of a command are visible to everybody
            words.append(f"e{place}")
            environment.append(f"RCYAML_ENTRY_{place}={encoded(f'{variable.name}={variable.value}')}")
    if process.config and not is_local:
        words += [f"n{name}" for name in interfaces.names_of(process, spec.address)]
        words.append(f"c{spec.config_path}")
        environment.append(f"RCYAML_CONFIG={encoded(process.config.text)}")
    if process.config and process.config.pem and not is_local:
        words.append(f"c{files.folder}/{process.config.pem_path}")
        environment.append(f"RCYAML_PEM={encoded(process.config.pem)}")
    words += [f"l{word}" for word in limit_words.words(msgspec.to_builtins(process.limits))]
    words += [f"={part}" for part in spec.command]
    return IceGrid.ServerDescriptor(**_facts(
        process.name, "setpriv", ["--pdeathsig", "KILL", "--", "${node.data}/../run", *map(_literal, words)],
        pwd=_literal(process.cwd), envs=environment, user=user, activation="manual",
        logs=[_literal(files.log(process.name)), _literal(files.status(process.name))],
        deactivationTimeout=f"{STOP_WITHIN + _AFTER_KILL:g}",
    ))  # fmt: skip


def keeper(files: GridFiles, user: str) -> Any:
    """The keeper: a server that restarts processes when their node has come back. IceGrid itself restarts the
    keeper."""
    words = (files.folder, sys.executable, "-m", _KEEPER_MODULE, files.folder)
    options = ["--pdeathsig", "KILL", "--", "bash", "-c", _KEEPER_SCRIPT, "bash", *map(_literal, words)]
    environment = [f"PYTHONPATH={package_path()}", f"{MARK}={files.folder}:"]
    return _own(KEEPER, "setpriv", options, user, activation="always", envs=environment)


def ender(files: GridFiles, names: Iterable[str], user: str) -> Any:
    """A server that ends these processes on its host, which IceGrid has forgotten."""
    words = (_ENDER_SCRIPT, "bash", files.folder, *names)
    return _own(f"{KEEPER}.ender", "bash", ["-c", *map(_literal, words)], user)


def cleaner(paths: Iterable[str], user: str) -> Any:
    """A server that removes these files and folders of its host."""
    return _own(f"{KEEPER}.cleaner", "rm", ["-rf", "--", *map(_literal, paths)], user)


def _own(name: str, exe: str, options: list[str], user: str, **facts: Any) -> Any:
    """A server of rcyaml itself, which the `facts` describe further."""
    usual: dict[str, Any] = {"pwd": "/", "activation": "manual", "deactivationTimeout": "5", "envs": [], "logs": []}
    return IceGrid.ServerDescriptor(**_facts(name, exe, options, user=user, **{**usual, **facts}))


def package_path() -> str:
    """A PYTHONPATH with which Python imports this package and its dependencies."""
    return os.pathsep.join(path for path in sys.path if path)


def application(name: str, servers: Iterable[tuple[str, Any]]) -> Any:
    """The descriptor of an application. `servers` are pairs of a node's name and a descriptor."""
    nodes: dict[str, Any] = {}
    for host, one in servers:
        if host not in nodes:
            nodes[host] = IceGrid.NodeDescriptor(
                variables={}, serverInstances=[], servers=[], loadFactor="", description="", propertySets={}
            )
        nodes[host].servers.append(one)
    return IceGrid.ApplicationDescriptor(
        name=name, variables={}, replicaGroups=[], serverTemplates={}, serviceTemplates={}, nodes=nodes,
        distrib=_nothing_to_distribute(), description="", propertySets={},
    )  # fmt: skip


def restart_rule(process: Process, number: int) -> str:
    """The restart rule in the format of `run`: its number, which grows with each new rule, the policy, the maximum
    number of restarts, and times in milliseconds."""
    rule = process.restart
    times = f"{rule.delay * 1000:.0f} {rule.longest * 1000:.0f} {rule.tries} {rule.window * 1000:.0f}"
    return f"{number} {process.restart_policy} {times}"


def alive_rule(process: Process) -> str:
    """How `run` asks a process whether it is alive, '' if it does not: times in milliseconds (the last one is the limit
    for the first answer), host (after `tls:` if it is asked over TLS) and port, and the message for `printf`."""
    alive, asked = process.alive, liveness.question(process.alive, is_secured=process.is_secured)
    if alive is None or asked is None:
        return ""
    host, port, question = asked
    host = f"tls:{host}" if process.is_secured else host
    late = max(liveness.START, liveness.READY * process.ready.within)
    times = [alive.every, alive.within, alive.worker, late]
    every, within, worker, late_ms = (f"{1000 * time:.0f}" for time in times)
    then = "restart" if alive.restarts else "tell"
    escaped = "".join(f"\\x{byte:02x}" for byte in bytes.fromhex(question))
    return f"{every} {within} {alive.misses} {then} {worker} {late_ms} {host} {port} {escaped}"


def encoded(text: str) -> str:
    """A text for `printf %b`, without the dollars that IceGrid would replace."""
    return text.replace("\\", "\\\\").replace("$", "\\0044")


# IceGrid writes a proxy with an `ssl` endpoint into every configuration, which needs the plug-in.
_QUIET = {"Ice.Admin.Enabled": "0", "Ice.Plugin.IceSSL": "IceSSL:createIceSSL"}


def _literal(text: str) -> str:
    """A text in which IceGrid replaces no variable."""
    return re.sub(r"(\$+)\{", lambda found: found[1] * 2 + "{", text)


def _facts(name: str, exe: str, options: list[str], **facts: Any) -> dict[str, Any]:
    """The members of a server's descriptor: IceGrid's Python mapping requires all."""
    return {
        "adapters": [], "dbEnvs": [], "description": "", "id": name, "exe": exe, "iceVersion": "", "options": options,
        "activationTimeout": "", "applicationDistrib": False, "distrib": _nothing_to_distribute(),
        "allocatable": False, "propertySet": _property_set(_QUIET), **facts,
    }  # fmt: skip


def _property_set(values: dict[str, str]) -> Any:
    return IceGrid.PropertySetDescriptor(
        [], [IceGrid.PropertyDescriptor(name, _literal(value)) for name, value in values.items()]
    )


def _nothing_to_distribute() -> Any:
    return IceGrid.DistributionDescriptor("", [])
