"""An application for IceGrid: `icegridadmin -e 'application add NAME.xml'`.

The nodes are the hosts, by name. Configurations are part of the descriptor, so that no file has to be copied. IceGrid
has no order of starting and no readiness: all servers start at the same time.
"""

from __future__ import annotations

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._commands import file_name, limited, with_files, without_config
from robocomp_yaml.emit.xml_text import HEAD, element
from robocomp_yaml.model.deployment import CONFIG
from robocomp_yaml.network.network import ICESTORM, NEVER, PROGRAM, Network, Process
from robocomp_yaml.source import properties

_DROP_LAST = 'n=$#; for word do shift; n=$((n-1)); [ "$n" -gt 0 ] && set -- "$@" "${word#=}"; done; exec "$@"'
_TAKE_ALL = 'for word do shift; set -- "$@" "${word#=}"; done; exec "$@"'
"""A node appends `--Ice.Config=…` to every command, which only Ice programs understand: the first script drops it. A
node also omits empty words, so that words are passed to the shell behind `=`."""

_MAKE_FILE = 'f=$(umask 077; mktemp) && printf %s "${1#=}" >"$f" && exec 9<"$f" && rm -f -- "$f" || exit 1; shift'
_FILE_AND_DROP_LAST = (
    'n=$#; for word do shift; n=$((n-1)); word=${word#=}; case $word in *"{config}"*) '
    'word=${word%%"{config}"*}/dev/fd/9${word#*"{config}"};; esac; '
    '[ "$n" -gt 0 ] && set -- "$@" "$word"; done; exec "$@"'
)
"""For a program with its own configuration: a file without a name, which no other process can read."""

_OPTION = f"--Ice.Config={CONFIG}"

_MAKE_FOLDERS = 'while [ "$1" != -- ]; do mkdir -p "$1" || exit 1; shift; done; shift; exec "$@"'


def export(network: Network) -> dict[str, str]:
    nodes: list[str] = []
    for host in network.hosts:
        servers: list[str] = []
        for process in network.processes.values():
            if process.host == host:
                with _unwritable.of(process):
                    servers += _server(process)
        if servers:
            nodes += element("node", {"name": host}, servers)
    application = element("application", {"name": network.name}, nodes)
    return {f"{file_name(network.name)}.xml": HEAD + "\n".join(element("icegrid", {}, application)) + "\n"}


def _server(process: Process) -> list[str]:
    needs_file = process.config is not None and process.kind == PROGRAM and _OPTION not in process.command
    is_ice = process.is_ice and not needs_file
    program, *arguments = process.command if needs_file else without_config(process)
    bare = [f"{one.name}={one.value}" for one in process.env if "$" in one.value]
    if bare:  # a node replaces variables in values, and cannot escape `$`
        program, arguments = "/usr/bin/env", [*bare, program, *arguments]
    if not is_ice or "" in arguments:
        words = [f"={word}" if word[:1] in ("", "=") else word for word in (program, *arguments)]
        script = _TAKE_ALL if is_ice else _DROP_LAST
        if needs_file and process.config is not None:
            script, words = f"{_MAKE_FILE}; {_FILE_AND_DROP_LAST}", [f"={process.config.text}", *words]
        program, arguments = "/bin/sh", ["-c", script, process.name, *words]
    program, *arguments = with_files(process, limited(process, (program, *arguments), "IceGrid"))
    if process.folders:
        program, arguments = "/bin/sh", ["-c", _MAKE_FOLDERS, process.name, *process.folders, "--", program, *arguments]
    attributes = {"id": process.name, "exe": _literal(program), "activation": _activation(process)}
    if process.cwd and process.kind != ICESTORM:
        attributes["pwd"] = _literal(process.cwd)
    inside = [line for word in arguments for line in element("option", {}, text=_literal(word))]
    for variable in process.env:
        if "$" not in variable.value and not variable.file:
            value = f"${variable.source}" if variable.source else variable.value
            inside += element("env", {}, text=f"{variable.name}={value}")
    values = properties.read(process.config.text).values if process.config and is_ice else {}
    if not is_ice:
        values["Ice.Admin.Enabled"] = "0"  # else the node waits for its administrative object for ever
    settings = [
        line
        for key, value in values.items()
        for line in element("property", {"name": _literal(key), "value": _literal(value)})
    ]
    return element("server", attributes, [*inside, *(element("properties", {}, settings) if settings else [])])


def _activation(process: Process) -> str:
    return "always" if process.enabled and process.restart.policy != NEVER else "manual"


def _literal(text: str) -> str:
    """A text in which IceGrid detects no variable."""
    return text.replace("${", "$${")
