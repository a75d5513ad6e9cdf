"""Stand-ins that run: servants that answer by a script, and topics that are published at a rate."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import Ice
import msgspec

from robocomp_yaml.diag.errors import NoAnswer, Refused
from robocomp_yaml.wire.addresses import Address, Topic
from robocomp_yaml.wire.client import reason_of
from robocomp_yaml.wire.interfaces import Operation
from robocomp_yaml.wire.script import Published, Script, Served
from robocomp_yaml.wire.storm import topic, topic_manager
from robocomp_yaml.wire.values import Data


class Call(msgspec.Struct, frozen=True):
    """A call that was answered, or a message that was published. `raises` is an exception's name, or ''; `time` are
    seconds since the epoch."""

    interface: str
    method: str
    arguments: Mapping[str, Data]
    results: Mapping[str, Data] = {}
    raises: str = ""
    is_published: bool = False
    time: float = msgspec.field(default_factory=time.time)


Listener = Callable[[Call], None]


class Serving(msgspec.Struct, frozen=True):
    """What is served: a proxy of it, and who expects it there. `problem` is why it is not served there."""

    proxy: str
    users: tuple[str, ...] = ()
    problem: str = ""


@contextmanager
def running(
    script: Script, addresses: Mapping[str, Sequence[Address]], topics: Mapping[str, Sequence[Topic]], on_call: Listener
) -> Iterator[list[Serving]]:
    """Serves and publishes while the context lasts; yields what is served. `addresses` and `topics` are those of
    interfaces, by their type ids. Raises Refused if an interface cannot be served anywhere, or IceStorm does not
    answer."""
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    data.properties.setProperty("Ice.ThreadPool.Server.Size", "16")  # delays keep a thread busy
    data.properties.setProperty("Ice.Warn.Dispatch", "0")
    data.properties.setProperty("Ice.MessageSizeMax", "0")
    communicator = Ice.initialize(data)
    stop = threading.Event()
    publishers: list[threading.Thread] = []
    try:
        served = [
            each for one in script.served for each in _serve(communicator, one, addresses[one.interface.id], on_call)
        ]
        for one in script.published:
            managers = [(_manager(communicator, each.manager), each.name) for each in topics[one.interface.id]]
            senders = [topic(manager, name).getPublisher().ice_oneway() for manager, name in managers]
            target = (one, senders, on_call, stop)
            publishers.append(threading.Thread(target=_publish, args=target, daemon=True))
        for thread in publishers:
            thread.start()
        yield served
    finally:
        stop.set()
        for thread in publishers:
            thread.join(2)
        communicator.destroy()


def _serve(communicator: Any, served: Served, addresses: Sequence[Address], on_call: Listener) -> list[Serving]:
    """Serves an interface at all its addresses, or at those that are free."""
    servant = served.interface.servant(_Answers(served, on_call))
    found = [_serve_at(communicator, served, servant, address) for address in addresses]
    if all(one.problem for one in found):
        raise Refused(
            f"{served.interface.interface.name} cannot be served at '{addresses[0].endpoint}': {found[0].problem}"
        )
    return found


def _serve_at(communicator: Any, served: Served, servant: Any, address: Address) -> Serving:
    endpoint = address.endpoint
    try:
        adapter = communicator.createObjectAdapterWithEndpoints(f"mock {served.interface.id} {endpoint}", endpoint)
    except Ice.SocketException:
        problem = "the address is in use: is the component running?"
    except Ice.Exception as error:
        problem = reason_of(error)
    else:
        adapter.add(servant, communicator.stringToIdentity(address.identity))
        adapter.activate()
        published = adapter.getPublishedEndpoints() or adapter.getEndpoints()
        return Serving(f"{address.identity}:{':'.join(map(str, published))}", address.users)
    return Serving(f"{address.identity}:{endpoint}", address.users, problem)


class _Answers:
    """The answers of one interface. Each method has a turn of its own."""

    def __init__(self, served: Served, on_call: Listener) -> None:
        self._served, self._on_call = served, on_call
        self._turns: dict[str, int] = {}
        self._lock = threading.Lock()

    def __call__(self, operation: Operation, arguments: tuple[Any, ...]) -> Any:
        name, inputs = self._served.interface.interface.name, operation.inputs_as_data(arguments)
        answers = self._served.answers.get(operation.name, ())
        if not answers:
            result = operation.as_result(operation.examples())
            self._on_call(Call(name, operation.name, inputs, operation.results_as_data(result)))
            return result
        with self._lock:
            turn = self._turns[operation.name] = self._turns.get(operation.name, -1) + 1
        answer = answers[turn % len(answers)]
        if answer.delay:
            time.sleep(answer.delay)
        if answer.raises is not None:
            self._on_call(Call(name, operation.name, inputs, raises=type(answer.raises).__name__))
            raise answer.raises
        self._on_call(Call(name, operation.name, inputs, operation.results_as_data(answer.result)))
        return answer.result


def _manager(communicator: Any, text: str) -> Any:
    try:
        return topic_manager(communicator, text)
    except NoAnswer as error:
        raise Refused(str(error)) from None


def _publish(published: Published, proxies: Sequence[Any], on_call: Listener, stop: threading.Event) -> None:
    """Sends the messages in turn. The times are multiples of the period since the first, so that they do not drift."""
    began, name, sent = time.monotonic(), published.interface.interface.name, 0
    while not stop.is_set():
        operation, arguments = published.messages[sent % len(published.messages)]
        try:
            for proxy in proxies:
                operation.ice.invoke(proxy, (arguments, None))
        except Ice.Exception as error:
            if stop.is_set():
                return
            on_call(Call(name, operation.name, operation.inputs_as_data(arguments), raises=type(error).__name__))
        else:
            on_call(Call(name, operation.name, operation.inputs_as_data(arguments), is_published=True))
        sent += 1
        stop.wait(max(0.0, began + sent / published.rate - time.monotonic()))
