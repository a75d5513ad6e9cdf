"""Ice's own protocol, as far as one call needs it. The supervisor uses this, too, so that it needs no library.

Numbers are little-endian, and sizes have one byte, or five: https://doc.zeroc.com/ice/3.7/ice-protocol-and-encoding
"""

from __future__ import annotations

import asyncio
import errno
import os
import socket
import struct
from typing import TYPE_CHECKING, NamedTuple, cast

if TYPE_CHECKING:
    from ssl import SSLContext

_MAGIC = b"IceP\x01\x00\x01\x00"  # protocol 1.0, encoding 1.0
_REQUEST, _REPLY, _VALIDATE, _CLOSE = 0, 2, 3, 4
_HEADER = struct.Struct("<8sBBi")
_ENCAPSULATION = struct.Struct("<iBB")
_IDEMPOTENT = 2
_LONGEST = 1 << 20

OK, NO_OBJECT, NO_FACET, NO_OPERATION = 0, 2, 3, 4


class Reply(NamedTuple):
    """The answer to a call. `status` is OK, or another number of Ice's protocol; `result` are the bytes of the results
    if it is OK."""

    status: int
    result: bytes = b""


def size(number: int) -> bytes:
    return struct.pack("<Bi", 255, number) if number > 254 else bytes([number])


def text(content: str) -> bytes:
    """A string of Ice."""
    data = content.encode(errors="surrogateescape")
    return size(len(data)) + data


def encapsulated(arguments: bytes) -> bytes:
    return _ENCAPSULATION.pack(_ENCAPSULATION.size + len(arguments), 1, 1) + arguments


def content(encapsulation: bytes) -> bytes:
    return encapsulation[_ENCAPSULATION.size :]


def request(identity: str, operation: str, facet: str = "", arguments: bytes = b"") -> bytes:
    """The message of an idempotent call, with the number 1. `arguments` are the bytes of its parameters."""
    category, _, name = identity.rpartition("/")
    body = struct.pack("<i", 1) + text(name) + text(category)
    body += (b"\1" + text(facet) if facet else b"\0") + text(operation) + bytes([_IDEMPOTENT, 0])
    return _message(_REQUEST, body + encapsulated(arguments))


def _message(kind: int, body: bytes = b"") -> bytes:
    return _HEADER.pack(_MAGIC, kind, 0, _HEADER.size + len(body)) + body


class Connection(asyncio.Protocol):
    """A connection to an Ice server. Calls follow each other. When the server closes it, it is closed at once: a server
    that ends waits for that."""

    def __init__(self) -> None:
        self._transport: asyncio.Transport | None = None
        self._buffer = bytearray()
        self._is_valid = False
        self._expected: asyncio.Future[bytes] | None = None

    @classmethod
    async def open(cls, host: str, port: int, tls: SSLContext | None = None) -> Connection:
        """Raises ConnectionError, or another OSError, if no Ice server listens there, or not one with a certificate
        that is valid for `tls`."""
        connection = cls()
        valid = connection._expect()
        try:
            await _connect(connection, "127.0.0.1" if host == "localhost" else host, port, tls)
            await valid
        except BaseException:
            connection.close()
            raise
        return connection

    async def answer(self, message: bytes) -> Reply:
        """The answer to the message of a call. Raises ConnectionError if the other end closes the connection, or sends
        something else. After a cancelled call, the connection must be closed."""
        if self._transport is None:
            raise ConnectionError("the other end closed the connection")
        reply = self._expect()
        self._transport.write(message)
        found = await reply
        if len(found) < 5 or found[:4] != struct.pack("<i", 1):
            raise ConnectionError("the other end does not answer the call")
        return Reply(found[4], content(found[5:]) if found[4] == OK else b"")

    def close(self) -> None:
        if self._transport is not None and self._is_valid:
            self._transport.write(_message(_CLOSE))  # Ice expects it before a connection is closed
        self._end("it is closed")

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast("asyncio.Transport", transport)

    def data_received(self, data: bytes) -> None:
        self._buffer += data
        while len(self._buffer) >= _HEADER.size:
            magic, kind, _, length = _HEADER.unpack_from(self._buffer)
            if magic[:4] != _MAGIC[:4] or not _HEADER.size <= length <= _LONGEST:
                self._end("the other end is not Ice")
                return
            if len(self._buffer) < length:
                return
            body = bytes(self._buffer[_HEADER.size : length])
            del self._buffer[:length]
            self._received(kind, body)

    def connection_lost(self, error: Exception | None) -> None:
        self._end("the other end closed the connection")

    def _expect(self) -> asyncio.Future[bytes]:
        self._expected = asyncio.get_running_loop().create_future()
        return self._expected

    def _received(self, kind: int, body: bytes) -> None:
        if kind == _VALIDATE and not self._is_valid:
            self._is_valid = True
            self._has(body)
        elif kind == _REPLY and self._is_valid:
            self._has(body)
        elif kind != _VALIDATE:  # which is a heartbeat
            self._end("the other end closed the connection" if kind == _CLOSE else "the other end is not Ice")

    def _has(self, body: bytes) -> None:
        if self._expected and not self._expected.done():
            self._expected.set_result(body)

    def _end(self, why: str) -> None:
        transport, self._transport = self._transport, None
        self._buffer.clear()
        if self._expected and not self._expected.done():
            self._expected.set_exception(ConnectionError(why))
            self._expected.exception()  # nobody may wait for it
        if transport is not None:
            if transport.get_extra_info("sslcontext") is None:
                transport.close()
            else:  # to close it in order would wait for the other end, which may hang
                transport.abort()


async def _connect(connection: Connection, host: str, port: int, tls: SSLContext | None) -> None:
    """Connects by the shortest way to an address of IPv4: it is tried again and again while a process starts. To
    resolve a name takes a thread, which costs more than a call."""
    loop = asyncio.get_running_loop()
    try:
        socket.inet_aton(host)
    except OSError:
        await loop.create_connection(lambda: connection, host, port, ssl=tls)
        return
    peer = socket.socket(socket.AF_INET, socket.SOCK_STREAM | socket.SOCK_NONBLOCK)
    try:
        error = peer.connect_ex((host, port))  # an address of this machine answers at once
        if error == errno.EINPROGRESS:
            await loop.sock_connect(peer, (host, port))
        elif error:
            raise OSError(error, os.strerror(error))
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        await loop.create_connection(lambda: connection, sock=peer, ssl=tls, server_hostname=host if tls else None)
    except BaseException:
        peer.close()
        raise


async def ask(host: str, port: int, message: bytes, within: float, tls: SSLContext | None = None) -> Reply | None:
    """The answer to the message of a call within so many seconds; None if there is none, whatever is at the other
    end."""
    try:
        async with asyncio.timeout(within):
            connection = await Connection.open(host, port, tls)
            try:
                return await connection.answer(message)
            finally:
                connection.close()
    except OSError:
        return None
