"""The endpoint of a node: an Ice proxy such as `laser:tcp -h localhost -p 10003`."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.source.ice_endpoint import spelled_host
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.source.text import OF_NO_LINE

TOPIC_MANAGER = "IceStorm/TopicManager"
_INTERFACE = re.compile(r"[_A-Za-z][A-Za-z0-9_]*(\.[A-Za-z0-9_]+)?")  # a key of `endpoints:`
_PROTOCOLS = frozenset(("tcp", "udp", "ssl", "default", "ws", "wss"))


class NodeEndpoint(msgspec.Struct, frozen=True):
    """An identity and its address. `options` are all but host and port, as they are spelled."""

    identity: str
    protocol: str
    port: int
    host: str = ""
    options: str = ""

    @property
    def text(self) -> str:
        """The endpoint of the adapter, which listens on all addresses of its host."""
        return f"{self.protocol} -p {self.port} {self.options}".rstrip()

    @property
    def is_storm(self) -> bool:
        return self.identity == TOPIC_MANAGER

    def pinged(self, host: str) -> str:
        """Return the proxy for `ping:`, which may leave the host open."""
        return self.proxy(host) if host else f"{self.identity}:{self.text}"

    def proxy(self, host: str) -> str:
        """Return the proxy of the endpoint on a host, in the spelling that exporters write."""
        return f"{self.identity}:{self.protocol} -h {spelled_host(host)} -p {self.port} {self.options}".rstrip()


def parse(text: str) -> NodeEndpoint | None:
    """Return the endpoint of a proxy; None where it has not exactly one address, has no port, or its identity cannot
    be an interface."""
    proxy = proxy_at(text)
    if proxy is None or proxy.options or proxy.unknown or len(proxy.endpoints) != 1:
        return None
    address = proxy.endpoints[0]
    is_name = proxy.identity == TOPIC_MANAGER or _INTERFACE.fullmatch(proxy.identity)
    if not is_name or address.protocol not in _PROTOCOLS or not address.port:
        return None
    if "--sourceAddress" in address.options or OF_NO_LINE.search(address.options):  # an adapter cannot have these
        return None
    return NodeEndpoint(proxy.identity, address.protocol, address.port, address.host, address.options)
