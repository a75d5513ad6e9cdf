"""Starting the node of another host over SSH (extra `ssh`: asyncssh). The connection ends when the node runs."""

from __future__ import annotations

import asyncio
import os

from robocomp_yaml.deploy.icegrid.daemons import Start, outcome
from robocomp_yaml.network.network import Host

_CONNECT_WITHIN, _RUN_WITHIN = 8.0, 30.0


def run(script: str, host: Host) -> Start:
    """Gives the script to bash on the host. The user's own keys, agent and known hosts are used; nothing is ever
    asked."""
    try:
        import asyncssh
    except ImportError:
        return Start("asyncssh is not installed (`pip install 'rcyaml[ssh]'`), and no node was started by hand")

    with open(script, encoding="utf-8") as file:
        text = file.read()

    async def work() -> Start:
        options = {"username": host.user} if host.user else {}
        async with asyncssh.connect(host.address, connect_timeout=_CONNECT_WITHIN, **options) as connection:
            done = await asyncio.wait_for(connection.run("bash -s", input=text, check=False), _RUN_WITHIN)
        return outcome(done.exit_status, str(done.stdout), str(done.stderr))

    try:
        return asyncio.run(work())
    except TimeoutError:
        return Start("ssh: no answer")
    except OSError as error:
        is_system = error.errno is not None and error.errno > 0  # whose own text is about a call
        return Start(f"ssh: {os.strerror(error.errno or 0) if is_system else error.strerror or error}".lower())
    except asyncssh.HostKeyNotVerifiable:
        return Start("ssh: its key is not the one in your known_hosts, or there is none: connect once with `ssh`")
    except asyncssh.Error as error:
        return Start(f"ssh: {str(error).strip() or 'the connection was closed'}")
