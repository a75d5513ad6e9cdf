"""Starting the node of another host over SSH (extra `ssh`: asyncssh). The connection ends when the node runs."""

from __future__ import annotations

import asyncio

from robocomp_yaml.network.network import Host

_CONNECT_WITHIN, _RUN_WITHIN = 8.0, 30.0


def run(script: str, host: Host) -> str:
    """Gives the script to bash on the host; why that failed, or ''. The user's own keys, agent and known hosts are
    used; nothing is ever asked."""
    try:
        import asyncssh
    except ImportError:
        return "asyncssh is not installed (`pip install 'rcyaml[ssh]'`), and no node was started by hand"

    with open(script, encoding="utf-8") as file:
        text = file.read()

    async def work() -> str:
        options = {"username": host.user} if host.user else {}
        async with asyncssh.connect(host.address, connect_timeout=_CONNECT_WITHIN, **options) as connection:
            done = await asyncio.wait_for(connection.run("bash -s", input=text, check=False), _RUN_WITHIN)
        return (str(done.stderr).strip() or "the script that starts it failed") if done.exit_status else ""

    try:
        return asyncio.run(work())
    except (OSError, asyncssh.Error, TimeoutError) as error:
        return f"ssh: {str(error).strip() or 'no answer'}"
