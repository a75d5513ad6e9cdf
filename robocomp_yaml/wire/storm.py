"""IceStorm: its topic manager, publishers, and subscriptions that end."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import Ice
import IceStorm

from robocomp_yaml.diag.errors import NoAnswer
from robocomp_yaml.wire.client import proxy_of, reason_of

STORM = "IceStorm/TopicManager:default -p 9999"
PATIENCE = 2000  # milliseconds for IceStorm to answer


def topic_manager(communicator: Any, text: str, patience: int = PATIENCE) -> Any:
    """The topic manager of a proxy. Raises NoAnswer, and Refused if the text is not a proxy."""
    proxy = proxy_of(communicator, text).ice_invocationTimeout(patience)
    try:
        manager = IceStorm.TopicManagerPrx.checkedCast(proxy)
        reason = "" if manager is not None else "what answers there is not its topic manager"
    except Ice.Exception as error:
        reason = "it does not answer in time" if isinstance(error, Ice.TimeoutException) else reason_of(error)
    if reason:
        raise NoAnswer(f"IceStorm, which carries topics, does not answer at '{text}': {reason}")
    return manager


def topic(manager: Any, name: str) -> Any:
    """The topic, created if needed: another program may create it at the same time."""
    while True:
        with suppress(IceStorm.NoSuchTopic):
            return manager.retrieve(name)
        with suppress(IceStorm.TopicExists):
            return manager.create(name)


def topics(manager: Any) -> dict[str, int]:
    """The number of subscribers of each topic."""
    return {name: len(found.getSubscribers()) for name, found in sorted(manager.retrieveAll().items())}


def listening_adapter(communicator: Any, manager: Any) -> Any:
    """An adapter at the address from which this machine reaches an IceStorm, with the same protocol."""
    connection = manager.ice_getConnection()
    info = connection.getInfo()
    protocol = connection.type()
    while getattr(info, "underlying", None) is not None:
        info = info.underlying
    address = getattr(info, "localAddress", "") or "127.0.0.1"
    address = address.removeprefix("::ffff:")
    host = f'"{address}"' if ":" in address else address
    return communicator.createObjectAdapterWithEndpoints("", f"{protocol} -h {host}")


@contextmanager
def subscribed(manager: Any, name: str, subscriber: Any) -> Iterator[None]:
    """Subscribes an object to a topic while the context lasts. Raises NoAnswer."""
    oneway = subscriber.ice_oneway()
    try:
        found = topic(manager, name)
        found.subscribeAndGetPublisher({}, oneway)
    except Ice.Exception as error:
        raise NoAnswer(f"IceStorm does not provide the topic '{name}': {reason_of(error)}") from None
    try:
        yield
    finally:
        with suppress(Ice.Exception):  # IceStorm removes subscribers that do not answer
            found.ice_invocationTimeout(PATIENCE).unsubscribe(oneway)
