"""A client without generated code: connects, and calls with a limit of time."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import Any

import Ice
import msgspec

from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.properties import config_option
from robocomp_yaml.wire.interfaces import Operation

_PROPERTIES = {
    "Ice.Default.CollocationOptimized": "0",
    "Ice.MessageSizeMax": "0",
    "Ice.Override.CloseTimeout": "300",  # a server that hangs does not answer the end of the connection, either
    "Ice.RetryIntervals": "-1",
    "Ice.ThreadPool.Server.Size": "1",  # what arrives is handled in its order
    "Ice.Warn.Dispatch": "0",
    "Ice.Warn.Endpoints": "0",
    "Ice.Warn.UnknownProperties": "0",
}


_SECURE = pattern(r":\s*(?:ssl|wss)\b")


class NotConnected(Exception):
    """No connection was made. `error` is Ice's exception, None if the time was over."""

    def __init__(self, error: Exception | None) -> None:
        super().__init__(str(error))
        self.error = error


class OutOfTime(Exception):
    """There is a connection, and the call did not return in time."""


class IceClient(msgspec.Struct):
    """A communicator, for calls and for objects of its own."""

    communicator: Any

    def proxy(self, text: str) -> Any:
        """Raises Refused if the text is not a proxy, or if a plug-in is missing for its endpoints."""
        return proxy_of(self.communicator, text)

    def connect(self, proxy: Any, limit: float) -> Any:
        """Connects within so many seconds, and returns the connection. Raises NotConnected."""
        try:
            return proxy.ice_getConnectionAsync().result(limit)
        except Ice.TimeoutException:  # Ice has one of its own for futures
            raise NotConnected(None) from None
        except Ice.Exception as error:
            raise NotConnected(error) from None

    def call(
        self, proxy: Any, operation: Operation, arguments: tuple[Any, ...], limit: float,
        context: Mapping[str, str] | None = None,
    ) -> Any:  # fmt: skip
        """What the operation returns within so many seconds; `context` is Ice's, which goes with the call. Raises
        NotConnected, OutOfTime, and exceptions of Ice."""
        end = time.monotonic() + limit
        self.connect(proxy, limit)
        return self.result(operation.ice.invokeAsync(proxy, (arguments, dict(context) if context else None)), end)

    def result(self, future: Any, end: float) -> Any:
        """What a future returns until `end`, by the monotonic clock. Unlike Ice's own calls, waiting for it can be
        interrupted by Ctrl-C."""
        try:
            return future.result(max(0.001, end - time.monotonic()))
        except (Ice.TimeoutException, Ice.InvocationTimeoutException):
            raise OutOfTime from None

    def ids_at(self, proxy: Any, limit: float) -> list[str]:
        """The type ids of the object; none if it does not tell them."""
        with suppress(Ice.Exception, OutOfTime):
            return list(self.result(proxy.ice_idsAsync(), time.monotonic() + limit))
        return []

    def answers(self, proxy: Any, limit: float) -> bool:
        """Whether the object of a proxy answers a ping."""
        try:
            self.result(proxy.ice_pingAsync(), time.monotonic() + limit)
        except (Ice.Exception, OutOfTime):
            return False
        return True


def proxy_of(communicator: Any, text: str) -> Any:
    """The proxy in a text. Raises Refused if it is none, or if a plug-in is missing for its endpoints."""
    try:
        found = communicator.stringToProxy(text)
    except Ice.Exception as error:
        if _SECURE.search(text) and not communicator.getProperties().getProperty("Ice.Plugin.IceSSL"):
            properties = "Ice.Plugin.IceSSL=IceSSL:createIceSSL and the certificates"
            raise Refused(
                f"'{text}' needs a plug-in of Ice: name a file with {properties}: --ice-config FILE"
            ) from None
        raise Refused(f"'{text}' is not a proxy of Ice: {reason_of(error)}") from None
    if found is None:
        raise Refused("the text of a proxy is empty")
    return found


@contextmanager
def client(
    config: str = "", limit: float = 10.0, properties: Mapping[str, str] | None = None
) -> Iterator[IceClient]:  # fmt: skip
    """A client while the context lasts. `config` is a file of Ice properties, such as those of TLS; `limit` are the
    seconds that connecting may take; `properties` are further ones, which the file overrides. Raises Refused if
    Ice cannot be initialized with it."""
    data = Ice.InitializationData()
    try:
        data.properties = Ice.createProperties([config_option(config)] if config else [])
        for name, value in {**_PROPERTIES, **(properties or {})}.items():
            if not data.properties.getProperty(name):
                data.properties.setProperty(name, value)
        data.properties.setProperty("Ice.Override.ConnectTimeout", str(max(1, round(limit * 1000))))
        communicator = Ice.initialize(data)
    except (Ice.Exception, RuntimeError) as error:
        where = f" with {config}" if config else ""
        raise Refused(f"Ice cannot be initialized{where}: {reason_of(error)}") from None
    try:
        yield IceClient(communicator)
    finally:
        communicator.destroy()


def reason_of(error: Exception) -> str:
    """An exception of Ice in one line."""
    reason = getattr(error, "reason", "") or getattr(error, "str", "") or getattr(error, "unknown", "")
    if isinstance(error, Ice.ConnectionRefusedException):
        return "nothing listens there"
    if isinstance(error, Ice.TimeoutException):
        return "it does not answer in time"
    if isinstance(error, Ice.ObjectNotExistException):
        return f"there is no object '{Ice.identityToString(error.id)}'"
    if isinstance(error, Ice.DNSException):
        return f"unknown host '{error.host}'"
    if isinstance(error, Ice.SyscallException) and error.error:
        import os

        return os.strerror(error.error).lower()
    return " ".join(str(reason).split()) or type(error).__name__
