"""Topics of a running network: who publishes and subscribes, messages as they come, and messages of one's own."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml.api import arguments as reading
from robocomp_yaml.api.addresses import Addresses
from robocomp_yaml.api.calling import TIMEOUT
from robocomp_yaml.api.refusals import meant, without_ice
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.errors import Faulty, NoAnswer, Refused
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Interface
from robocomp_yaml.network.configuration_base import base_of_component
from robocomp_yaml.network.network import TOPIC

if TYPE_CHECKING:
    from robocomp_yaml.wire.interfaces import Operation, WireInterface
    from robocomp_yaml.wire.storm import Subscriptions

_EVERY = 2.0  # seconds between two looks at an IceStorm


class KnownTopic(msgspec.Struct, frozen=True):
    """A topic by its name in IceStorm. `storm` is the proxy of the topic manager; `scope` and `interface` are None if
    no document says what the topic carries. `publishers` and `subscribers` are those of the documents; `subscribed` is
    the number of all that subscribe now, None if IceStorm does not answer or does not have the topic."""

    name: str
    storm: str
    scope: LinkedModule | None = None
    interface: Interface | None = None
    publishers: tuple[str, ...] = ()
    subscribers: tuple[str, ...] = ()
    subscribed: int | None = None

    @property
    def type(self) -> str:
        return f"{self.scope.module.name}.{self.interface.name}" if self.scope and self.interface else ""

    def inputs(self, name: str) -> list[str]:
        """The names of the arguments of a message; of all its messages if none is named."""
        methods = self.interface.methods if self.interface is not None else ()
        return [each.name for one in methods if name in ("", one.name) for each in one.inputs]


class Message(msgspec.Struct, frozen=True):
    """A message that arrived. `time` are seconds since the epoch, `clock` those of the monotonic clock. `values` are
    Ice's; `arguments` has them as data."""

    topic: KnownTopic
    operation: Operation
    values: tuple[Any, ...]
    time: float
    clock: float

    @property
    def arguments(self) -> dict[str, Any]:
        return self.operation.inputs_as_data(self.values)

    @property
    def data(self) -> dict[str, Any]:
        """As JSON has it."""
        return {"time": self.time, "topic": self.topic.name, "method": self.operation.name, "arguments": self.arguments}


class StormChange(msgspec.Struct, frozen=True):
    """An IceStorm, by its proxy, does not answer any more; without an error, it does again."""

    storm: str
    error: NoAnswer | None

    @property
    def text(self) -> str:
        return f"{self.error}; waiting until it does" if self.error else f"IceStorm answers again at '{self.storm}'"


