"""Calls of Ice objects, over one connection each.

Most need neither the Ice runtime nor its threads, so that many processes can be called at once, also where Ice is not
installed. Proxies without an address, or with another protocol than TCP, need the Ice runtime.
"""

from __future__ import annotations

import asyncio
import functools

import msgspec

from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.wire import protocol, tls
from robocomp_yaml.wire.protocol import NO_FACET, NO_OBJECT, NO_OPERATION, OK, Reply

PLAIN, SECURE = ("tcp", "default"), ("ssl",)


class IceCall(msgspec.Struct, frozen=True):
    """A call of an idempotent operation. `arguments` are the bytes of its parameters."""

    operation: str
    facet: str = ""
    arguments: bytes = b""


@functools.cache
def address_of(proxy: str, protocols: tuple[str, ...] = PLAIN) -> tuple[str, str, int] | None:
    """The identity, host and port of a proxy's first endpoint; None if the endpoint has another protocol than these."""
    found = proxy_at(proxy)
    first = found.endpoints[0] if found and found.endpoints else None
    if not found or not found.is_plain or not first or first.protocol not in protocols or not first.port:
        return None
    if "/" in found.category + found.name:  # an escaped one
        return None
    return f"{found.category}/{found.name}" if found.category else found.name, first.host or "127.0.0.1", first.port


async def answer(proxy: str, call: IceCall, within: float, pem: str = "") -> Reply | None:
    """The answer of a proxy's object within so many seconds; None if there is none, whatever is at the other end. `pem`
    are a key and the certificates for an object over TLS."""
    address = address_of(proxy, SECURE if pem else PLAIN)
    if address is not None:
        identity, host, port = address
        message = protocol.request(identity, *msgspec.structs.astuple(call))
        try:
            context = tls.of_text(pem) if pem else None
        except (OSError, ValueError):  # not yet made
            return None
        return await protocol.ask(host, port, message, within, context)
    try:
        async with asyncio.timeout(within):
            return await asyncio.to_thread(_answer_by_ice, proxy, call, within)
    except TimeoutError:
        return None


def _answer_by_ice(proxy: str, call: IceCall, within: float) -> Reply | None:
    """The answer to a call of the Ice runtime; None if that is not installed."""
    try:
        import Ice
    except ImportError:
        return None
    try:
        with Ice.initialize([f"--Ice.Default.InvocationTimeout={int(within * 1000)}"]) as communicator:
            called = communicator.stringToProxy(proxy).ice_facet(call.facet)
            is_ok, result = called.ice_invoke(
                call.operation, Ice.OperationMode.Idempotent, protocol.encapsulated(call.arguments)
            )
    except Ice.ObjectNotExistException:
        return Reply(NO_OBJECT)
    except Ice.FacetNotExistException:
        return Reply(NO_FACET)
    except Ice.OperationNotExistException:
        return Reply(NO_OPERATION)
    except Ice.Exception:
        return None
    return Reply(OK if is_ok else 1, protocol.content(bytes(result)))
