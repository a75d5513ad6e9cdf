"""The control socket of a deployment's supervisor.

Only its owner can use it: its folder has mode 0700, and the kernel returns the user of each client. The folder's path
can be longer than the address of a socket (108 bytes), so that the address always uses the folder's descriptor.
"""

from __future__ import annotations

import os
import signal
import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager

SOCKET = "control"

PROTOCOL = 2
"""The version of the protocol. A client of another version reports the difference."""

LONGEST = 1 << 28  # bytes of a request, which contains configurations

RESTORE = signal.SIGUSR1
"""The signal upon which a supervisor makes itself reachable again, because its folder was deleted."""


@contextmanager
def _short_path(folder: str) -> Iterator[str]:
    descriptor = os.open(folder, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        yield f"/proc/self/fd/{descriptor}/{SOCKET}"
    finally:
        os.close(descriptor)


def listen(folder: str) -> socket.socket:
    """A listening socket in the folder, which replaces the socket of a dead supervisor. Raises OSError."""
    server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    with _short_path(folder) as path:
        if os.path.lexists(path):
            os.unlink(path)
        mask = os.umask(0o177)
        try:
            server.bind(path)
        finally:
            os.umask(mask)
    server.listen(64)
    server.setblocking(False)
    return server


def connect(folder: str, within: float) -> socket.socket | None:
    """A connection to the supervisor of this folder, None if none runs. Raises TimeoutError if one runs and accepts no
    connection within so many seconds."""
    client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    client.settimeout(within)
    try:
        with _short_path(folder) as path:
            client.connect(path)
    except TimeoutError:
        client.close()
        raise
    except OSError:
        client.close()
        return None
    client.setblocking(False)
    return client


def is_of_owner(connection: socket.socket) -> bool:
    """Whether the client is of the same user, or root."""
    data = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
    return struct.unpack("3i", data)[1] in (0, os.getuid())
