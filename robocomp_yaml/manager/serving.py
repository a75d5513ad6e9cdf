"""Where the manager listens, and until when it serves."""

from __future__ import annotations

import asyncio
import os
import secrets
import signal
import socket
import stat
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

import msgspec
import uvicorn

from robocomp_yaml.api.refusals import cannot_write
from robocomp_yaml.diag.errors import Refused, reason_of
from robocomp_yaml.garbage import collect_often
from robocomp_yaml.manager.access import TOKEN, AccessRules
from robocomp_yaml.manager.app import application
from robocomp_yaml.manager.watching import Watcher

PORT = 7410
"""The TCP port, unless it is in use."""
LOOPBACK = "127.0.0.1"
_EVERYWHERE = ("0.0.0.0", "::")
_MOST = 300  # connections, of which a page has three
_PATIENCE = 1  # seconds that open connections have at the end


class Listening(msgspec.Struct):
    """Where to listen: at an address (with a certificate and its key, unless it is this machine's own), or on a unix
    socket at a path. `port` 0 is PORT, or a free one if that is in use."""

    address: str = LOOPBACK
    port: int = 0
    path: str = ""
    certificate: str = ""
    key: str = ""


def bound(where: Listening) -> socket.socket:
    """The socket. Raises Refused if the port is in use, or the socket cannot be made."""
    if where.path:
        return _unix(where.path)
    try:
        family = socket.getaddrinfo(where.address, 0, type=socket.SOCK_STREAM)[0][0]
    except socket.gaierror as error:
        raise Refused(f"'{where.address}' is not an address of this machine: {error.strerror}") from None
    for port in [where.port] if where.port else [PORT, 0]:
        made = socket.socket(family, socket.SOCK_STREAM)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            made.bind((where.address, port))
            made.listen(100)
            return made
        except OSError as error:
            made.close()
            reason = reason_of(error)
    raise Refused(f"cannot listen at {where.address}, port {where.port or PORT}: {reason}")


def _unix(path: str) -> socket.socket:
    """A socket that only its owner can use, from its first moment."""
    made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        if _is_left(path):
            os.unlink(path)
        before = os.umask(0o177)
        try:
            made.bind(path)
        finally:
            os.umask(before)
        made.listen(100)
    except OSError as error:
        made.close()
        raise cannot_write(path, error) from None
    return made


def _is_left(path: str) -> bool:
    """Whether a manager that was killed left a socket at this path."""
    try:
        if not stat.S_ISSOCK(os.lstat(path).st_mode):
            return False
    except OSError:
        return False
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        try:
            probe.connect(path)
        except ConnectionRefusedError:
            return True
        except OSError:
            return False
    return False


def rules_for(made: socket.socket, where: Listening, rights: Sequence[str]) -> AccessRules:
    port = made.getsockname()[1] if not where.path else 0
    own = socket.gethostname()
    hosts = () if where.path else (where.address, *((own, f"{own}.local", socket.getfqdn()) if where.key else ()))
    return AccessRules(secrets.token_urlsafe(24), tuple(rights), hosts, port, bool(where.key))


def address(rules: AccessRules, where: Listening) -> str:
    """The address to open, with the token."""
    name = socket.gethostname() if where.address in _EVERYWHERE else where.address
    host = f"[{name}]" if ":" in name else name
    return f"{'https' if rules.is_secure else 'http'}://{host}:{rules.port}/?{TOKEN}={rules.token}"


def serve(
    watchers: Mapping[str, Watcher], made: socket.socket, where: Listening, rules: AccessRules,
    page: Mapping[str, str] | None, on_ready: Callable[[], None],
) -> int:  # fmt: skip
    """Serves until a signal ends it. Returns the exit code: 128 plus the number of the signal."""
    config = uvicorn.Config(
        application(watchers, rules, page), log_level="error", access_log=False, server_header=False, ws="none",
        ssl_certfile=where.certificate or None, ssl_keyfile=where.key or None,
        timeout_graceful_shutdown=_PATIENCE, proxy_headers=False, limit_concurrency=_MOST,
    )  # fmt: skip
    try:
        return asyncio.run(_until_signal(_Server(config), watchers, made, on_ready))
    finally:
        made.close()
        if where.path:
            os.unlink(where.path)


class _Server(uvicorn.Server):
    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """The manager handles signals itself."""
        yield


async def _until_signal(
    server: _Server, watchers: Mapping[str, Watcher], made: socket.socket, on_ready: Callable[[], None]
) -> int:
    ended: list[int] = []

    def stop(number: int) -> None:
        ended.append(number)
        server.should_exit = True
        for watcher in watchers.values():
            watcher.events.end()

    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop, number)
    served = asyncio.create_task(server.serve([made]))
    while not server.started and not served.done():
        await asyncio.sleep(0.01)
    if server.started:
        collect_often()
        on_ready()
    await served
    return 128 + ended[0] if ended else 1
