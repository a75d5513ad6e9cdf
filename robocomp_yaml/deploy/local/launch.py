"""Reaching a deployment's supervisor, and starting one where there is none."""

from __future__ import annotations

import asyncio
import os
import socket
import subprocess
import sys

from robocomp_yaml.deploy.local import channel, procfs, record

_LINES = 10
_PATIENCE = 20.0  # seconds: far more than it needs, also where the machine is busy


def reach(folder: str) -> socket.socket | None:
    """A connection to the supervisor; None where there is none. Raises OSError where the folder is none."""
    return channel.connect(f"{folder}/state") if os.path.isdir(f"{folder}/state") else None


def last_words(folder: str) -> list[str]:
    """What the supervisor said of itself, which is nothing as long as all is well."""
    try:
        with open(f"{folder}/state/supervisor.log", encoding="utf-8", errors="replace") as file:
            return file.read().splitlines()[-_LINES:]
    except OSError:
        return []


async def start(folder: str) -> socket.socket:
    """A connection to a new supervisor. Raises OSError where it does not come to life, with what it said."""
    package = os.path.abspath(f"{__file__}/../../../..")
    environment = {**os.environ, procfs.MARK: f"{folder}:"}
    environment["PYTHONPATH"] = os.pathsep.join([package, *filter(None, [environment.get("PYTHONPATH")])])
    said = os.open(f"{folder}/state/supervisor.log", os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
    try:
        # It stays when this process ends, and nobody waits for it then.
        keeper = subprocess.Popen(
            [sys.executable, "-m", "robocomp_yaml.deploy.local.supervisor", folder],
            cwd="/", env=environment, stdin=subprocess.DEVNULL, stdout=said, stderr=said, start_new_session=True,
        )  # fmt: skip
        for _ in range(int(_PATIENCE / 0.02)):
            if connection := reach(folder):
                keeper.returncode = 0
                return connection
            if keeper.poll() is not None:
                break
            await asyncio.sleep(0.02)
        keeper.kill()
        keeper.wait()
        raise OSError(0, f"the supervisor does not start: {' '.join(last_words(folder))}")
    finally:
        os.close(said)


async def wait_gone(folder: str) -> None:
    """Until the supervisor has taken leave."""
    for _ in range(int(_PATIENCE / 0.02)):
        if not record.is_there(folder):
            return
        await asyncio.sleep(0.02)
