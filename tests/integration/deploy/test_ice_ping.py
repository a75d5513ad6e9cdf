"""Pings of servers that are not Ice, or wrong Ice: no exception, and never longer than the limit. Real Ice is in
tests/deploy."""

from __future__ import annotations

import asyncio
import socket
import threading
from contextlib import suppress

import pytest

from robocomp_yaml.deploy import ice_call, ice_ping
from robocomp_yaml.wire.protocol import Connection, request

VALIDATE = b"IceP\x01\x00\x01\x00\x03\x00\x0e\x00\x00\x00"
OK = b"IceP\x01\x00\x01\x00\x02\x00\x19\x00\x00\x00" + b"\x01\x00\x00\x00" + b"\x00" + b"\x06\x00\x00\x00\x01\x01"
CLOSE = b"IceP\x01\x00\x01\x00\x04\x00\x0e\x00\x00\x00"
ABSENT = OK[:18] + b"\x02" + OK[19:]


@pytest.mark.parametrize(
    ("said", "is_there"),
    [
        (VALIDATE + OK, True),
        (VALIDATE + ABSENT, False),
        (VALIDATE, False),
        (VALIDATE + VALIDATE, False),
        (b"", False),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", False),
        (b"SSH-2.0-OpenSSH_9.2\r\n", False),
        (VALIDATE[:10] + b"\xff\xff\xff\x7f" + b"x" * 100, False),
        (VALIDATE[:10] + b"\x00\x00\x00\x80", False),
    ],
)
def test_what_answers(said: bytes, is_there: bool) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]

        def serve() -> None:
            connection = server.accept()[0]
            with connection, suppress(ConnectionError):
                connection.sendall(said[: len(VALIDATE)])
                connection.recv(1000)
                connection.sendall(said[len(VALIDATE) :])
                while connection.recv(1000):
                    pass

        thread = threading.Thread(target=serve)
        thread.start()
        answer = asyncio.run(ice_ping.answers(f"laser:tcp -h 127.0.0.1 -p {port}", 0.5))
        thread.join()
    assert answer is is_there


def test_a_connection_that_the_server_closes() -> None:
    """A server that ends waits until the other end has closed, too: a connection without a call does so at once."""
    has_ended = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            with server.accept()[0] as connection:
                connection.sendall(VALIDATE)
                connection.recv(1000)
                connection.sendall(OK + VALIDATE + CLOSE)
                if not connection.recv(1000):
                    has_ended.set()

        async def call() -> None:
            connection = await Connection.open("127.0.0.1", server.getsockname()[1])
            message = request("laser", "ice_ping")
            assert (await connection.answer(message)).status == 0
            assert await asyncio.to_thread(has_ended.wait, 20)
            with pytest.raises(ConnectionError):
                await connection.answer(message)
            connection.close()

        thread = threading.Thread(target=serve)
        thread.start()
        asyncio.run(call())
        thread.join()


@pytest.mark.parametrize(
    ("proxy", "address"),
    [
        ("laser:tcp -h 10.0.0.2 -p 10003", ("laser", "10.0.0.2", 10003)),
        ("laser:tcp -p 10003 -h host -t 100 -z", ("laser", "host", 10003)),
        ("laser -t -e 1.1:default -p 10003", ("laser", "127.0.0.1", 10003)),
        ('"a laser":tcp -h "::1" -p 1', ("a laser", "::1", 1)),
        ("storm/Manager:tcp -h a -p 1:tcp -h b -p 2", ("storm/Manager", "a", 1)),
        ("laser", None),
        ("laser @ adapter", None),
        ("laser -f facet:tcp -p 1", None),
        ("laser:ssl -h a -p 1", None),
        ("laser:udp -h a -p 1:tcp -h a -p 1", None),
        ("laser:tcp -h a", None),
        ("", None),
    ],
)
def test_the_address_of_a_proxy(proxy: str, address: tuple[str, str, int] | None) -> None:
    assert ice_call.address_of(proxy) == address
