"""The token with which the components of a deployment are controlled.

It is made when the deployment starts, and is in two places: in the configurations of its processes, and in the user's
list of deployments, from which commands read it. It ends with `down`.
"""

from __future__ import annotations

import os
from contextlib import suppress

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import registered
from robocomp_yaml.network.network import COMPONENT, LOOPBACK, Network, Process
from robocomp_yaml.semantics.connections import CONTROL, OPEN, TOKEN, TOKEN_CONTEXT
from robocomp_yaml.source.properties import entry_line
from robocomp_yaml.transactions import whole_file

_FILE, _BESIDE = "token", "state/token"
_SECURE = ("ssl", "wss")
_NEW = "new"  # what a plan shows, before the token exists


def token_of(folder: str) -> str:
    """The token of the deployment in this folder, '' if it has none, if it is damaged, or if it is not this user's."""
    for path in _paths(folder):
        with suppress(OSError, UnicodeDecodeError), open(path, encoding="ascii") as file:
            return file.read().strip()
    return ""


def forget_token(folder: str) -> None:
    """Removes the token of the deployment in this folder."""
    for path in _paths(folder):
        with suppress(OSError):
            os.unlink(path)
    registered.forget(folder)


def _paths(folder: str) -> tuple[str, str]:
    return f"{registered.private(folder)}/{_FILE}", f"{folder}/{_BESIDE}"


def made_token(folder: str) -> str:
    """The token of the deployment in this folder, made if there is none. Raises OSError."""
    token = token_of(folder)
    if not token:
        token = os.urandom(32).hex()  # as `secrets` does, which also imports OpenSSL
        try:
            whole_file.put(f"{registered.made_private(folder)}/{_FILE}", f"{token}\n".encode("ascii"), 0o600)
        except OSError:  # the user's folder is on a read-only disk
            own_folder.write(folder, _BESIDE, f"{token}\n")
    return token


def protected(network: Network, *, create: bool) -> Network:
    """The network with the token in the configurations of its components. With `create`, a missing token is made.
    Raises OSError."""
    line = entry_line(CONTROL, network.control)
    if network.control != OPEN:
        token = made_token(network.folder) if create else token_of(network.folder) or _NEW
        line = f"{line}\n{entry_line(TOKEN, token)}"
    return replace(network, processes={name: _with(one, line) for name, one in network.processes.items()})


def _with(process: Process, line: str) -> Process:
    config = process.config
    if process.kind != COMPONENT or config is None:
        return process
    text = config.text.removesuffix("\n")
    return replace(process, config=replace(config, text=f"{text}\n{line}\n"))


def context(network: Network, proxy: str) -> dict[str, str]:
    """The context of a call that controls a component of the network. The token is not sent in plain text to another
    host, where the component would reject the call."""
    from robocomp_yaml.deploy.here import is_local
    from robocomp_yaml.source.ice_proxy import proxy_at

    found = proxy_at(proxy)
    token = token_of(network.folder)
    endpoints = found.endpoints if found else ()
    if not token or not all(one.protocol in _SECURE or is_local(one.host or LOOPBACK) for one in endpoints):
        return {}
    return {TOKEN_CONTEXT: token}