class Topics:
    """The topics of a deployment, or, without one, of the components of the workspace and of an IceStorm. `storm` is
    the proxy of a topic manager, or its HOST:PORT, instead of those of the documents; `config` a file with properties
    of Ice."""

    def __init__(self, addresses: Addresses, storm: str = "", config: str = "", timeout: float = TIMEOUT) -> None:
        without_ice()
        self.addresses, self._config, self._timeout = addresses, config, timeout
        self._storm = addresses.topic_manager(storm)
        self.documented: tuple[KnownTopic, ...] = tuple(self._of_documents())

    def _of_documents(self) -> Iterator[KnownTopic]:
        found: dict[tuple[str, str], KnownTopic] = {}
        for name, storm, owner, is_out, scope, interface in self._ends():
            topic = found.setdefault((name, storm), KnownTopic(name, storm, scope, interface))
            ends = "publishers" if is_out else "subscribers"
            found[name, storm] = replace(topic, **{ends: (*getattr(topic, ends), owner)})
        yield from (topic for _, topic in sorted(found.items()))

    def _ends(self) -> Iterator[tuple[str, str, str, bool, LinkedModule, Interface]]:
        from robocomp_yaml.wire.storm import STORM

        network, linked = self.addresses.network, self.addresses.linked
        if network is not None and linked is not None:
            for one in network.connections:
                instance = linked.instances.get(one.source)
                component = instance.component if instance else None
                ports = (component.publishes if one.is_out else component.subscribes) if component else ()
                for port in ports if one.kind == TOPIC else ():
                    if port.name == one.port:
                        yield one.topic, self._storm or one.proxy, one.source, one.is_out, port.scope, port.interface
            return
        self.addresses.refuse_unread()
        if self.addresses.deployments:
            names = ", ".join(self.addresses.deployments)
            raise Refused(f"there are several deployments: {names}; name one with --deployment")
        for each in self.addresses.program.components.values():
            base = base_of_component(each, self.addresses.program)
            storm = self._storm or base.manager or STORM
            for is_out, ports in ((True, each.publishes), (False, each.subscribes)):
                for port in ports:
                    name = base.topic(port.name, port.interface.name, is_out=is_out)
                    yield name, storm, each.component.name, is_out, port.scope, port.interface

    @property
    def storms(self) -> list[str]:
        from robocomp_yaml.wire.storm import STORM

        return list(dict.fromkeys(one.storm for one in self.documented)) or [self._storm or STORM]

    def known(self) -> tuple[list[KnownTopic], list[NoAnswer]]:
        """All topics, with those that only IceStorm has, and the IceStorms that do not answer."""
        from robocomp_yaml.wire import storm as ice_storm
        from robocomp_yaml.wire.client import client

        found, failures = list(self.documented), list[NoAnswer]()
        with client(self._config, self._timeout, self._secured) as made:
            for storm in self.storms:
                try:
                    manager = ice_storm.topic_manager(made.communicator, storm, self._patience)
                    live = ice_storm.topics(manager)
                except NoAnswer as error:
                    failures.append(error)
                    continue
                found = [
                    replace(one, subscribed=live.pop(one.name, None)) if one.storm == storm else one for one in found
                ]
                found += [self._foreign(name, storm, count) for name, count in live.items()]
        return found, failures

    @property
    def _secured(self) -> dict[str, str]:
        """The Ice properties for IceStorms of a deployment with TLS."""
        return next(filter(None, map(self.addresses.secured, self.storms)), {})

    @property
    def _patience(self) -> int:
        return max(1, round(self._timeout * 1000))

    def _foreign(self, name: str, storm: str, subscribed: int | None = None) -> KnownTopic:
        """A topic that no component of the documents has: it may be one of the workspace by its name."""
        own = name.rpartition("/")[2]
        named = [
            (scope, one) for scope in self.addresses.program.modules.values() for one in scope.module.topics
            if one.name == own
        ]  # fmt: skip
        scope, interface = named[0] if len(named) == 1 else (None, None)
        return KnownTopic(name, storm, scope, interface, subscribed=subscribed)

    def find(self, text: str, type_: str = "") -> tuple[KnownTopic, str]:
        """The topic with this name, and the method that may follow it after a dot. `type_` is the topic of the
        documents that it carries, such as RoboCompArm.ArmEvents. Raises Refused."""
        topic, method = self._named(text, type_)
        if topic.interface is None:
            raise Refused(f"no document says what '{topic.name}' carries: --type RoboCompArm.ArmEvents, for example")
        names = [one.name for one in topic.interface.methods]
        if method and method not in names:
            listed = f"it has {', '.join(names)}"
            raise Refused(f"{topic.name} has no message '{method}'{meant(method, names, listed)}")
        return topic, method

    def find_or(self, text: str, type_: str) -> tuple[KnownTopic, str]:
        """The topic with this name; if no document has it, one that carries `type_`. Raises Refused."""
        try:
            return self.find(text)
        except Refused:
            return self.find(text, type_)

    def _named(self, text: str, type_: str) -> tuple[KnownTopic, str]:
        if type_:
            return self._typed(text, type_)
        for name, method in ((text, ""), (text.rpartition(".")[0], text.rpartition(".")[2])):
            found = [one for one in self.documented if one.name == name]
            found = found or [one for one in self.documented if one.type == name]
            if len(found) > 1:
                storms = " or ".join(f"--storm '{one.storm}'" for one in found)
                raise Refused(f"several IceStorms have a topic '{name}': name one by {storms}")
            if found:
                return found[0], method
        for name, method in ((text, ""), (text.rpartition(".")[0], text.rpartition(".")[2])):
            foreign = self._foreign(name, self.storms[0])
            if foreign.interface is not None:
                return foreign, method
        known = [one.name for one in self.documented]
        of_modules = [one.name for scope in self.addresses.program.modules.values() for one in scope.module.topics]
        listed = (
            f"known are {', '.join(known or of_modules)}" if known or of_modules else "these documents have no topic"
        )
        listed += "; --type says what another topic carries" if of_modules else ""
        raise Refused(f"unknown topic '{text}'{meant(text.partition('.')[0], [*known, *of_modules], listed)}")

    def _typed(self, text: str, type_: str) -> tuple[KnownTopic, str]:
        every = [(scope, one) for scope in self.addresses.program.modules.values() for one in scope.module.topics]
        found = [(s, one) for s, one in every if type_ in (one.name, f"{s.module.name}.{one.name}")]
        if len(found) != 1:
            names = [f"{scope.module.name}.{one.name}" for scope, one in found or every]
            if found:
                raise Refused(f"several topics of these documents are called '{type_}': {', '.join(names)}")
            known = f"known are {', '.join(names)}" if names else "these documents have no topic"
            what = f"'{type_}' is not a topic of these documents"
            raise Refused(f"{what}{meant(type_, [*names, *(one.name for _, one in every)], known)}")
        scope, interface = found[0]
        name, dot, method = text.rpartition(".")
        if not (dot and any(one.name == method for one in interface.methods)):
            name, method = text, ""
        storm = next((one.storm for one in self.documented if one.name == name), self.storms[0])
        return KnownTopic(name, storm, scope, interface), method

    @contextmanager
    def listening(
        self, topics: Sequence[KnownTopic], on_message: Callable[[Message], None],
        on_storm: Callable[[StormChange], None] = lambda change: None,
    ) -> Iterator[None]:  # fmt: skip
        """Subscribes to topics while the context lasts; `on_message` is called in a thread of Ice, in order. An
        IceStorm that goes away is waited for; `on_storm` is called in a thread when it does not answer, and when it
        does again. Raises NoAnswer."""
        from robocomp_yaml.wire import storm as ice_storm
        from robocomp_yaml.wire.client import client

        of_storms: dict[str, ice_storm.Subscriptions] = {}
        is_over = threading.Event()
        watching = threading.Thread(target=lambda: _watch(list(of_storms.values()), on_storm, is_over), daemon=True)
        with client(self._config, self._timeout, self._secured) as made:
            try:
                for topic in topics:
                    if topic.storm not in of_storms:
                        of_storms[topic.storm] = ice_storm.Subscriptions(made.communicator, topic.storm, self._patience)
                    of_storms[topic.storm].add(topic.name, wire_interface(topic).servant(_Receiver(topic, on_message)))
                watching.start()
                yield
            finally:
                is_over.set()
                for each in of_storms.values():
                    each.end()

    @contextmanager
    def publisher(self, topic: KnownTopic) -> Iterator[Publisher]:
        """Publishes while the context lasts. Raises NoAnswer."""
        from robocomp_yaml.wire import storm as ice_storm
        from robocomp_yaml.wire.client import client

        with client(self._config, self._timeout, self._secured) as made:
            manager = ice_storm.topic_manager(made.communicator, topic.storm, self._patience)
            proxy = ice_storm.topic(manager, topic.name).getPublisher()
            yield Publisher(topic, proxy.ice_twoway().ice_invocationTimeout(self._patience))

    def message(self, topic: KnownTopic, method: str, words: Sequence[str], stdin: str | None = None) -> Publishable:
        """A message as Ice gets it, from the words of a command line. Raises Refused and Faulty."""
        from robocomp_yaml.wire.script import reporting

        assert topic.scope is not None and topic.interface is not None
        names = [one.name for one in topic.interface.methods]
        if not method and len(names) != 1:
            raise Refused(f"name the message: {', '.join(f'{topic.name}.{name}' for name in names) or 'there is none'}")
        operation = wire_interface(topic).operations[method or names[0]]
        read = reading.read(topic.scope, operation.method, words, stdin)
        faults: list[Diagnostic] = []
        made = operation.arguments(read.root, reporting(faults))
        if faults:
            raise Faulty(in_order(faults), None, read.texts)
        return Publishable(operation, made)


