"""Ice's own protocol, as far as one call needs it. The supervisor uses this, too, so that it needs no library.

Numbers are little-endian, and sizes have one byte, or five: https://doc.zeroc.com/ice/3.7/ice-protocol-and-encoding
"""

from __future__ import annotations

import asyncio
import errno
import os
import socket
import struct
from typing import TYPE_CHECKING, NamedTuple

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


class Connection:
    """A connection to an Ice server. Calls follow each other."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    @classmethod
    async def open(cls, host: str, port: int, tls: SSLContext | None = None) -> Connection:
        """Raises ConnectionError, or another OSError, if no Ice server listens there, or not one with a certificate
        that is valid for `tls`."""
        connection = cls(*await _streams("127.0.0.1" if host == "localhost" else host, port, tls))
        try:
            if await connection._read() != (_VALIDATE, b""):
                raise ConnectionError("the other end is not Ice")
        except BaseException:
            connection.close()
            raise
        return connection

    async def answer(self, message: bytes) -> Reply:
        """The answer to the message of a call. Raises ConnectionError if the other end closes the connection, or sends
        something else. After a cancelled call, the connection must be closed."""
        self._writer.write(message)
        kind, reply = _VALIDATE, b""
        while kind == _VALIDATE:  # a heartbeat of the other end
            kind, reply = await self._read()
        if kind != _REPLY or len(reply) < 5 or reply[:4] != struct.pack("<i", 1):
            raise ConnectionError("the other end does not answer the call")
        return Reply(reply[4], content(reply[5:]) if reply[4] == OK else b"")

    def close(self) -> None:
        if not self._writer.is_closing():
            self._writer.write(_message(_CLOSE))  # Ice expects it before a connection is closed
            if self._writer.get_extra_info("sslcontext") is None:
                self._writer.close()
            else:  # to close it in order would wait for the other end, which may hang
                self._writer.transport.abort()

    async def _read(self) -> tuple[int, bytes]:
        """The kind and the body of the next message; (-1, b"") if it is not a message of Ice."""
        try:
            magic, kind, _, length = _HEADER.unpack(await self._reader.readexactly(_HEADER.size))
            if magic[:4] != _MAGIC[:4] or not _HEADER.size <= length <= _LONGEST:
                return -1, b""
            return kind, await self._reader.readexactly(length - _HEADER.size)
        except asyncio.IncompleteReadError as error:
            raise ConnectionError("the other end closed the connection") from error


async def _streams(host: str, port: int, tls: SSLContext | None) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    """A connection, by the shortest way to an address of IPv4: it is tried again and again while a process starts. To
    resolve a name takes a thread, which costs more than a call."""
    try:
        socket.inet_aton(host)
    except OSError:
        return await asyncio.open_connection(host, port, ssl=tls)
    peer = socket.socket(socket.AF_INET, socket.SOCK_STREAM | socket.SOCK_NONBLOCK)
    try:
        error = peer.connect_ex((host, port))  # an address of this machine answers at once
        if error == errno.EINPROGRESS:
            await asyncio.get_running_loop().sock_connect(peer, (host, port))
        elif error:
            raise OSError(error, os.strerror(error))
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return await asyncio.open_connection(sock=peer, ssl=tls, server_hostname=host if tls else None)
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
