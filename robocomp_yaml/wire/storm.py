"""IceStorm: its topic manager, publishers, and subscriptions that are renewed."""

from __future__ import annotations

from contextlib import suppress
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
    except Ice.Exception as error:
        raise no_answer(text, error) from None
    if manager is None:
        raise no_answer(text, "what answers there is not its topic manager")
    return manager


def no_answer(text: str, error: Ice.Exception | str) -> NoAnswer:
    """Why the IceStorm at a proxy does not answer."""
    reason = error if isinstance(error, str) else reason_of(error)
    return NoAnswer(f"IceStorm, which carries topics, does not answer at '{text}': {reason}")


def topic(manager: Any, name: str) -> Any:
    """The topic, created if needed: another program may create it at the same time."""
    while True:
        with suppress(IceStorm.NoSuchTopic):
            return _as_patient(manager.retrieve(name), manager)
        with suppress(IceStorm.TopicExists):
            return _as_patient(manager.create(name), manager)


def _as_patient(found: Any, manager: Any) -> Any:
    """A proxy with the time limit of its topic manager: one that a call returns has none."""
    return found.ice_invocationTimeout(manager.ice_getInvocationTimeout())


def topics(manager: Any) -> dict[str, int]:
    """The number of subscribers of each topic."""
    every = sorted(manager.retrieveAll().items())
    return {name: len(_as_patient(found, manager).getSubscribers()) for name, found in every}


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


class Subscriptions:
    """Objects to which one IceStorm sends topics. `storm` is the proxy of its topic manager, and `patience` are
    milliseconds. Raises NoAnswer, and Refused if the text is not a proxy."""

    def __init__(self, communicator: Any, storm: str, patience: int = PATIENCE) -> None:
        self.storm = storm
        self._manager = topic_manager(communicator, storm, patience)
        self._connection = self._manager.ice_getCachedConnection()
        self._adapter = listening_adapter(communicator, self._manager)
        self._adapter.activate()
        self._subscribers: dict[str, Any] = {}
        self._answers = True

    def add(self, name: str, servant: Any) -> None:
        """Subscribes an object to a topic. Raises NoAnswer."""
        subscriber = self._adapter.addWithUUID(servant).ice_oneway()
        try:
            topic(self._manager, name).subscribeAndGetPublisher({}, subscriber)
        except Ice.Exception as error:
            raise NoAnswer(f"IceStorm does not provide the topic '{name}': {reason_of(error)}") from None
        self._subscribers[name] = subscriber

    def renew(self) -> None:
        """Subscribes again where IceStorm was started again, and forgot. Raises NoAnswer if it does not answer."""
        try:
            self._ping()
            connection = self._manager.ice_getCachedConnection()
            if connection != self._connection or not self._answers:
                for name, subscriber in self._subscribers.items():
                    found = topic(self._manager, name)
                    if subscriber.ice_getIdentity() not in found.getSubscribers():
                        found.subscribeAndGetPublisher({}, subscriber)
            self._connection, self._answers = connection, True
        except Ice.Exception as error:
            self._answers = False
            raise no_answer(self.storm, error) from None

    def _ping(self) -> None:
        try:
            self._manager.ice_ping()
        except (Ice.CloseConnectionException, Ice.ConnectionLostException):
            self._manager.ice_ping()  # it may have been started again meanwhile

    def end(self) -> None:
        """Ends the subscriptions. An IceStorm that does not answer removes them when it cannot send to them."""
        for name, subscriber in self._subscribers.items() if self._answers else ():
            try:
                topic(self._manager.ice_invocationTimeout(PATIENCE), name).unsubscribe(subscriber)
            except Ice.Exception:
                return