class Publishable(msgspec.Struct, frozen=True):
    """A message to publish."""

    operation: Operation
    values: tuple[Any, ...]


class Publisher(msgspec.Struct, frozen=True):
    """Where messages of a topic are sent."""

    topic: KnownTopic
    proxy: Any

    def send(self, message: Publishable) -> None:
        """Returns when IceStorm has the message. Raises NoAnswer."""
        self.publish(message.operation, message.values)

    def publish(self, operation: Operation, values: tuple[Any, ...]) -> None:
        """The same for a message in two parts."""
        import Ice

        from robocomp_yaml.wire.client import reason_of

        try:
            operation.ice.invoke(self.proxy, (values, None))
        except Ice.Exception as error:
            raise NoAnswer(f"IceStorm does not accept messages of '{self.topic.name}': {reason_of(error)}") from None


class _Receiver:
    """Passes what arrives on."""

    def __init__(self, topic: KnownTopic, on_message: Callable[[Message], None]) -> None:
        self._topic, self._on_message = topic, on_message

    def __call__(self, operation: Operation, arguments: tuple[Any, ...]) -> None:
        self._on_message(Message(self._topic, operation, arguments, time.time(), time.monotonic()))


def _watch(
    of_storms: Sequence[Subscriptions], on_storm: Callable[[StormChange], None], is_over: threading.Event
) -> None:
    """Renews subscriptions, and reports which IceStorm does not answer, or does again."""
    away = set[str]()
    while not is_over.wait(_EVERY):
        for one in of_storms:
            try:
                one.renew()
                error = None
            except NoAnswer as failure:
                error = failure
            if is_over.is_set():
                return
            if (error is not None) != (one.storm in away):
                away ^= {one.storm}
                on_storm(StormChange(one.storm, error))


