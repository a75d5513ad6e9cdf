"""Whether an Ice object answers: `ice_ping` in Ice's own protocol, over one plain connection.

This needs neither the Ice runtime nor its threads, so that many processes can be pinged at once, also where Ice is not
installed. Proxies without an address, or with another protocol than TCP, need the Ice runtime.
"""

from __future__ import annotations

import asyncio
import functools
import struct

from robocomp_yaml.source.ice_proxy import proxy_at

_MAGIC = b"IceP\x01\x00\x01\x00"  # protocol 1.0, encoding 1.0
_REQUEST, _REPLY, _VALIDATE, _CLOSE = 0, 2, 3, 4
_HEADER = struct.Struct("<8sBBi")
_IDEMPOTENT = 2
_NO_ARGUMENTS = struct.pack("<iBB", 6, 1, 1)
_LONGEST = 1 << 16


@functools.cache
def address_of(proxy: str) -> tuple[str, str, int] | None:
    """The identity, host and port of a proxy's first endpoint; None if the endpoint is not plain TCP."""
    found = proxy_at(proxy)
    first = found.endpoints[0] if found and found.endpoints else None
    if not found or not found.is_plain or not first or first.protocol not in ("tcp", "default") or not first.port:
        return None
    if "/" in found.category + found.name:  # an escaped one
        return None
    return f"{found.category}/{found.name}" if found.category else found.name, first.host or "127.0.0.1", first.port


async def answers(proxy: str, within: float) -> bool:
    """Whether the object of a proxy answers a ping within so many seconds. Any failure of the other end returns
    False."""
    address = address_of(proxy)
    try:
        async with asyncio.timeout(within):
            if address is None:
                return await asyncio.to_thread(_answers_by_ice, proxy, within)
            identity, host, port = address
            # To resolve a name takes a thread, which costs more than the ping.
            reader, writer = await asyncio.open_connection("127.0.0.1" if host == "localhost" else host, port)
            try:
                return await _ping(identity, reader, writer)
            finally:
                writer.close()
    except (OSError, asyncio.IncompleteReadError, struct.error):
        return False


async def _ping(identity: str, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bool:
    if await _message(reader) != (_VALIDATE, b""):
        return False
    category, _, name = identity.rpartition("/")
    body = struct.pack("<i", 1) + _text(name) + _text(category)
    body += b"\0" + _text("ice_ping") + bytes([_IDEMPOTENT, 0]) + _NO_ARGUMENTS
    writer.write(_HEADER.pack(_MAGIC, _REQUEST, 0, _HEADER.size + len(body)) + body)
    kind, reply = await _message(reader)
    # Ice expects a message before a connection is closed.
    writer.write(_HEADER.pack(_MAGIC, _CLOSE, 0, _HEADER.size))
    return kind == _REPLY and reply[:5] == struct.pack("<iB", 1, 0)


async def _message(reader: asyncio.StreamReader) -> tuple[int, bytes]:
    """The kind and the body of the next message; (-1, b"") if it is not a message of Ice."""
    magic, kind, _, size = _HEADER.unpack(await reader.readexactly(_HEADER.size))
    if magic[:4] != _MAGIC[:4] or not _HEADER.size <= size <= _LONGEST:
        return -1, b""
    return kind, await reader.readexactly(size - _HEADER.size)


def _text(text: str) -> bytes:
    data = text.encode(errors="surrogateescape")
    return (struct.pack("<Bi", 255, len(data)) if len(data) > 254 else bytes([len(data)])) + data


def _answers_by_ice(proxy: str, within: float) -> bool:
    """Whether the object answers a ping of the Ice runtime; False if that is not installed."""
    try:
        import Ice
    except ImportError:
        return False
    try:
        with Ice.initialize([f"--Ice.Default.InvocationTimeout={int(within * 1000)}"]) as communicator:
            communicator.stringToProxy(proxy).ice_ping()
    except Ice.Exception:
        return False
    return True
