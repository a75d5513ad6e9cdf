"""Methods of running components, called from outside: no code is generated for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import msgspec

from robocomp_yaml.api import arguments as reading
from robocomp_yaml.api.addresses import Addresses, Door, Peer
from robocomp_yaml.api.refusals import without_ice
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.model.interface import Method
from robocomp_yaml.wire.behavior import CONTROLS, common_behavior

if TYPE_CHECKING:
    from robocomp_yaml.wire.client import IceClient
    from robocomp_yaml.wire.interfaces import Operation

TIMEOUT = 10.0
"""Seconds that a call may take by default."""


class Reply(msgspec.Struct, frozen=True):
    """What a call came to: the value that it `returns` (if `has_value`), its out parameters, or the exception that the
    other side raised, by its name (`throws`) with its members."""

    returns: Any = None
    has_value: bool = False
    out: Mapping[str, Any] = {}
    throws: str = ""
    members: Mapping[str, Any] = {}

    @property
    def data(self) -> dict[str, Any]:
        """As a mock script spells an answer."""
        if self.throws:
            return {"throws": {self.throws: dict(self.members)}}
        return {
            **({"returns": self.returns} if self.has_value else {}),
            **({"out": dict(self.out)} if self.out else {}),
        }


class RemoteMethod:
    """A method of somebody who can be called. `text` is as `Addresses.method` reads it; `identity` replaces Ice's
    identity of the object, which is the name of the interface in lower case. Raises Refused and Faulty."""

    def __init__(self, addresses: Addresses, text: str, identity: str = "") -> None:
        without_ice()
        self.addresses = addresses
        self.peer: Peer
        self.door: Door
        self.method: Method
        self.peer, self.door, self.method = addresses.method(text)
        self.proxy = f"{identity}:{self.door.where}" if identity else self.door.proxy
        self._operation: Operation | None = None

    @property
    def operation(self) -> Operation:
        if self._operation is None:
            from robocomp_yaml.wire.interfaces import WireInterface
            from robocomp_yaml.wire.types import Types

            self._operation = WireInterface(self.door.scope, self.door.interface, Types()).operations[self.method.name]
        return self._operation

    def arguments(self, words: Sequence[str], stdin: str | None = None) -> tuple[Any, ...]:
        """The arguments as Ice gets them, from the words of a command line; `stdin` is the text that `-` means. Raises
        Refused and Faulty."""
        from robocomp_yaml.wire.script import reporting

        read = reading.read(self.door.scope, self.method, words, stdin)
        faults: list[Diagnostic] = []
        made = self.operation.arguments(read.root, reporting(faults))
        if faults:
            raise Faulty(in_order(faults), None, read.texts)
        return made

    def context(self) -> dict[str, str]:
        """What goes with a call: the token of the deployment, if the method controls one of its components."""
        if self.door.scope is not common_behavior() or self.method.name not in CONTROLS:
            return {}
        from robocomp_yaml.deploy.protection import context

        network = self.addresses.network_at(self.proxy)
        return context(network, self.proxy) if network is not None else {}

    @contextmanager
    def connected(self, config: str = "", timeout: float = TIMEOUT) -> Iterator[MethodCalls]:
        """A connection for calls; `config` is a file with properties of Ice, such as those of TLS, `timeout` the
        seconds that a call may take."""
        from robocomp_yaml.wire.client import client

        with client(config, timeout, self.addresses.secured(self.proxy)) as made:
            yield MethodCalls(self, made, timeout)

    def call(self, words: Sequence[str] = (), config: str = "", timeout: float = TIMEOUT) -> Reply:
        """One call. Raises Refused, Faulty if the arguments are wrong, and NoAnswer."""
        made = self.arguments(words)
        with self.connected(config, timeout) as calls:
            return calls.call(made)


class MethodCalls(msgspec.Struct, frozen=True):
    """A connection to a method."""

    method: RemoteMethod
    client: IceClient
    timeout: float

    def call(self, arguments: tuple[Any, ...]) -> Reply:
        """MethodCalls once. Raises NoAnswer."""
        import Ice

        from robocomp_yaml.wire import failures
        from robocomp_yaml.wire.client import NotConnected, OutOfTime
        from robocomp_yaml.wire.interfaces import RETURNS

        one, operation = self.method, self.method.operation
        proxy = self.client.proxy(one.proxy)
        try:
            result = self.client.call(proxy, operation, arguments, self.timeout, one.context())
        except (Ice.Exception, NotConnected, OutOfTime) as error:
            thrown = failures.raised(error, operation)
            if thrown is not None:
                return Reply(throws=thrown[0], members=thrown[1])
            called, limit = self._called(), self.timeout
            raise failures.no_answer(
                error, called, limit, lambda: self.client.ids_at(proxy, 1.0), self._others
            ) from None  # fmt: skip
        data = operation.results_as_data(result)
        has_value = RETURNS in operation.results
        return Reply(data.pop(RETURNS) if has_value else None, has_value, data)

    def _others(self) -> list[str]:
        """The interfaces of the documents that are at the same address."""
        own = self.method.door
        doors = {
            one.interface.name: self.client.proxy(f"{one.interface.name.lower()}:{own.where}")
            for one in self.method.addresses.every_door()
        }
        return [name for name, proxy in doors.items() if self.client.answers(proxy, 0.5)]

    def _called(self) -> Any:
        from robocomp_yaml.wire.failures import Called
        from robocomp_yaml.wire.types import id_of

        one = self.method
        type_id = id_of(one.door.scope, one.door.interface.name)
        return Called(
            one.peer.name, one.door.where, one.door.interface.name, type_id, one.method.name,
            one.peer.not_running,
        )  # fmt: skip