def wire_interface(topic: KnownTopic) -> WireInterface:
    """What a topic carries, which is known."""
    from robocomp_yaml.wire.interfaces import WireInterface
    from robocomp_yaml.wire.types import Types

    assert topic.scope is not None and topic.interface is not None
    return WireInterface(topic.scope, topic.interface, Types())


class Rate(msgspec.Struct):
    """Rate and jitter of what arrives, from the times of the messages since the last report."""

    _times: list[float] = []
    total: int = 0

    def add(self, clocks: Iterable[float]) -> None:
        for clock in clocks:
            self._times.append(clock)
            self.total += 1

    def report(self) -> Mapping[str, float | int | None]:
        """Messages in all; since the last report, messages per second, and the mean, least and longest time between two
        messages with its standard deviation (the jitter), in milliseconds."""
        gaps = [(later - first) * 1000 for first, later in zip(self._times, self._times[1:], strict=False)]
        self._times = self._times[-1:]
        if not gaps:
            return {"messages": self.total, "rate": 0.0, "mean": None, "min": None, "max": None, "jitter": None}
        mean = sum(gaps) / len(gaps)
        jitter = (sum((gap - mean) ** 2 for gap in gaps) / len(gaps)) ** 0.5
        rounded = {"mean": mean, "min": min(gaps), "max": max(gaps), "jitter": jitter}
        rate = 1000 / mean if mean else 0.0
        return {"messages": self.total, "rate": round(rate, 2), **{k: round(v, 3) for k, v in rounded.items()}}
