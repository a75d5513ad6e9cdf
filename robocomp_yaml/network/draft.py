"""What a network is derived from step by step: each instance and each IceStorm, with what they serve and are given."""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedInstance, LinkedStorm
from robocomp_yaml.link.program import Port
from robocomp_yaml.network.network import LOOPBACK, Endpoint, Host
from robocomp_yaml.network.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint, spelled_host
from robocomp_yaml.source.ice_options import BLANKS

MANAGER, PUBLISH = "TopicManager", "Publish"
STORM_INSTANCE = "IceStorm"


def is_loopback(address: str) -> bool:
    return address in (LOOPBACK, "::1", "ip6-localhost") or address.startswith("127.")


def listening(host: Host, number: int) -> str:
    """Where an adapter listens: on a machine that others reach, on all its interfaces. `localhost` may also mean ::1,
    which a machine without IPv6 cannot listen on."""
    if not is_loopback(host.address):
        return f"tcp -p {number}"
    address = "127.0.0.1" if host.address == LOOPBACK else host.address
    return f"tcp -h {spelled_host(address)} -p {number}"


class Offer(msgspec.Struct, eq=False):
    """An interface that a draft serves on the adapter `adapter`. `port` is the entry of the component's `implements`;
    None where only a name is known: of a program's endpoint, and of CommonBehavior. `given` is the endpoint as the
    document spells it; else `number` is its port, 0 as long as it has none."""

    owner: Draft
    adapter: str
    interface: str
    span: Span
    port: Port | None = None
    number: int = 0
    given: str = ""

    @property
    def full_name(self) -> str:
        """As `connect:` may name it."""
        return f"{self.owner.name}.{self.adapter}"

    @property
    def endpoint(self) -> IceEndpoint | None:
        """None where the document's spelling is none."""
        return parse_endpoint(self.given) if self.given else IceEndpoint(self.number)

    @property
    def text(self) -> str:
        """The value of the adapter's property."""
        return self.given.strip(BLANKS) or listening(self.owner.host, self.number)

    @property
    def proxy(self) -> str:
        endpoint = self.endpoint
        assert endpoint is not None
        return f"{self.interface.lower()}:{endpoint.reached_at(self.owner.host.address)}"

    def resolved(self) -> Endpoint:
        found = self.endpoint or IceEndpoint(0)
        module = self.port.scope.module.name if self.port else ""
        if self.port is None and self.interface == COMMON_BEHAVIOR:
            module = f"RoboComp{COMMON_BEHAVIOR}"
        return Endpoint(self.adapter, self.interface.lower(), found.port, self.text, found.protocol, module, self.span)


class Given(msgspec.Struct, frozen=True):
    """A text that a configuration gets, and the place in the deployment that it comes from."""

    text: str
    span: Span


class Draft(msgspec.Struct, eq=False):
    """An instance on its way to become a process. `aliases` are the entries that are a second name of it. `hears` are
    the adapters for events of topics that the document gives ports to; nobody else needs to know them. `proxies` by
    proxy name, `topics` (full names by the port's name) and `manager` (the proxy of its IceStorm) are what its
    configuration gets."""

    instance: LinkedInstance
    host: Host
    aliases: list[LinkedInstance] = []
    offers: list[Offer] = []
    hears: list[Offer] = []
    proxies: dict[str, Given] = {}
    topics: dict[str, Given] = {}
    manager: Given | None = None

    @property
    def name(self) -> str:
        return self.instance.name

    @property
    def span(self) -> Span:
        return self.instance.entry.span

    @property
    def adapters(self) -> list[Offer]:
        return [*self.offers, *self.hears]


class StormDraft(msgspec.Struct, eq=False):
    """An IceStorm, with the ports of its topic manager and of its publishers."""

    linked: LinkedStorm
    host: Host
    manager: int = 0
    publish: int = 0

    @property
    def name(self) -> str:
        return self.linked.name

    @property
    def span(self) -> Span:
        return self.linked.storm.span

    @property
    def proxy(self) -> str:
        return f"{STORM_INSTANCE}/{MANAGER}:tcp -h {spelled_host(self.host.address)} -p {self.manager}"

    def endpoints(self) -> tuple[Endpoint, ...]:
        storm = self.linked.storm
        manager = Endpoint(
            MANAGER,
            f"{STORM_INSTANCE}/{MANAGER}",
            self.manager,
            listening(self.host, self.manager),
            module="IceStorm",
            span=storm.port_span if storm.port else storm.span,
        )
        return manager, Endpoint(PUBLISH, "", self.publish, listening(self.host, self.publish), span=storm.span)
