"""Calls of Ice objects, in Ice's own protocol, over one plain connection each.

This needs neither the Ice runtime nor its threads, so that many processes can be called at once, also where Ice is not
installed. Proxies without an address, or with another protocol than TCP, need the Ice runtime.
"""

from __future__ import annotations

import asyncio
import functools
import struct

import msgspec

from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.wire.introspection import text

_MAGIC = b"IceP\x01\x00\x01\x00"  # protocol 1.0, encoding 1.0
_REQUEST, _REPLY, _VALIDATE, _CLOSE = 0, 2, 3, 4
_HEADER = struct.Struct("<8sBBi")
_ENCAPSULATION = struct.Struct("<iBB")
_IDEMPOTENT = 2
_LONGEST = 1 << 20

OK, NO_OBJECT, NO_FACET, NO_OPERATION = 0, 2, 3, 4


class Reply(msgspec.Struct, frozen=True):
    """The answer to a call. `status` is OK, or another number of Ice's protocol; `result` are the bytes of the results
    if it is OK."""

    status: int
    result: bytes = b""


class IceCall(msgspec.Struct, frozen=True):
    """A call of an idempotent operation. `arguments` are the bytes of its parameters."""

    operation: str
    facet: str = ""
    arguments: bytes = b""


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


async def answer(proxy: str, call: IceCall, within: float) -> Reply | None:
    """The answer of a proxy's object within so many seconds; None if there is none, whatever is at the other end."""
    address = address_of(proxy)
    try:
        async with asyncio.timeout(within):
            if address is None:
                return await asyncio.to_thread(_answer_by_ice, proxy, call, within)
            identity, host, port = address
            # To resolve a name takes a thread, which costs more than the call.
            reader, writer = await asyncio.open_connection("127.0.0.1" if host == "localhost" else host, port)
            try:
                return await _exchange(identity, call, reader, writer)
            finally:
                writer.close()
    except (OSError, asyncio.IncompleteReadError, struct.error):
        return None


def request(identity: str, call: IceCall) -> bytes:
    """The message of a call, with the number 1."""
    category, _, name = identity.rpartition("/")
    body = struct.pack("<i", 1) + text(name) + text(category)
    body += (b"\1" + text(call.facet) if call.facet else b"\0") + text(call.operation) + bytes([_IDEMPOTENT, 0])
    body += _ENCAPSULATION.pack(_ENCAPSULATION.size + len(call.arguments), 1, 1) + call.arguments
    return _HEADER.pack(_MAGIC, _REQUEST, 0, _HEADER.size + len(body)) + body


async def _exchange(
    identity: str, call: IceCall, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
) -> Reply | None:
    if await _message(reader) != (_VALIDATE, b""):
        return None
    writer.write(request(identity, call))
    kind, reply = await _message(reader)
    # Ice expects a message before a connection is closed.
    writer.write(_HEADER.pack(_MAGIC, _CLOSE, 0, _HEADER.size))
    if kind != _REPLY or reply[:4] != struct.pack("<i", 1):
        return None
    status = reply[4]
    return Reply(status, reply[5 + _ENCAPSULATION.size :] if status == OK else b"")


async def _message(reader: asyncio.StreamReader) -> tuple[int, bytes]:
    """The kind and the body of the next message; (-1, b"") if it is not a message of Ice."""
    magic, kind, _, size = _HEADER.unpack(await reader.readexactly(_HEADER.size))
    if magic[:4] != _MAGIC[:4] or not _HEADER.size <= size <= _LONGEST:
        return -1, b""
    return kind, await reader.readexactly(size - _HEADER.size)


def _answer_by_ice(proxy: str, call: IceCall, within: float) -> Reply | None:
    """The answer to a call of the Ice runtime; None if that is not installed."""
    try:
        import Ice
    except ImportError:
        return None
    arguments = _ENCAPSULATION.pack(_ENCAPSULATION.size + len(call.arguments), 1, 1) + call.arguments
    try:
        with Ice.initialize([f"--Ice.Default.InvocationTimeout={int(within * 1000)}"]) as communicator:
            called = communicator.stringToProxy(proxy).ice_facet(call.facet)
            is_ok, result = called.ice_invoke(call.operation, Ice.OperationMode.Idempotent, arguments)
    except Ice.ObjectNotExistException:
        return Reply(NO_OBJECT)
    except Ice.FacetNotExistException:
        return Reply(NO_FACET)
    except Ice.OperationNotExistException:
        return Reply(NO_OPERATION)
    except Ice.Exception:
        return None
    return Reply(OK if is_ok else 1, bytes(result)[_ENCAPSULATION.size :])
